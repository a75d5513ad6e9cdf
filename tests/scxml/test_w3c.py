"""The W3C's cases: each passes in both languages, or is listed with the reason why not."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import engines
import w3c
from conftest import ROOT
from cpp_traces import in_cpp  # noqa: F401 (the fixture)

pytestmark = w3c.needs_cases

# Why a case does not pass in Python. What is not listed here passes.
NOT_IN_PYTHON = {
    "test216": "`srcexpr` would need a reader of SCXML at run time: what is invoked is compiled in",
    "test240": "refused: unknown state 'subFinal1'",
    "test352": "the port compares with 'scxml', the W3C and case 198 with the processor's address",
    "test401": "refused: <assign> has no attribute 'location', which is required",
    "test525": "the port adds a text to a list, which Python does not",
}


def _python(folder: Path) -> dict[str, str]:
    """Each case's verdict."""
    cases = [w3c.read(name, "python", folder / "cases") for name in w3c.names()]
    ended = engines.run_python({case.name: case.machine for case in cases if case.machine}, folder)
    return {
        case.name: case.refusal if case.machine is None else w3c.PASSED if ended[case.name].last == "pass"
        else NOT_IN_PYTHON.get(case.name, f"ended in {ended[case.name].last}")
        for case in cases
    }  # fmt: skip


def _cpp(folder: Path, ended: dict[str, engines.Trace]) -> dict[str, str]:
    cases = [w3c.read(name, "cpp", folder) for name in w3c.names()]
    return {
        case.name: case.refusal if case.machine is None else w3c.PASSED if ended[case.name].last == "pass"
        else f"ended in {ended[case.name].last}"
        for case in cases
    }  # fmt: skip


def test_python_passes_all_but_those_listed(tmp_path: Path) -> None:
    verdicts = _python(tmp_path)
    assert {name: why for name, why in verdicts.items() if why != w3c.PASSED} == NOT_IN_PYTHON
    assert list(verdicts.values()).count(w3c.PASSED) >= 152


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("g++"), reason="g++ is not installed")
def test_cpp_passes_every_case_that_needs_no_scripting_language_and_the_docs_list_all(
    tmp_path: Path, in_cpp: Callable[[], dict[str, engines.Trace]]
) -> None:
    python, cpp = _python(tmp_path / "python"), _cpp(tmp_path / "cpp", in_cpp())
    missing = {name: why for name, why in cpp.items() if why not in (w3c.PASSED, w3c.SCRIPTING)}
    assert missing == {name: NOT_IN_PYTHON[name] for name in ["test401"]}
    text = (ROOT / "docs" / "statemachines.md").read_text(encoding="utf-8")
    listed = re.search(r"<!-- W3C -->\n(.*)<!-- /W3C -->", text, re.DOTALL)
    assert listed and listed[1] == w3c.report(python, cpp), "the list to put there:\n" + w3c.report(python, cpp)
