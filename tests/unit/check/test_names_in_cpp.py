"""Names that C++ cannot have: an error if a component in C++ needs the module, else a warning. Real compilers are tried
in tests/ice/test_cpp_words.py."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from robocomp_yaml.languages import language
from robocomp_yaml.languages.cpp.names import parameter

Check = Callable[..., list[dict[str, Any]]]

HEAD = "module: RoboCompMap\n"
EVERYWHERE = """\
types:
  {0}: {{enum: [a, {0}x]}}
  Side: {{enum: [left, {0}]}}
  Pose: {{struct: {{{0}: float}}}}
exceptions:
  Lost: {{struct: {{{0}: string}}}}
interfaces:
  Map:
    methods:
      {0}: {{in: {{{0}: int}}, returns: int}}
      find: {{out: {{{0}: int}}}}
"""


def component(language: str, keys: str = "") -> dict[str, str]:
    return {"c.cdsl.yaml": f"component: C\nlanguage: {language}\n{keys}imports: [Map]\nrequires: [Map]\n"}


def reported(diagnostics: Check, text: str, **more: str) -> list[tuple[str, str, str]]:
    found = diagnostics({"Map.idsl.yaml": HEAD + text, **more})
    return [(f"{d['line']}:{d['column']}", d["code"], d["severity"]) for d in found]


@pytest.mark.parametrize("word", ["ERANGE", "L_tmpnam", "offsetof", "be32toh", "HUGE_VAL", "SEEK_SET"])
def test_a_macro_is_reported_at_each_name(diagnostics: Check, word: str) -> None:
    text = EVERYWHERE.format(word)
    places = [
        f"{line}:{found.start() + 1}" for line, shown in enumerate((HEAD + text).splitlines(), 1)
        for found in re.finditer(rf"\b{word}\b", shown)
    ]  # fmt: skip
    assert len(places) == 7
    assert reported(diagnostics, text) == [(place, "RC1027", "warning") for place in places]


@pytest.mark.parametrize("word", ["Erange", "erange", "EOFs", "nullptr", "stderr", "major", "linux", "lambda"])
def test_names_similar_to_a_macro(diagnostics: Check, word: str) -> None:
    assert reported(diagnostics, EVERYWHERE.format(word)) == []


def test_a_module_named_like_a_macro(diagnostics: Check) -> None:
    assert [d["code"] for d in diagnostics({"Map.idsl.yaml": "module: BUFSIZ\n"})] == ["RC1027"]


@pytest.mark.parametrize(("module", "language", "severity"), [
    ("log", "cpp", "error"), ("select", "python", "warning"), ("Parameters", "cpp", "error"), ("int8_t", "cpp", "error"),
    ("Log", "cpp", ""), ("runtime", "cpp", ""), ("linux", "cpp", ""),
])  # fmt: skip
def test_a_module_named_like_a_system_function(diagnostics: Check, module: str, language: str, severity: str) -> None:
    text = f"module: {module}\ninterfaces: {{Map: {{methods: {{time: {{in: {{index: int}}}}}}}}}}\n"
    found = diagnostics({"Map.idsl.yaml": text, **component(language)})
    expected = [("RC1028", severity, f"call it 'RoboComp{module[0].upper()}{module[1:]}'")] if severity else []
    assert [(d["code"], d["severity"], d["hint"]) for d in found] == expected


@pytest.mark.parametrize(("word", "language", "keys", "severity"), [
    ("EDOM", "cpp", "", "error"),
    ("EDOM", "python", "", "warning"),
    ("INT_MAX", "cpp", "", "warning"),  # <climits> comes with C++20's <memory>
    ("INT_MAX", "{name: cpp, standard: 20}", "", "error"),
    ("slots", "cpp", "", "warning"),
    ("slots", "cpp", "gui: {toolkit: qt, base: QDialog}\n", "error"),
    ("slots", "cpp", "compatibility: robocomp\n", "error"),
])  # fmt: skip
def test_an_error_if_a_component_in_cpp_needs_the_module(
    diagnostics: Check, word: str, language: str, keys: str, severity: str
) -> None:
    text = f"interfaces: {{Map: {{methods: {{go: {{in: {{{word}: int}}}}}}}}}}\n"
    found = diagnostics({"Map.idsl.yaml": HEAD + text, **component(language, keys)})
    assert [(d["code"], d["severity"]) for d in found] == [("RC1027", severity)]
    assert [related["message"] for related in found[0]["related"]] == (
        ["component C is in C++, and needs it"] if severity == "error" else []
    )


def test_names_of_indirectly_imported_modules(diagnostics: Check) -> None:
    """All imports of a component's modules are compiled with it, even unused ones."""
    files = {
        "Base.idsl.yaml": "module: RoboCompBase\ntypes: {Kind: {enum: [ENOENT]}}\n",
        "Map.idsl.yaml": HEAD + "imports: [Base]\ninterfaces: {Map: {}}\n",
        **component("cpp"),
    }
    assert [(d["file"], d["severity"]) for d in diagnostics(files)] == [("Base.idsl.yaml", "error")]


