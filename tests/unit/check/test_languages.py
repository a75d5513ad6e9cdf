"""Keys that a language does not have are rejected; those that it has are not."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from robocomp_yaml import languages
from robocomp_yaml.languages.record import CAPABILITIES, MERGING, PORTS, TargetLanguage

Rcyaml = Callable[..., Any]
Check = Callable[..., list[dict[str, Any]]]
SAID: dict[str, dict[str, Any]] = {
    "parameters": {"parameters": "p.pdsl.yaml"},
    "period": {"period": "20 ms"},
    "statemachine": {"statemachine": {"initial": "a", "final": "b", "states": {"a": {}}, "transitions": {"a": "b"}}},
    "gui": {"gui": {"toolkit": "qt", "base": "QWidget"}},
    "compatibility": {"compatibility": "robocomp"},
    "sources": {"uses": {"sources": ["a.cpp"]}},
    "classes": {"uses": {"classes": ["a"]}},
    **{key: {"uses": {"libraries": [{key: "x1"}]}} for key in ("cmake", "pkg-config", "link", "pip")},
    **{key: {key: ["Ticks" if key in ("publishes", "subscribes") else "Clock"]} for key in PORTS},
}
OTHERS = {
    "Clock.idsl.yaml": "module: RoboCompClock\ninterfaces: {Clock: {methods: {now: {returns: long}}}}\n"
    "topics: {Ticks: {methods: {tick: {}}}}\n",
    "p.pdsl.yaml": "parameters: {speed: {type: double, default: 1}}\n",
}


def component(language: Any, keys: dict[str, Any]) -> dict[str, str]:
    document = {"component": "ClockComp", "language": language, "imports": ["Clock"], **keys}
    text = "\n".join(f"{key}: {json.dumps(value)}" for key, value in document.items())
    return {"c.cdsl.yaml": f"{text}\n", **OTHERS}


def reported(diagnostics: Check, language: Any, keys: dict[str, Any]) -> list[tuple[str, str, int]]:
    found = diagnostics(component(language, keys))
    return [(one["code"], one["message"], one["line"]) for one in found if one["code"] in ("RC2060", "RC2303")]


def expected(language: TargetLanguage, key: str, line: int) -> list[tuple[str, str, int]]:
    if key in language.ignored:
        message = f"`{key}` has no effect: a component in {language.title} is not compiled"
        return [("RC2303", message, line)]
    return [] if key in language.has else [("RC2060", f"`{key}:` is not available in {language.title}", line)]


def test_every_key_of_a_capability_has_an_example() -> None:
    assert {*SAID, "standard", MERGING} == {*CAPABILITIES}


@pytest.mark.parametrize("key", SAID)
@pytest.mark.parametrize("name", languages.table())
def test_a_key_that_the_language_does_not_have_is_rejected(diagnostics: Check, name: str, key: str) -> None:
    assert reported(diagnostics, name, SAID[key]) == expected(languages.language(name), key, 4)


@pytest.mark.parametrize("name", languages.table())
def test_a_standard(diagnostics: Check, name: str) -> None:
    language = {"name": name, "standard": 20}
    assert reported(diagnostics, language, {}) == expected(languages.language(name), "standard", 2)


@pytest.mark.parametrize("name", languages.table())
def test_empty_keys_are_allowed(diagnostics: Check, name: str) -> None:
    assert reported(diagnostics, name, {"implements": [], "uses": {"libraries": []}}) == []


def test_the_hint_lists_the_keys_of_the_language(diagnostics: Check, rcyaml: Rcyaml, tmp_path: Path) -> None:
    lacking = [
        (one, key) for one in languages.table().values() for key in ("statemachine", "gui") if key not in one.has
    ]
    for language, key in lacking:
        hints = [one["hint"] for one in diagnostics(component(language.name, SAID[key]))]
        start = f"remove it, or write the component in Python or C++; {language.title} has implements, "
        assert any(hint.startswith(start) for hint in hints)
        write_tree(tmp_path, component(language.name, SAID[key]))
        compiled = rcyaml("compile")
        assert compiled.exit_code == 1 and not (tmp_path / "src").exists(), compiled.output


def test_one_key_is_one_error(diagnostics: Check) -> None:
    """A machine that the language does not have is not checked too."""
    machine = {"statemachine": {"initial": "nowhere", "datamodel": "python", "states": {"a": {}}}}
    for language in languages.table().values():
        if "statemachine" not in language.has:
            found = diagnostics(component(language.name, machine))
            assert "RC2216" not in [one["code"] for one in found]
