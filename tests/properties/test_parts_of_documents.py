"""A document that is parsed in parts, again and again while it is edited, is the same as when it is parsed at once:
values, texts and all locations."""

from __future__ import annotations

from random import Random

import pytest

from robocomp_yaml.source import parts, syntax
from robocomp_yaml.source.syntax import SyntaxFault
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, parse

DOCUMENTS = [
    "# long\nmodule: RoboCompLong\n\ninterfaces:  # all\n"
    + "".join(f"  I{n}:\n    methods:\n      call: {{in: {{a: int}}}}\n      # inside\n" for n in range(5))
    + "\ntopics:\n  T: {methods: {m: }}\n",
    "deployment: D\ncomponents:\n"
    + "".join(f"    c{n}: {{program: sh, args: [-c, 'sleep {n}']}}\n\n" for n in range(6))
    + "    # the end\n",
    "parameters:\r\n" + "".join(f"  p{n}: {{type: int, default: {n}}}\r\n" for n in range(6)) + "doc: |\r\n  a\r\n\r\n  b: c\r\n",
    "doc: >+\n  folded\n\n  text: x\n\nimports:\n- A\n- B\ntypes:\n  A: {enum: [a,\n    b]}\n  B:\n  C: 'two\n    lines'\n  D: \"x\\\n    y\"\n  E: plain\n    goes on\n",
    "a: {b: 1}\nc:\n  d: x\n  'e f': y\n  \"g\": [1,\n  2]\n  h: |\n    x: 1\n     y\n  i:\n    - 1\n    -  k: 2\n       l: 3\nz: \n",
]  # fmt: skip
INSERTED = [
    "# c",
    "",
    "  z: 1",
    "y: {a: 1}",
    "    # d",
    "  - x",
    " q: 'it",
    "  n: R&D",
    "---",
    "  ? k",
    "\t",
    "    more",
    "Z: 1",
    "  P:",
    "  Z: 2",
]


def same(one: Node, other: Node) -> None:
    assert type(one) is type(other) and one.data == other.data
    assert (one.span, one.start, one.end) == (other.span, other.start, other.end), one.data
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        assert list(one.entries) == list(other.entries) and one.is_flow == other.is_flow
        for (key, value), (key2, value2) in zip(one.items(), other.items(), strict=True):
            same(key, key2)
            same(value, value2)
    if isinstance(one, Sequence) and isinstance(other, Sequence):
        for item, item2 in zip(one.items, other.items, strict=True):
            same(item, item2)
    if isinstance(one, Scalar) and isinstance(other, Scalar):
        assert (one.lexeme, one.quoted) == (other.lexeme, other.quoted)


def edited(text: str, random: Random) -> str:
    lines = text.split("\n")
    at, other = random.randrange(len(lines)), random.randrange(len(lines))
    match random.randrange(7):
        case 0:
            lines.insert(at, random.choice(INSERTED))
        case 1:
            del lines[at]
        case 2:
            lines.insert(at, lines[other])
        case 3:
            lines[at] = lines[at].replace("a", "bb", 1)
        case 4:
            lines[at], lines[other] = lines[other], lines[at]
        case 5:
            lines[at] = " " * random.randrange(4) + lines[at]
        case 6:
            lines[at] = lines[at].replace(" ", random.choice([' "', " '", " {", " [", " |", "  "]), 1)
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(20))
def test_parts_are_the_whole(monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    monkeypatch.setattr(parts, "LONG", 0)
    monkeypatch.setattr(parts, "FEW", 2)
    random = Random(seed)
    for document in DOCUMENTS:
        text, known, in_parts = document, parts.Parts(), 0
        for _ in range(25):
            whole, found = parse("a.yaml", text)
            try:
                made = parts.parse_in_parts("a.yaml", text, known)
            except SyntaxFault as fault:
                assert whole is None and found == [fault.diagnostic], text
                made = None
            if made is not None:
                in_parts += 1
                assert whole is not None and not found, text
                same(whole, made)
            text = edited(text, random) if random.random() < 0.8 else document
        assert in_parts


def test_only_what_changed_is_parsed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "components:\n" + "".join(f"  c{n}: {{program: sh, args: ['{n}']}}\n" for n in range(400))
    known = parts.Parts()
    first = parts.parse_in_parts("a.yaml", text, known)
    parsed: list[str] = []
    part = parts.part
    monkeypatch.setattr(parts, "part", lambda path, text, base: parsed.append(text) or part(path, text, base))
    again = parts.parse_in_parts("a.yaml", text.replace("'7'", "'seven'"), known)
    assert first is not None and again is not None and len(parsed) == 1
    before, after = first.entries["components"][1], again.entries["components"][1]
    assert isinstance(before, Mapping) and isinstance(after, Mapping)
    assert after.entries["c300"][1] is before.entries["c300"][1]
    assert after.entries["c7"][1] is not before.entries["c7"][1]


@pytest.mark.parametrize("broken", ["  c390: {program: sh, args: [", "  c390: {program: 'sh}", "  c390 x"])
def test_a_long_document_that_is_broken_near_its_end_is_parsed_from_there(
    monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    """The parser of YAML 1.2, which is slow, reads a few lines."""
    lines = [f"  c{n}: {{program: sh, args: ['{n}']}}" for n in range(400)]
    read: list[int] = []
    slow = syntax._compose_as_1_2
    monkeypatch.setattr(syntax, "_compose_as_1_2", lambda text: read.append(len(text)) or slow(text))
    known = parts.Parts()
    assert parts.parse_in_parts("a.yaml", "components:\n" + "\n".join(lines) + "\n", known)
    lines[390] = broken
    text = "components:\n" + "\n".join(lines) + "\n"
    with pytest.raises(SyntaxFault) as caught:
        parts.parse_in_parts("a.yaml", text, known)
    assert sum(read) < len(text) / 10
    assert parse("a.yaml", text) == (None, [caught.value.diagnostic])


@pytest.mark.parametrize("seed", range(4))
def test_what_is_refused_nearby_is_refused_as_a_whole(monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    """With the lines around an error alone, the same is YAML, and the errors are the same."""
    random, nearby, quick = Random(seed), syntax._is_refused_nearby, []
    for document in DOCUMENTS:
        text = document
        for _ in range(40):
            text = edited(text, random) if random.random() < 0.7 else edited(document, random)
            monkeypatch.setattr(syntax, "_LONG", 1 << 30)
            slow = parse("a.yaml", text)
            monkeypatch.setattr(syntax, "_LONG", 0)
            monkeypatch.setattr(syntax, "_is_refused_nearby", lambda *args: quick.append(nearby(*args)) or quick[-1])
            fast = parse("a.yaml", text)
            assert fast[1] == slow[1], text
            assert (fast[0] is None) == (slow[0] is None), text
    assert sum(quick) > 20


def test_an_error_in_a_long_list_is_found_fast(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    slow = syntax._compose_as_1_2
    monkeypatch.setattr(syntax, "_compose_as_1_2", lambda text: read.append(len(text)) or slow(text))
    text = "points:\n" + "".join(f"- {{x: {n}, y: 2}}\n" for n in range(2000))
    _, found = parse("a.yaml", text.replace("x: 1500, y: 2}", "x: 1500, y: 2"))
    assert [(one.code, one.span.line) for one in found] == [("RC0101", 1503)]
    assert sum(read) < 200
