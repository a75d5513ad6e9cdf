"""The one reader of flat files: the places it gives are those of what it read, in the corpus and in random texts."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from conftest import CORPUS, needs_corpus
from robocomp_yaml.legacy import grammar, reading
from robocomp_yaml.source import properties

PIECES = ("\\", " ", "#", "=", "a", "bc", "\t", "\r", "\\ ", '"', "é", "\n", "\\\\", "\n", "a=1\n")
FILES = st.lists(st.sampled_from(PIECES), max_size=30).map("".join)


@given(FILES)
@example("\ufeffa=1 # one\n")
@example("a\\=b = x\\#y # c\n\\#\n\\ \n = 1")
def test_places_are_those_of_what_was_read(text: str) -> None:
    agree(text)


@needs_corpus
@pytest.mark.parametrize("kind", ["config", "toml"])
def test_places_are_those_of_what_was_read_in_the_corpus(kind: str) -> None:
    files = [path for path in sorted((CORPUS / kind).rglob("*")) if path.is_file()]
    sources = [source for path in files for source, _ in [reading.read(str(path))] if source is not None]
    assert len(sources) > 10
    for source in sources:
        agree(source.text)


def agree(text: str) -> None:
    found = properties.read(text)
    whole = text.removeprefix("\ufeff").split("\n")
    numbers = {line.number for line in found.lines}
    for number, line in enumerate(whole, 1):
        assert number in numbers or not line.strip(" \t\r"), f"line {number} is passed over"
    for line in found.lines:
        assert text[line.start : line.end] == whole[line.number - 1]
        said, comment = text[line.start : line.stop], text[line.stop : line.end]
        assert comment[:1] in ("", "#")
        alone = properties.read(f"{said}\n")
        assert [(entry.key, entry.value) for entry in alone.entries] == (
            [(line.entry.key, line.entry.value)] if line.entry else []
        )
        assert bool(alone.invalid) == line.is_invalid
        if line.entry:
            assert text[line.entry.at - 1] == "="
            assert properties.read(f"k={text[line.entry.at : line.stop]}").entries[0].value == line.entry.value
            assert text[line.start + line.entry.column - 1] not in " \t\r"
    parsed = grammar.parse_flat(text)
    for token in parsed.comments:
        assert text[token.start_pos : token.end_pos] == token and token.startswith("#")
    kept = sum(end - start for start, end in _places(parsed))
    assert kept + sum(text.count(c) for c in " \t\r\n") >= len(text.removeprefix("\ufeff")), "all else is in the tree"


def _places(parsed: grammar.Parsed) -> list[tuple[int, int]]:
    assert parsed.tree is not None
    spans = [
        (line.meta.start_pos, line.meta.end_pos) for line in parsed.tree.iter_subtrees() if line is not parsed.tree
    ]
    spans += [(token.start_pos or 0, token.end_pos or 0) for token in parsed.comments]
    spans.sort()
    assert all(end <= start for (_, end), (start, _) in pairwise(spans)), "nothing is there twice"
    return spans
