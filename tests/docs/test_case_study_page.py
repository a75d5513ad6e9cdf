"""docs/explanation/case-study.md says what each change of examples/case_study.py edits; --update-golden writes it."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Iterator
from types import ModuleType

import pytest

from conftest import ROOT

PAGE = ROOT / "docs" / "explanation" / "case-study.md"
CHANGES = (
    ("a proxy for MouthComp", "CDSL", "PROXY", "its parameters now have `MouthProxy`; it works without a mouth"),
    ("`mouthSynchronization`", "PDSL", "PARAMETER", "`param get` of the running component"),
    ("MouthComp joins the network", "DDSL", "DEPLOYMENT", "the mouth opens when it is called, and its motors move"),
    ("a method switches it while it runs", "IDSL, and the code of SpeechComp", "METHOD",
     "ten times a second, the opening while a text is said: it moves, and stays closed after `synchronizeMouth`"),
)  # fmt: skip
HEAD = (
    "| change | in the paper | documents edited | lines in documents | lines in `src/` | what is looked at from outside |\n"
    "|---|---|---|---:|---:|---|\n"
)


@pytest.fixture
def case_study(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    monkeypatch.syspath_prepend(str(ROOT / "examples"))
    import case_study

    yield case_study
    for name in ("case_study", "session"):
        monkeypatch.delitem(sys.modules, name, raising=False)


def lines_of(changes: tuple[tuple[str, str], ...]) -> int:
    """Lines that are written or changed, without blank ones, as the experiment counts them."""
    return sum(
        line.startswith("+ ") and bool(line[2:].strip())
        for old, new in changes
        for line in difflib.ndiff(old.splitlines(), new.splitlines())
    )


def table(module: ModuleType) -> str:
    text = HEAD
    for what, language, name, seen in CHANGES:
        edits = getattr(module, name)
        code = {path: changes for path, changes in edits.items() if "/src/" in path}
        documents = {path: changes for path, changes in edits.items() if path not in code}
        counts = (sum(map(lines_of, one.values())) for one in (documents, code))
        files = ", ".join(f"`{path.rpartition('/')[2]}`" for path in documents)
        text += f"| {' | '.join((what, language, files, *map(str, counts), seen))} |\n"
    return text


def test_the_table(case_study: ModuleType, request: pytest.FixtureRequest) -> None:
    before, _, rest = PAGE.read_text(encoding="utf-8").partition("<!-- table -->\n\n")
    inside, _, after = rest.partition("\n<!-- end -->\n")
    made = table(case_study)
    if request.config.getoption("--update-golden"):
        PAGE.write_text(f"{before}<!-- table -->\n\n{made}\n<!-- end -->\n{after}", encoding="utf-8")
        return
    assert inside == made
