"""Legacy files, changed at random: `migrate` never stumbles, and whatever it writes `check` accepts, or it said so."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from conftest import Tree
from fuzzing import as_bytes, changed, examples, run, standing_in, told
from legacy_seeds import of_corpus, seeds

SYNTAX = (
    "/*", "*/", "//", "\"", ";", "{", "}", "<", ">", "::", "=>", "=", ",", "#", "<?xml", "<!DOCTYPE x>", "&#0;", "&amp;", "]]>",
    '"true"', "0-10", "Motor0=a,1\n", "Motor1 = b\n", "Endpoints0=true,true\n", "Proxies.X = \"x:tcp -p 1\"\n", "Period = 1\n",
    "a.b = 1\na = 2\n", "legacy", "${env:HOME}", "\\#", "\\", "= ", "[[x]]\n", "module", "interface", "class", "Component", "\t",
)  # fmt: skip


@st.composite
def legacy_trees(draw: st.DrawFn) -> Tree:
    """A tree of which one file differs from a good one."""
    corpus = of_corpus()
    files = draw(st.sampled_from(seeds()) | st.sampled_from(corpus) if corpus else st.sampled_from(seeds()))
    name = draw(st.sampled_from(sorted(name for name, text in files.items() if text is not None)))
    text = files[name]
    assert text is not None
    text = text.decode("utf-8", "surrogateescape") if isinstance(text, bytes) else text
    made = draw(changed(text, SYNTAX))
    return {**files, name: as_bytes(made) if draw(st.integers(0, 9)) else made.encode("latin-1", "replace")}


def migrates(files: Tree, *options: str) -> None:
    with standing_in(files) as folder:
        # documents of an older form, and what rcyaml remembers, are brought up to date
        before = {path: path.read_bytes() for path in folder.rglob("*")
                  if path.is_file() and path.suffix != ".yaml" and path.parent.name != ".rcyaml"}  # fmt: skip
        result, _ = told("migrate", ".", "--report", "report.json", *options)
        if result.exit_code == 2:
            return
        assert {path: path.read_bytes() for path in before} == before, "what was there is as it was"
        report = json.loads((folder / "report.json").read_text())
        for entry in report["files"]:
            lines = dict(entry["lines"])
            assert lines.pop("total") == sum(lines.values()), entry
        check_accepts(report)
        again, _ = told("migrate", ".")
        assert again.exit_code == result.exit_code


def check_accepts(report: Mapping[str, Any]) -> None:
    """No error in a document of which `migrate` had nothing to say."""
    for entry in report["files"]:
        for path in entry["outputs"]:
            if path.endswith(".yaml") and entry["status"] != "skipped":
                _, found = told("check", path)
                wrong = [each for each in found if each["severity"] == "error" and each["file"] == path]
                is_told = {each["code"] for each in entry["diagnostics"]} & {
                    "RC5009",
                    "RC5010",
                    "RC5019",
                    "RC5026",
                    "RC5030",
                    "RC5039",
                }
                assert is_told or not wrong, (path, wrong)
    assert run("compile", "--dry-run").exit_code in (0, 1, 2)


@given(legacy_trees())
@examples(120)
def test_a_changed_file(files: Tree) -> None:
    migrates(files)


# Each kept as it was found, or smaller.
FOUND: dict[str, Tree] = {
    "a control character in what is no entry": {"etc/config": "\x08# Endpoints\na = 1\nb\x1b = 2  # \x07\nc = \x01\n"},
    "a quoted text above what looks like flat TOML": {"etc/config": 'Laser = "true"\nEndpoints0=true,true\n'},
}


@pytest.mark.parametrize("name", FOUND)
def test_what_was_found(name: str) -> None:
    migrates(FOUND[name])