def test_a_migrated_document_is_not_rejected(diagnostics: Check) -> None:
    """Other programs use its names. The same is true in a folder below the migrated one."""
    files = {
        "in/Map.idsl.yaml": HEAD + "types: {Kind: {enum: [ENOENT]}}\n"
        "interfaces: {Map: {methods: {Kind: {returns: Kind}}}}\n",
        "in/Other.idsl.yaml": "module: RoboCompOther\ntypes: {Kind: {enum: [ENOENT]}}\n",
        ".rcyaml/migrated.json": '{"files": {"in/Map.idsl.yaml": "0"}}\n',
        "in/c.cdsl.yaml": "component: C\nlanguage: cpp\nimports: [Map, Other]\nrequires: [Map]\n",
    }
    found = [(d["file"], d["code"], d["severity"]) for d in diagnostics(files)]
    assert sorted(found) == [
        ("in/Map.idsl.yaml", "RC1026", "warning"), ("in/Map.idsl.yaml", "RC1027", "warning"),
        ("in/Other.idsl.yaml", "RC1027", "error"),
    ]  # fmt: skip


def test_hints_can_be_typed(diagnostics: Check) -> None:
    text = "types: {Kind: {enum: [ENOENT, errno, BUFSIZ]}}\n"
    found = diagnostics({"Map.idsl.yaml": HEAD + text})
    assert [d["hint"] for d in found] == ["call it 'enoent'", "call it 'errnoValue'", "call it 'bufsiz'"]
    for d in found:
        text = text.replace(str(d["message"]).split("'")[1], str(d["hint"]).split("'")[1])
    assert diagnostics({"Map.idsl.yaml": HEAD + text}) == []


def test_parts_of_a_machine_in_cpp(diagnostics: Check) -> None:
    """Guards and actions are methods; in Python these names are allowed."""
    machine = "  initial: a\n  transitions: {{a: {{to: a, event: EOF, if: ERANGE}}}}\n"
    text = f"component: C\nlanguage: {{}}\nstatemachine:\n{machine}"
    assert [d["code"] for d in diagnostics({"c.cdsl.yaml": text.format("cpp")})] == ["RC2237"]
    assert diagnostics({"c.cdsl.yaml": text.format("python")}) == []


def test_generated_names_get_an_underscore() -> None:
    """Accessors of parameters and events of machines: no error, because the code is generated from the same document."""
    assert [language("cpp").in_code(name) for name in ("ERANGE", "be32toh", "slots", "INT_MAX", "erange")] == [
        "ERANGE_", "be32toh_", "slots_", "INT_MAX_", "erange",
    ]  # fmt: skip
    assert language("python").in_code("ERANGE") == "ERANGE"
    assert parameter("ERANGE") == "ERANGE_"
