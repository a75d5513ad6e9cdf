"""XML text as a tree of positioned elements, read without trust: no DTD, no entities, bounded nesting.

The parser is expat, Python's own; whatever could make it fetch or expand something is refused before it does. It keeps
no stack of its own, so depth costs nothing until this module says that it is enough.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from xml.parsers import expat

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span

MAX_DEPTH = 100
MAX_ELEMENTS = 100_000

_SEPARATOR = " "  # no namespace and no name holds one
_ATTRIBUTE = re.compile(r"""([^\s=<>/"']+)\s*=\s*("[^"]*"|'[^']*')""")


@dataclass(slots=True)
class Element:
    """`name` and `namespace` are apart; an attribute of a namespace is called 'namespace name'; `content` are texts and
    elements in their order. `raw` is the element as it is spelled, from its first '<' to its last '>'."""

    name: str
    namespace: str
    attributes: dict[str, str]
    span: Span
    places: dict[str, Span] = field(default_factory=dict)
    content: list[str | Element] = field(default_factory=list)
    raw: str = ""

    @property
    def children(self) -> list[Element]:
        return [item for item in self.content if isinstance(item, Element)]

    @property
    def text(self) -> str:
        """The characters that stand directly in it."""
        return "".join(item for item in self.content if isinstance(item, str))

    def get(self, name: str) -> str | None:
        return self.attributes.get(name)

    def place(self, name: str) -> Span:
        """Where an attribute's value stands, else the element's tag."""
        return self.places.get(name, self.span)


class _Refused(Exception):
    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def parse(path: str, text: str) -> tuple[Element | None, list[Diagnostic]]:
    """The document's root; None with the reason where it is no XML, or not of the kind that is taken."""
    reader = _Reader(path, text)
    try:
        reader.parser.Parse(reader.raw, True)
    except _Refused as refused:
        return None, [refused.diagnostic]
    except expat.ExpatError as error:
        line, column = error.lineno, error.offset + 1
        reason = expat.ErrorString(error.code)
        return None, [codes.NOT_XML.at(Span(path, line, column, line, column + 1), reason=reason)]
    return reader.root, []


class _Reader:
    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.raw = text.encode()
        self.lines = text.split("\n")
        self.root: Element | None = None
        self._open: list[tuple[Element, int]] = []
        self._count = 0
        self.parser = parser = expat.ParserCreate("utf-8", _SEPARATOR)
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.StartDoctypeDeclHandler = self._doctype
        parser.EntityDeclHandler = self._entity

    def _here(self, length: int = 1) -> Span:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        return Span(self.path, line, column, line, column + length)

    def _doctype(self, *_: object) -> None:
        raise _Refused(codes.XML_REFUSED.at(self._here(9), what="a document type (<!DOCTYPE …>)"))

    def _entity(self, *_: object) -> None:
        raise _Refused(codes.XML_REFUSED.at(self._here(), what="an entity"))

    def _start(self, full_name: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if len(self._open) >= MAX_DEPTH or self._count > MAX_ELEMENTS:
            limit = f"more than {MAX_DEPTH} levels deep" if self._count <= MAX_ELEMENTS else f"{MAX_ELEMENTS} elements"
            raise _Refused(codes.XML_TOO_LARGE.at(self._here(), limit=limit))
        namespace, _, name = full_name.rpartition(_SEPARATOR)
        element = Element(name, namespace, attributes, self._here(len(name) + 1))
        if attributes:
            element.places = self._places()
        if self._open:
            self._open[-1][0].content.append(element)
        else:
            self.root = element
        self._open.append((element, self.parser.CurrentByteIndex))

    def _end(self, _: str) -> None:
        element, start = self._open.pop()
        here = self.parser.CurrentByteIndex
        end = self.raw.find(b">", here) + 1 if self.raw[here : here + 2] == b"</" else here
        element.raw = self.raw[start:end].decode(errors="replace")

    def _characters(self, text: str) -> None:
        if self._open:
            self._open[-1][0].content.append(text)

    def _places(self) -> dict[str, Span]:
        """The values of the current tag's attributes, found again in the text (expat does not tell)."""
        first, column = self.parser.CurrentLineNumber - 1, self.parser.CurrentColumnNumber
        places: dict[str, Span] = {}
        for number in range(first, min(first + 50, len(self.lines))):
            line = self.lines[number]
            start = column if number == first else 0
            for match in _ATTRIBUTE.finditer(line, start):
                left, right = match.start(2) + 1, match.end(2)
                places.setdefault(match[1], Span(self.path, number + 1, left + 1, number + 1, right))
            if ">" in _ATTRIBUTE.sub("", line[start:]):
                break
        return places
