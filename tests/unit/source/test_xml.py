"""XML is read without trust, and every value has its place."""

from __future__ import annotations

import pytest

from robocomp_yaml.source.xml import MAX_ATTRIBUTES, MAX_DEPTH, MAX_ELEMENTS, parse


def codes(text: str) -> list[tuple[str, int, int]]:
    root, said = parse("m.scxml", text)
    assert (root is None) == bool(said)
    return [(d.code, d.span.line, d.span.column) for d in said]


BILLION_LAUGHS = (
    "<!DOCTYPE a ["
    + "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10 if n else "lol"}">' for n in range(10))
    + "]>\n<a>&l9;</a>"
)


@pytest.mark.parametrize(("text", "said"), [
    ('<!DOCTYPE a SYSTEM "file:///etc/passwd">\n<a/>', ("RC2203", 1, 1)),
    ('<?xml version="1.0"?>\n<!DOCTYPE a [<!ENTITY e SYSTEM "http://127.0.0.1/x">]><a>&e;</a>', ("RC2203", 2, 1)),
    ('<!DOCTYPE a [<!ENTITY % p SYSTEM "x.dtd"> %p;]><a/>', ("RC2203", 1, 1)),
    (BILLION_LAUGHS, ("RC2203", 1, 1)),
    ("<a>&lol;</a>", ("RC2202", 1, 4)),
    ("<a>\n  <b></a>", ("RC2202", 2, 8)),
    ("<a x='1' x='2'/>", ("RC2202", 1, 10)),
    ("", ("RC2202", 1, 1)),
    ("no xml at all", ("RC2202", 1, 1)),
    ("<a/><a/>", ("RC2202", 1, 5)),
    ("<a xmlns:b='c'><d:e/></a>", ("RC2202", 1, 16)),
    ("<a>\0</a>", ("RC2202", 1, 4)),
], ids=lambda value: repr(value)[:40])  # fmt: skip
def test_what_is_refused(text: str, said: tuple[str, int, int]) -> None:
    assert codes(text) == [said]


def test_depth_and_size_are_bounded() -> None:
    assert codes("<a>" * MAX_DEPTH + "</a>" * MAX_DEPTH) == []
    assert codes("<a>" * 100_000)[0][0] == "RC2204"
    assert codes("<a>" + "<b/>" * MAX_ELEMENTS + "</a>")[0][0] == "RC2204"
    several = " ".join(f'b{n}=""' for n in range(MAX_ATTRIBUTES))
    assert codes(f"<a {several}/>") == []
    assert codes(f'<a {several} c=""/>') == [("RC2204", 1, 1)]


def test_places_and_texts() -> None:
    text = '<a x = "1 &gt; 0"\n   y:z=\'é\' xmlns:y="urn:y">ä<b k="v"/>c<!-- x --><d>e</d></a>'
    root, _ = parse("m.scxml", text)
    assert root is not None
    span = root.place("x")
    assert (span.line, span.column, span.end_column) == (1, 9, 17)
    assert root.attributes == {"x": "1 > 0", "urn:y z": "é"}
    assert [child.name for child in root.children] == ["b", "d"]
    assert root.text == "äc"
    b, d = root.children
    assert (b.span.line, b.span.column, b.place("k").column) == (2, 29, 35)
    assert (b.raw, d.raw, root.raw) == ('<b k="v"/>', "<d>e</d>", text)
    assert d.place("missing") == d.span


INNER = (
    "<b/>", "<b />", "<b x='/>'/>", "<b></b>", "<b>/></b>", "<b><c/></b>", '<p:b\n x = "1"\n/>', "<b><!-- /> --></b >",
)  # fmt: skip


@pytest.mark.parametrize("inner", INNER)
def test_an_element_is_as_written_from_its_first_to_its_last_bracket(inner: str) -> None:
    text = f"<a xmlns:p='u'>\U0001f916{inner}</a>"
    root, faults = parse("a.xml", text)
    assert root is not None and not faults
    (child,) = root.children
    assert child.raw == inner and root.raw == text
    for element, count in ((root, 2), (child, 1 if inner.endswith("/>") else 2)):
        named = [text.split("\n")[tag.line - 1][tag.column - 1 : tag.end_column - 1] for tag in element.tags]
        assert named == [element.name] * count
