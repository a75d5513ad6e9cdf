"""`check` rejects names and paths that are too long for files, and a configuration as a program."""

from __future__ import annotations

from collections.abc import Callable

import pytest

Check = Callable[..., list[dict[str, object]]]


def codes_of(diagnostics: Check, text: str, **more: str) -> list[tuple[object, object, object]]:
    tree = {"robot.ddsl.yaml": text} | {f"{name}.ddsl.yaml": other for name, other in more.items()}
    return [(one["code"], one["line"], one["column"]) for one in diagnostics(tree, "robot.ddsl.yaml")]


SLEEPS = "{program: sleep, args: [1]}"


@pytest.mark.parametrize(
    ("deployment", "entry", "is_right"),
    [("R" * 120, "a" * 126, True), ("R" * 120, "a" * 127, False), ("R" * 6, "a" * 241, False), ("R", "a" * 245, True)],
)
def test_names_of_entries(diagnostics: Check, deployment: str, entry: str, is_right: bool) -> None:
    found = codes_of(diagnostics, f"deployment: {deployment}\ncomponents:\n  {entry}: {SLEEPS}\n")
    assert found == ([] if is_right else [("RC4109", 3, 3)])


def test_other_names(diagnostics: Check) -> None:
    assert codes_of(diagnostics, f"deployment: {'R' * 249}\ncomponents: {{a: {SLEEPS}}}\n") == [("RC4109", 1, 13)]
    hosts = f"deployment: R\nhosts: {{{'h' * 256}: 10.0.0.2}}\ncomponents: {{a: {SLEEPS}}}\n"
    assert [code for code, _, _ in codes_of(diagnostics, hosts)] == ["RC4109"]
    instances = f"deployment: R\ncomponents:\n  {'a' * 244}{{i}}: {{program: sleep, instances: 11}}\n"
    assert codes_of(diagnostics, instances) == [("RC4109", 3, 3)]  # the last one: 10 has two digits
    arm = f"deployment: Arm\ncomponents: {{{'e' * 150}: {SLEEPS}}}\n"
    included = f"deployment: R\ncomponents: {{}}\ninclude: {{{'i' * 100}: arm.ddsl.yaml}}\n"
    assert [code for code, _, _ in codes_of(diagnostics, included, arm=arm)] == ["RC4109"]


@pytest.mark.parametrize(
    ("key", "path"),
    [("program", "./" + "é" * 128), ("cwd", "a" * 256), ("cwd", "ab/" * 1400), ("program", "/" + "x" * 256)],
)
def test_paths(diagnostics: Check, key: str, path: str) -> None:
    program = "" if key == "program" else "program: sleep, "
    found = codes_of(diagnostics, f"deployment: R\ncomponents:\n  a: {{{program}{key}: {path}}}\n")
    assert ("RC4110", 3) in [each[:2] for each in found]


def test_a_path_of_few_letters_with_many_bytes_is_long(diagnostics: Check) -> None:
    for size, is_wrong in ((127, False), (128, True)):
        text = f"deployment: R\ncomponents: {{a: {{program: ./{'é' * size}}}}}\n"
        assert (("RC4110", 2, 27) in codes_of(diagnostics, text)) is is_wrong


@pytest.mark.parametrize("program", ["{config}", "bin/{config}", "{config}/../x"])
def test_a_configuration_is_not_a_program(diagnostics: Check, program: str) -> None:
    text = f"deployment: R\ncomponents:\n  a: {{program: '{program}', config-as: argument}}\n"
    found = codes_of(diagnostics, text)
    assert ("RC4017", 3, 16) in found and (len(found) == 1 or ".." in program)
    right = "deployment: R\ncomponents:\n  a: {program: sh, args: ['{config}'], connect: {X: 'x:tcp -p 1'}}\n"
    assert codes_of(diagnostics, right) == []


def test_the_name_of_a_component(diagnostics: Check) -> None:
    for size, wanted in ((247, []), (248, ["RC0210"])):
        found = diagnostics({"a.cdsl.yaml": f"component: {'A' * size}\nlanguage: python\n"}, "a.cdsl.yaml")
        assert [one["code"] for one in found] == wanted
