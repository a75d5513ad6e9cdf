"""Formatting keeps what documents say, and their comments; and a second time changes nothing."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from layouts import laid_out
from robocomp_yaml.source import text
from robocomp_yaml.source.formatting import formatted, same_content
from robocomp_yaml.source.tree import parse

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted(
    path for folder in ("examples", "templates", "tests/editor/documents", "tests/golden")
    for path in (ROOT / folder).rglob("*.yaml")
)  # fmt: skip
words = st.text(max_size=12) | st.sampled_from(
    ["yes", "12:30", "1_000", "0x1F", "007", "-c", "a: b", "#", "x #y", "- ", "?", "{", "*a", "'", '"', "\\", "", " ",
     "two\nlines", "a\n\nb\n", "\u2028", "é", "null", ".5", "1e3", "a,b", "x:y", "%", "@", "---", "..."]
)  # fmt: skip
scalars = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | words
data = st.recursive(scalars, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(words, inner, max_size=4))


def check(before: str) -> None:
    tree, faults = parse("x", before)
    if tree is None or faults:
        return
    after = formatted(before)
    again, faults = parse("x", after)
    assert not faults and same_content(tree, again), (before, after)
    assert formatted(after) == after, before
    assert ("\r" not in after and not re.search(r"\A\n|\n\n\Z|[^\n]\Z", after)) or "|+" in after or ">+" in after


@settings(max_examples=400, deadline=None)
@given(st.dictionaries(words, data, min_size=1, max_size=5), st.integers(0, 2**32))
def test_documents_in_any_layout(document: dict[str, object], seed: int) -> None:
    raw = laid_out(document, Random(seed))
    before, faults = text.decode("x", raw)
    assert before is not None, faults
    check(before)
    comments = re.findall(r"# (?:c\d+|first|last)\b", before)
    assert re.findall(r"# (?:c\d+|first|last)\b", formatted(before)) == comments


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_documents_of_the_project(path: Path) -> None:
    before, _ = text.decode(str(path), path.read_bytes())
    check(before or "")


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(DOCUMENTS), st.randoms(use_true_random=False))
def test_documents_with_other_blanks(path: Path, random: Random) -> None:
    """More blanks where there are some already, and blank lines and comments between lines."""
    before = path.read_text(encoding="utf-8")
    lines = []
    for line in before.splitlines():
        if random.random() < 0.1:
            lines.append(random.choice(["", "   ", " " * random.randrange(9) + "# c"]))
        lines.append(re.sub(r"(?<=\S) (?=\S)", lambda _: " " * random.choice([1, 1, 1, 2, 5]), line))
    check("\n".join(lines))
