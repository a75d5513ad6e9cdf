"""`# rcyaml: allow RC1234 -- reason`: what it suppresses and where, and the diagnostics of the comments themselves."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import Tree, write_tree
from robocomp_yaml.source.allowances import allowances
from robocomp_yaml.source.spelled import DocumentText

Run = Callable[..., Result]
Check = Callable[..., list[dict[str, object]]]
ALLOW = "# rcyaml: allow RC1006 -- only C++ calls it"
METHODS = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n"


def codes(diagnosed: list[dict[str, object]]) -> list[tuple[object, object]]:
    return [(d["code"], d["line"]) for d in diagnosed]


ALLOWED = {
    "in its line": f"{METHODS}      find: {{in: {{with: string}}}}  {ALLOW}\n",
    "above it": f"{METHODS}      {ALLOW}\n      find: {{in: {{with: string}}}}\n",
    "above it, further left": f"{METHODS}{ALLOW}\n      find: {{in: {{with: string}}}}\n",
    "above it, with blanks and other comments": (
        f"{METHODS}      {ALLOW}\n\n      # Finds it.\n      find: {{in: {{with: string}}}}\n"
    ),
    "two above it": (
        f"{METHODS}      {ALLOW}\n      # rcyaml: allow RC1027 -- no C++ here\n"
        "      find: {in: {with: string, EOF: string}}\n"
    ),
    "two in one": (
        f"{METHODS}      # rcyaml: allow RC1006, RC1027 -- no C++ here\n      find: {{in: {{with: string, EOF: string}}}}\n"
    ),
    "two apart by a blank": (
        f"{METHODS}      # rcyaml: allow RC1006 RC1027 -- no C++ here\n      find: {{in: {{with: string, EOF: string}}}}\n"
    ),
    "without blanks": f"{METHODS}      find: {{in: {{with: string}}}} #rcyaml:allow rc1006 -- x\n",
    "in capitals": f"{METHODS}      find: {{in: {{with: string}}}}  # RCYAML: Allow RC1006 -- x\n",
    "in brackets over several lines": (
        f"{METHODS}      find: {{in: {{ # all\n        what: string,\n        with: string,  {ALLOW}\n      }}}}\n"
    ),
    "above brackets over several lines": (
        f"{METHODS}      {ALLOW}\n      find: {{in: {{\n        what: string,\n        with: string,\n      }}}}\n"
    ),
    "behind the last line without an end": f"{METHODS}      find: {{in: {{with: string}}}}  {ALLOW}",
    "with other ends of lines": f"{METHODS}      {ALLOW}\n      find: {{in: {{with: string}}}}\n".replace("\n", "\r\n"),
    "behind a mark of byte order": f"\ufeff{METHODS}      {ALLOW}\n      find: {{in: {{with: string}}}}\n",
}


@pytest.mark.parametrize("text", ALLOWED.values(), ids=ALLOWED)
def test_a_diagnostic_is_suppressed(diagnostics: Check, text: str) -> None:
    assert diagnostics({"Speech.idsl.yaml": text}) == []


def test_a_list(diagnostics: Check) -> None:
    allow = "# rcyaml: allow RC2103 -- twice on purpose"
    for imports in (
        f"  - Speech\n  - Speech  {allow}\n",
        f"  - Speech\n  {allow}\n  - Speech\n",
        f"  [Speech,\n  Speech]  {allow}\n",
    ):
        diagnosed = diagnostics({
            "Speech.idsl.yaml": "module: RoboCompSpeech\n",
            "a.cdsl.yaml": f"component: A\nlanguage: python\nimports:\n{imports}",
        })  # fmt: skip
        assert diagnosed == []


def test_a_text_of_several_lines_is_one_value(diagnostics: Check) -> None:
    """It cannot contain a comment, so one above it, or after its end, concerns all of it."""
    pdsl = "component: a.cdsl.yaml\n{above}types:\n  Unused: {{list: float, doc: {doc}}}{behind}\nparameters: {{}}\n"
    allow = "# rcyaml: allow RC3107 -- for later"
    a = {"a.cdsl.yaml": "component: A\nlanguage: python\n"}
    for doc in ("short", "'a\n    long\n    one'", '"a\n\n    one"'):
        text = pdsl.format(above="", doc=doc, behind="  " + allow)
        assert diagnostics({**a, "a.pdsl.yaml": text}) == [], doc


def test_a_document_is_reported_at_its_first_line(diagnostics: Check, tmp_path: Path) -> None:
    """A diagnostic of the whole document is suppressed above everything else in it."""
    other = "component: B\nlanguage: python\n"
    allow = "# rcyaml: allow RC2010 -- they share a folder\n"
    for head in (allow, "# Ours.\n\n" + allow, allow + "# yaml-language-server: $schema=x\n---\n"):
        assert diagnostics({"a.cdsl.yaml": "component: A\nlanguage: python\n", "b.cdsl.yaml": head + other}) == []
    diagnosed = diagnostics({"a.cdsl.yaml": "component: A\nlanguage: python\n", "b.cdsl.yaml": other + allow})
    assert codes(diagnosed) == [("RC2010", 1), ("RC0060", 3)]


NOT_A_COMMENT = {
    "a text": f"module: M\ndoc: '{ALLOW}'\n",
    "a text in double quotes": f'module: M\ndoc: "{ALLOW}"\n',
    "a text of several lines": f"module: M\ndoc: |\n  x\n  {ALLOW}\n",
    "a folded one": f"module: M\ndoc: >-\n  x\n\n  {ALLOW}\n  y\n",
    "a part of a word": "module: M\ndoc: x#rcyaml:allow\n",
    "another tool's": "module: M  # rcyamlish: allow RC1006 -- x\n",
    "about it": "module: M  # rcyaml allows nothing here, and my-rcyaml: allow RC1006 neither\n",
}


@pytest.mark.parametrize("text", NOT_A_COMMENT.values(), ids=NOT_A_COMMENT)
def test_other_comments_are_ignored(diagnostics: Check, text: str) -> None:
    assert diagnostics({"Speech.idsl.yaml": text}) == []


WRONG = f"{METHODS}      find: {{in: {{with: string}}}}  "
TOLD = {
    "no reason": ("# rcyaml: allow RC1006", [("RC0063", 5)]),
    "an empty reason": ("# rcyaml: allow RC1006 -- ", [("RC0063", 5)]),
    "another verb": ("# rcyaml: ignore RC1006 -- x", [("RC1006", 5), ("RC0062", 5)]),
    "no verb": ("# rcyaml: RC1006 -- x", [("RC1006", 5), ("RC0062", 5)]),
    "nothing": ("# rcyaml:", [("RC1006", 5), ("RC0062", 5)]),
    "no code": ("# rcyaml: allow -- x", [("RC1006", 5), ("RC0062", 5)]),
    "no colon": ("# rcyaml allow RC1006 -- x", [("RC1006", 5), ("RC0062", 5)]),
    "no dashes": ("# rcyaml: allow RC1006 only C++ calls it", [("RC0062", 5)]),
    "a word for all": ("# rcyaml: allow all -- x", [("RC1006", 5), ("RC0062", 5)]),
    "an unknown code": ("# rcyaml: allow RC1006, RC1999 -- x", [("RC0061", 5)]),
    "a code too much": ("# rcyaml: allow RC1006, RC1027 -- x", [("RC0060", 5)]),
    "one code twice": ("# rcyaml: allow RC1006, RC1006 -- x", [("RC0060", 5)]),
    "one of a running network": ("# rcyaml: allow RC1006, RC7001 -- x", [("RC0060", 5)]),
    "one that only compile gives": ("# rcyaml: allow RC1006, RC6004 -- x", []),
    "one of the libraries here": ("# rcyaml: allow RC1006, RC2304 -- x", []),
    "itself": ("# rcyaml: allow RC1006, RC0063", [("RC0063", 5), ("RC0064", 5)]),
}


@pytest.mark.parametrize(("comment", "expected"), TOLD.values(), ids=TOLD)
def test_wrong_comments_are_reported(diagnostics: Check, comment: str, expected: list[tuple[str, int]]) -> None:
    assert sorted(codes(diagnostics({"Speech.idsl.yaml": f"{WRONG}{comment}\n"}))) == sorted(expected)


def test_a_comment_elsewhere_suppresses_nothing(diagnostics: Check) -> None:
    text = f"{METHODS}      find: {{in: {{with: string}}}}\n      {ALLOW}\n      stop:\n"
    assert codes(diagnostics({"Speech.idsl.yaml": text})) == [("RC1006", 5), ("RC0060", 6)]
    text = f"{METHODS}      stop:  {ALLOW}\n      find: {{in: {{with: string}}}}\n"
    assert codes(diagnostics({"Speech.idsl.yaml": text})) == [("RC0060", 5), ("RC1006", 6)]


def test_an_error_cannot_be_suppressed(diagnostics: Check) -> None:
    text = f"{METHODS}      find: {{in: {{x: Quux}}}}  # rcyaml: allow RC1010 -- it comes\n"
    diagnosed = diagnostics({"Speech.idsl.yaml": text})
    assert codes(diagnosed) == [("RC1010", 5), ("RC0064", 5)]
    assert diagnosed[1]["message"] == "a comment cannot allow RC1010: it is an error"


def test_a_document_that_cannot_be_read_has_no_comments(diagnostics: Check) -> None:
    diagnosed = diagnostics({"Speech.idsl.yaml": f"{METHODS}      find: {{  {ALLOW}\n"})
    assert [code for code, _ in codes(diagnosed)] == ["RC0101"]


@pytest.mark.parametrize(("lint", "expected"), [
    ("RC1006: error", []),  # as `allow` of a compiler: the workspace is strict, except at this location
    ("RC1006: off", []),  # the comment is used, whatever the workspace sets
    ("RC1006: note", []),
    ("RC1010: warning", ["RC0060"]),
])  # fmt: skip
def test_the_workspace_and_the_comment(diagnostics: Check, lint: str, expected: list[str]) -> None:
    files = {"rcyaml.yaml": f"lint: {{{lint}}}\n", "Speech.idsl.yaml": f"{WRONG}{ALLOW}\n"}
    if expected:
        files["Speech.idsl.yaml"] = (
            f"{METHODS}      find: {{in: {{x: Quux}}}}  # rcyaml: allow RC1010, RC1006 -- it comes\n"
        )
    assert [code for code, _ in codes(diagnostics(files))] == expected


def test_the_workspace_decides_about_the_comments(diagnostics: Check) -> None:
    files = {"Speech.idsl.yaml": f"{WRONG}# rcyaml: allow RC1006, RC1027\n"}
    assert [
        (d["code"], d["severity"])
        for d in diagnostics({**files, "rcyaml.yaml": "lint: {RC0060: error, RC0063: off}\n"})
    ] == [("RC0060", "error")]


def test_the_workspace_s_own_document(diagnostics: Check) -> None:
    diagnosed = diagnostics({
        "Speech.idsl.yaml": "module: M\n",
        "rcyaml.yaml": "interfaces:\n  - later  # rcyaml: allow RC0301 -- it comes with the robot\n  - never\n",
    })  # fmt: skip
    assert codes(diagnosed) == [("RC0301", 3)]


KINDS: dict[str, Tree] = {
    "cdsl": {"a.cdsl.yaml": "component: A\nlanguage: python\nimports: [I, I]  # rcyaml: allow RC2103 -- x\n"},
    "pdsl": {
        "a.pdsl.yaml": "component: a.cdsl.yaml\ntypes:\n  # rcyaml: allow RC3107 -- x\n  T: {struct: {x: {type: float}}}\nparameters: {}\n"
    },
    "config": {
        "x.config.yaml": "# rcyaml: allow RC3323 -- x\nparameters: {a: 1}\n",
    },
    "ddsl": {
        "r.ddsl.yaml": "deployment: R\ncomponents:\n  # rcyaml: allow RC4404 -- comes with the robot\n  a: {program: ./nowhere}\n",
    },
}


@pytest.mark.parametrize("files", KINDS.values(), ids=KINDS)
def test_all_kinds_of_documents(diagnostics: Check, files: Tree) -> None:
    diagnosed = diagnostics({
        "I.idsl.yaml": "module: RoboCompI\n", "a.cdsl.yaml": "component: A\nlanguage: python\nimports: [I]\n", **files
    })  # fmt: skip
    assert diagnosed == []


def test_compile_uses_the_comments(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": f"{WRONG}{ALLOW}\n"})
    first, again = (json.loads(rcyaml("compile", "--format", "json").stdout) for _ in range(2))
    assert first["diagnostics"] == again["diagnostics"] == []
    assert rcyaml("compile", "--fail-on", "warning").exit_code == 0


def test_comments_outside_the_requested_documents_are_not_checked(rcyaml: Run, tmp_path: Path) -> None:
    """An import from elsewhere is not checked completely."""
    write_tree(
        tmp_path,
        {"Arm.idsl.yaml": f"module: RoboCompArm {ALLOW}\n", "Leg.idsl.yaml": "module: RoboCompLeg\nimports: [Arm]\n"},
    )
    assert rcyaml("check", "Leg.idsl.yaml").stdout == "2 documents: nothing wrong\n"
    assert "RC0060" in rcyaml("check", "Arm.idsl.yaml").stdout


REMOVED = {
    "# rcyaml: allow RC1027 -- x\n": "",
    "# rcyaml: allow RC1027, RC1028 -- x\n": "",
    "# rcyaml: allow RC1006, RC1027 -- x\n": "  # rcyaml: allow RC1006 -- x\n",
    "# rcyaml: allow RC1027, RC1006 -- x\n": "  # rcyaml: allow RC1006 -- x\n",
    "# rcyaml: allow RC1027 RC1006 RC1028 -- x\n": "  # rcyaml: allow RC1006 -- x\n",
    "# rcyaml: ignore RC1006 -- x\n": "  # rcyaml: allow RC1006 -- x\n",
    "# rcyaml: allow RC1006 since x\n": "  # rcyaml: allow RC1006 -- since x\n",
    "# rcyaml allow RC1006 -- x\n": "  # rcyaml: allow RC1006 -- x\n",
}


@pytest.mark.parametrize("error", ["types: {T: {sequnce: float}}\n", "topic: {}\n", "imports: [Gone]\n", "doc: [1]\n"])
def test_an_error_hides_what_is_allowed(rcyaml: Run, tmp_path: Path, error: str) -> None:
    """The comment is not lost with the fix of the error, nor with an error in another document."""
    text = f"{WRONG}{ALLOW}\n"
    write_tree(
        tmp_path, {"Speech.idsl.yaml": text + error, "Other.idsl.yaml": f"module: O\nimports: [Speech]\n{error}"}
    )
    assert "RC0060" not in rcyaml("check").stdout
    rcyaml("check", "--unsafe-fixes")
    assert ALLOW in (tmp_path / "Speech.idsl.yaml").read_text()


@pytest.mark.parametrize(("comment", "after"), REMOVED.items(), ids=range(len(REMOVED)))
def test_comments_can_be_fixed(rcyaml: Run, tmp_path: Path, comment: str, after: str) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": f"{WRONG}{comment}"})
    rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / "Speech.idsl.yaml").read_text() == WRONG.rstrip(" ") + (after or "\n")


def test_a_comment_on_its_own_line_is_removed_with_the_line(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl.yaml": f"# Top.\r\n  {ALLOW}\r\nmodule: M\r\n"})
    assert "RC0060" in rcyaml("check", "--fix").stdout
    rcyaml("check", "--unsafe-fixes")
    assert (tmp_path / "Speech.idsl.yaml").read_bytes() == b"# Top.\r\nmodule: M\r\n"


LINES = {
    f"{ALLOW}\na: |\n  x\n\n  y\nb: 1\n": (1, 5),
    f"{ALLOW}\na: >-\n  x\n  y": (1, 4),
    f"a: 1\n{ALLOW}\nb: {{c: [x,\n y], d: 1}}\ne: 1\n": (2, 4),
    f"a: 1\nb: {{c: [x,  {ALLOW}\n y], d: 1}}\ne: 1\n": (2, 3),
    f"a: 1\nb: {{c: [x,\n {ALLOW}\n y], d: 1}}\ne: 1\n": (3, 4),
    f"a: 1\nb: 'x\n\n y'  {ALLOW}\ne: 1\n": (2, 4),
    f"a: 1\nb: x\n  y  {ALLOW}\ne: 1\n": (2, 3),
    f"a:\n  {ALLOW}\n  - &x 1\n  - *x\n": (2, 3),
    f"a:\n  - &x 1\n  {ALLOW}\n  - *x\n": (3, 4),
    f"a: 1\n{ALLOW}\n": (2, 3),
    f"%YAML 1.2\n---\n# x\n{ALLOW}\n\n\na: 1\n": (1, 7),
}


@pytest.mark.parametrize(("text", "lines"), LINES.items(), ids=range(len(LINES)))
def test_the_lines_that_a_comment_concerns(text: str, lines: tuple[int, int]) -> None:
    (allowance,), diagnosed = allowances(DocumentText("a.yaml", text))
    assert (allowance.first, allowance.last) == lines and not diagnosed
