"""A long document is what it says, whoever parses it: libyaml as a whole, or, if libyaml rejects it, its entries one by
one."""

from __future__ import annotations

import pytest

from robocomp_yaml.link.documents import read_tree
from robocomp_yaml.source import parts
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import parse

NOTE = "a long document has long texts, " * 20  # the parser of last resort takes its time for each token
HEAD = "parameters:\n" + "".join(f"  p{n}: {{type: int, default: {n}, doc: '{NOTE}'}}\n" for n in range(12))


@pytest.mark.parametrize(
    ("end", "codes"),
    [
        ("", []),
        ("  last: [a:b, c?d]\n", []),  # YAML 1.2 alone
        ("  last: [a, b\n", ["RC0101"]),
        ("  last: {a: b: c}\n", ["RC0101"]),
        ("  p7: {}\n", ["RC0103"]),
        ("  last: *none\n", ["RC0101"]),
        ("  \u2028: [a\u0085:b]\n", []),
    ],
)
def test_it_is_read_as_its_text_is_parsed(end: str, codes: list[str]) -> None:
    text = HEAD + end
    assert len(text) > parts.LONG
    tree, found = read_tree("/memory/a.yaml", Disk({"/memory/a.yaml": text.encode()}))
    expected, diagnostics = parse("/memory/a.yaml", text)
    assert [one.code for one in found] == codes and found == diagnostics
    assert (tree.data if tree else None) == (expected.data if expected else None)
    assert (tree.span if tree else None) == (expected.span if expected else None)
