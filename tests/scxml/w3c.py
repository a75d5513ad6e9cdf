"""The mandatory cases of the W3C's SCXML implementation report, as components of rcyaml.

A case passes when its machine, read, checked and made into tables as any other, ends in the state `pass`. Time is not
waited for: the clock jumps to whatever is due next.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from conftest import ROOT
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.pipeline import analyse

FOLDER = ROOT.parent / "shared" / "scxml" / "python"
needs_cases = pytest.mark.skipif(not FOLDER.is_dir(), reason="the W3C's SCXML cases are not beside the checkout")

PASSED = "passed"
SCRIPTING = "needs variables and expressions"
_OF_THE_DATA_MODEL = {"RC2216", "RC2217", "RC2218"}


@dataclass(frozen=True)
class Case:
    """A case as it was read: with its machine, or with what rcyaml says against it."""

    name: str
    machine: StateMachine | None
    errors: list[Diagnostic]

    @property
    def refusal(self) -> str:
        """Why it cannot be run."""
        if any(error.code in _OF_THE_DATA_MODEL for error in self.errors):
            return SCRIPTING
        return f"refused: {self.errors[0].message}"


def names() -> list[str]:
    """Files called `sub` are parts of others."""
    found = [path.stem for path in FOLDER.glob("test*.scxml") if "sub" not in path.stem]
    return sorted(found, key=lambda name: (int(re.sub(r"\D", "", name)), name))


def read(name: str, language: str, folder: Path) -> Case:
    """A case as a component in this language; in C++ with the data model that there is."""
    home = folder / name
    home.mkdir(parents=True)
    for path in FOLDER.glob(f"{name}*"):
        if path.suffix == ".scxml":
            (home / path.name).write_text(_text(path, language), encoding="utf-8")
        else:
            shutil.copyfile(path, home / path.name)
    document = home / "case.cdsl.yaml"
    document.write_text(f"component: Case\nlanguage: {language}\nstatemachine: {name}.scxml\n", encoding="utf-8")
    analysis = analyse([str(home)])
    errors = [diagnostic for diagnostic in analysis.diagnostics if diagnostic.severity == ERROR]
    [component] = analysis.program.components.values()
    return Case(name, component.machine if not errors else None, errors)


def _text(path: Path, language: str) -> str:
    text = path.read_text(encoding="utf-8-sig")
    if language == "cpp":
        return text.replace('datamodel="python"', 'datamodel="null"')
    if "datamodel=" not in text:  # case 302 says none, and means Python
        return text.replace("<scxml ", '<scxml datamodel="python" ', 1)
    return text


def report(python: dict[str, str], cpp: dict[str, str]) -> str:
    """The list for docs/statemachines.md."""
    lines = [f"{_count(python)} of {len(python)} cases pass in Python, {_count(cpp)} in C++.", ""]
    lines += ["| case | Python | C++ |", "|---|---|---|"]
    lines += [f"| {name.removeprefix('test')} | {python[name]} | {cpp[name]} |" for name in python]
    return "\n".join(lines) + "\n"


def _count(verdicts: dict[str, str]) -> int:
    return list(verdicts.values()).count(PASSED)
