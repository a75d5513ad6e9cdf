"""Fixes are spelled in the trees that a run has read."""

from __future__ import annotations

import pytest

from in_memory import ROOT, analysed
from robocomp_yaml.source import spelled
from robocomp_yaml.source.spelled import DocumentTexts
from robocomp_yaml.source.tree import parse


def test_what_was_read_is_not_parsed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    again: list[str] = []
    monkeypatch.setattr(spelled, "parse", lambda path, text: again.append(path) or parse(path, text))
    found = analysed({
        "Sound.idsl.yaml": "module: RoboCompSound\ntypes: {Wave: {sequence: flaot}}  # rcyaml: allow RC1030 -- ours\n",
        "Mouth.idsl.yaml": "module: RoboCompMouth\nimports: [Sounds]\ninterfaces: {Mouth: {methods: {say: {in: {wave: Wave}}}}}\n",
    })  # fmt: skip
    fixes = [(told.code, edit.text) for told in found.diagnostics for fix in told.fixes for edit in fix.edits]
    assert ("RC1010", "float") in fixes
    assert ("RC1101", "Sound") in fixes
    assert again == []


def test_what_was_not_read_is_parsed_when_it_is_asked_for() -> None:
    texts = DocumentTexts({f"{ROOT}/a.yaml": b"a: [b]\n", f"{ROOT}/b.yaml": b"\xff"}, {})
    text = texts.get(f"{ROOT}/a.yaml")
    assert text is not None
    assert text.tree is not None
    assert text.tree.data == {"a": ["b"]}
    assert texts.get(f"{ROOT}/b.yaml") is None
    assert texts.get(f"{ROOT}/c.yaml") is None


@pytest.mark.parametrize("name", ["...", "... x", "1e3", "null", "0x1F", ".5", "007", "~"])
def test_a_name_that_would_be_read_otherwise_stands_in_quotes(name: str) -> None:
    assert not spelled._is_text(name)


@pytest.mark.parametrize("name", ["Speech", "../common/Speech", "a b", "1_000", "on", "12.5.1"])
def test_a_name_that_is_a_text_does_not(name: str) -> None:
    assert spelled._is_text(name)
