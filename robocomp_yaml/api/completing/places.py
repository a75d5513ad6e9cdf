"""Where the cursor is in a document that is being typed: the keys around it, also if a bracket is not closed yet."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

import msgspec

from robocomp_yaml.source.text import decode, encoded
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, parse, value_at

MARK = "rcyaml0cursor"
_WORD = r"(?:[\w./-]|(?<=[\w\]])\[\d+\])*"  # with paths of parameters (`joints[0].vel`)
_BEFORE, _BEHIND = re.compile(rf"{_WORD}\Z"), re.compile(_WORD)
_OPERAND = re.compile(r"(?:[\w.]|(?<=[\w\]])\[\d+\])*\Z")
_OPERAND_BEHIND = re.compile(r"[\w.]*")
_LINE_END = re.compile("\r\n|\r|\n")
_OPENED = {"[": "]", "{": "}"}
_PIECE = re.compile(
    r"(?<![^\s])\#[^\r\n]*|(?<![^\s\[{,])(?P<quoted>'(?:[^']|'')*'?|\"(?:[^\"\\]|\\.)*\"?)|[\[\]{}]", re.DOTALL
)
_QUOTED = re.compile(r"'(?:[^']|'')*'|\"(?:[^\"\\]|\\.)*\"", re.DOTALL)
_FAR, _MOST = 40, 5  # lines above, and ways to close them


class TypedPlace(msgspec.Struct, frozen=True):
    """`keys` are the keys around the cursor, with '' for an item of a list; `is_key` says that a key is typed there,
    and not a value: one with a colon, in braces, or in a line of its own below a key. The word at the cursor is in
    these columns of the line; if it is in a text with blanks, that is the whole text, without its quotes, unless the
    text is an expression (`is_in_expression`). `quote` is
    the quote before it, or ''; `word` is what is typed before the cursor. `around` is the mapping in which a key is
    typed, or the list in which an element is; `has_colon`: the key has its colon already. `root` is the document with a
    mark instead of the word, and `text` its text."""

    keys: tuple[str, ...]
    is_key: bool
    line: int
    column: int
    end_column: int
    root: Mapping
    text: str
    quote: str = ""
    word: str = ""
    around: Mapping | Sequence | None = None
    has_colon: bool = False

    @property
    def is_in_expression(self) -> bool:
        return _is_expression(self.keys, self.is_key)


def _is_expression(keys: tuple[str, ...], is_key: bool) -> bool:
    return not is_key and keys in (("constraints", ""), ("constraints", "", "that"))


def typed_at(text: str, line: int, column: int) -> TypedPlace | None:
    """The place at a line and column (from 1); None if it is in a comment, or the document is too broken."""
    if decode("", encoded(text))[0] is None:
        return None
    starts = [0, *(end.end() for end in _LINE_END.finditer(text))]
    if line > len(starts):
        return None
    index = min(starts[line - 1] + column - 1, len(text))
    begin, end = _BEFORE.search(text, starts[line - 1], index), _BEHIND.match(text, index)
    assert begin is not None and end is not None
    before, behind = text[: begin.start()], text[end.end() :]
    own = before[starts[line - 1] :]
    if re.search(r"(?:^|\s)#", own):
        return None
    rest_of_line = _LINE_END.search(behind)
    rest = behind[: rest_of_line.start()] if rest_of_line is not None else behind
    below = behind[len(rest) :]
    closed = f"{before}{MARK}{_closing(own)}"
    whole_line = f"{before}{MARK}{rest}{_closing(own + rest)}{below}"
    attempts = [f"{before}{MARK}{behind}", whole_line, f"{closed}{below}", f"{closed}\n"]
    if not own.strip() and not behind.strip(" \t")[:1].strip():  # a key is begun in a line of its own
        attempts.append(f"{before}{MARK}:{below}")
    in_brackets = (f"{before}{MARK}{closing}{end}" for closing in _above(before) for end in (below, "\n"))
    for attempt in chain(attempts, in_brackets):
        root, _ = parse("", attempt)
        keys = _keys_around(root) if isinstance(root, Mapping) else None
        if keys is not None and isinstance(root, Mapping):
            steps, is_key, node, around = keys
            is_key = is_key or (not own.strip(" \t\"'") and steps[-1:] != ("",))
            start, size = begin.start() - starts[line - 1] + 1, end.end() - begin.start()
            stop = start + size
            if _is_expression(steps, is_key):  # `-` and `/` are operators there
                head, tail = _OPERAND.search(text, starts[line - 1], index), _OPERAND_BEHIND.match(text, index)
                assert head is not None and tail is not None
                start, stop = head.start() - starts[line - 1] + 1, tail.end() - starts[line - 1] + 1
            elif node.lexeme != MARK:
                start = node.span.column + node.quoted
                stop = node.span.end_column - node.quoted - len(MARK) + size
            quote = attempt[node.start] if node.quoted else ""
            word = text[starts[line - 1] + start - 1 : index]
            has_colon = is_key and behind.lstrip(" \t\"'").startswith(":")
            return TypedPlace(steps, is_key, line, start, stop, root, attempt, quote, word, around, has_colon)
    return None


def _above(before: str) -> Iterator[str]:
    """What may close brackets that were opened in a line above, the nearest one first. In text, brackets mean
    nothing, so that more than one has to be tried."""
    known = {_closing(before[before.rfind("\n") + 1 :]), ""}
    start = len(before)
    for _ in range(_FAR):
        start = before.rfind("\n", 0, max(start - 1, 0)) + 1
        closing = _closing(before[start:])
        if closing not in known:
            known.add(closing)
            yield closing
        if not start or len(known) > _MOST:
            return


def _closing(text: str) -> str:
    """The quote and the brackets that close those which are open at the end of a text."""
    opened, quote = "", ""
    for match in _PIECE.finditer(text):
        piece = match[0]
        if match["quoted"]:
            is_closed = len(piece) > 1 and piece[-1] == piece[0] and _QUOTED.fullmatch(piece)
            quote = "" if is_closed else piece[0]
        elif piece in _OPENED:
            opened = _OPENED[piece] + opened
        elif opened and piece == opened[0]:
            opened = opened[1:]
    return quote + opened


_Found = tuple[tuple[str, ...], bool, Scalar, Mapping | Sequence | None]


def _keys_around(node: Node, outer: tuple[str, ...] = ()) -> _Found | None:
    """The keys around the mark, whether it is a key, its node, and the mapping of the key or list of the element."""
    if isinstance(node, Scalar):
        is_there = MARK in node.lexeme and f":{MARK}" not in node.lexeme and node.span.line == node.span.end_line
        return (outer, False, node, None) if is_there else None
    if isinstance(node, Mapping):
        for key, value in node.items():
            if key.lexeme == MARK:
                return outer, True, key, node
            if found := _keys_around(value, (*outer, key.lexeme)):
                return found
    if isinstance(node, Sequence):
        for item in node.items:
            if found := _keys_around(item, (*outer, "")):
                return (*found[:3], node) if found[2] is item else found
    return None


def siblings(place: TypedPlace) -> list[str]:
    """The keys of the mapping, or the plain elements of the list, in which something is typed."""
    if isinstance(place.around, Sequence):
        return [one.lexeme for one in place.around.items if isinstance(one, Scalar) and MARK not in one.lexeme]
    return [key for key in place.around.entries if key != MARK] if place.around is not None else []


def keys_of(root: Mapping, section: str) -> list[str]:
    """The keys of a section of a document."""
    found = root.get(section)
    return [key.lexeme for key, _ in found.items()] if isinstance(found, Mapping) else []


def items_of(root: Node | None, section: str) -> list[str]:
    """The elements of a list that a node has."""
    found = value_at(root, section)
    return [str(item.data) for item in found.items] if isinstance(found, Sequence) else []
