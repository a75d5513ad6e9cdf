"""Documents to write: their trees equal those of the parsed texts."""

from __future__ import annotations

import pytest

from robocomp_yaml.legacy.document import (
    TRUE,
    Doc,
    DocumentEntry,
    List,
    Map,
    Notes,
    Raw,
    ReferredName,
    Value,
    text,
    tree,
)
from robocomp_yaml.source.tree import Node, Scalar, parse


def _map(**entries: Value) -> Map:
    return Map([DocumentEntry(key, value) for key, value in entries.items()])


@pytest.mark.parametrize(
    "value",
    [
        "speed", "", "007", "true", "~", "1e3", "a: b", "# no comment", "it's", 'a "quote"', "tab\tin it", "- item", "é\u2028ü",
        Raw("7"), Raw("-0x1F"), Raw(".5"), Raw("-.inf"), Raw("2000."), TRUE, None,
        ReferredName("RoboCompSpeech.Pose"), Doc("how fast it goes"),
        Map(), List(), List.of(["a", Raw("1"), None, List.of(["b"])]),
        _map(type="float", default=Raw("1.50"), doc=Doc("half of it")), _map(struct=Map(block=True, entries=[DocumentEntry("x", "int")])),
    ],
)  # fmt: skip
def test_its_tree_equals_the_parsed_text(value: Value) -> None:
    document = Map(
        [
            DocumentEntry("first", "1"),
            DocumentEntry("on", value, Notes(head=["a comment"])),
            DocumentEntry("2d", _map(inner=value)),
        ]
    )
    read, said = parse("", text(document, Notes()))
    made = tree(document)
    assert read is not None
    assert not said
    assert made.data == read.data
    assert _lexemes(made) == _lexemes(read)


def _lexemes(node: Node) -> list[object]:
    """The lexemes as spelled, except an empty value, which is `null` in flow style."""
    own = node.lexeme if isinstance(node, Scalar) and node.data is not None else None
    return [own, *(_lexemes(child) for child in node.children())]
