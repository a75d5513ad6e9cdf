"""Parses untrusted XML to a tree of elements with locations: no DTD, no entities, limited size and nesting.

The parser is Python's expat. A document type is rejected, so that the parser never fetches or expands anything. Expat
keeps no stack; this module limits the depth.
"""

from __future__ import annotations

import bisect
import re
from typing import NoReturn
from xml.parsers import expat

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Diagnosed
from robocomp_yaml.diag.span import Span

MAX_DEPTH = 100
MAX_ELEMENTS = 10_000
MAX_ATTRIBUTES = 100  # of one element

_DOCTYPE = "<!DOCTYPE"
_SEPARATOR = " "  # not allowed in namespaces and names
_TAG, _NAME = re.compile(r"<[^\s/>]+"), re.compile(r"[^\s/>]+")
_EMPTY = re.compile(r"\s*/>")
_ATTRIBUTE = re.compile(r"""\s+([^\s=<>/"']+)\s*=\s*("[^"]*"|'[^']*')""")


class Element(msgspec.Struct):
    """`attributes` maps names, or 'NAMESPACE NAME', to values, `places` to the locations of the values, and `names` to
    those of the names. `tags` are the locations of the element's own name, at its start and at its end. `content` are
    texts and elements in their order. The element is source[start:end], in bytes."""

    name: str
    namespace: str
    attributes: dict[str, str]
    span: Span
    places: dict[str, Span] = {}
    names: dict[str, Span] = {}
    tags: tuple[Span, ...] = ()
    content: list[str | Element] = []
    source: bytes = b""
    start: int = 0
    end: int = 0
    is_empty: bool = False

    @property
    def raw(self) -> str:
        """The element as written, from its first '<' to its last '>'."""
        return self.source[self.start : self.end].decode()

    @property
    def children(self) -> list[Element]:
        return [item for item in self.content if isinstance(item, Element)]

    @property
    def text(self) -> str:
        """The characters directly in the element."""
        return "".join(item for item in self.content if isinstance(item, str))

    def get(self, name: str) -> str | None:
        return self.attributes.get(name)

    def place(self, name: str) -> Span:
        """The location of an attribute's value; that of the element's tag if the attribute is absent."""
        return self.places.get(name, self.span)


def parse(path: str, text: str) -> tuple[Element | None, list[Diagnostic]]:
    """The document's root; None, with diagnostics, if the text is not XML, or is beyond the limits."""
    reader = _XmlReader(path, text)
    try:
        reader.parser.Parse(reader.raw, True)
    except Diagnosed as refused:
        return None, [refused.diagnostic]
    except expat.ExpatError as error:
        line, column = error.lineno, error.offset + 1
        reason = expat.ErrorString(error.code)
        return None, [codes.NOT_XML.at(Span(path, line, column, line, column + 1), reason=reason)]
    return reader.root, []


class _XmlReader:
    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.raw = text.encode()
        self.text = text
        self._lines = [0, *(at + 1 for at, character in enumerate(text) if character == "\n")]
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0
        self.parser = parser = expat.ParserCreate("utf-8", _SEPARATOR)
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.StartDoctypeDeclHandler = self._doctype

    def _here(self, length: int = 1) -> Span:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        return Span(self.path, line, column, line, column + length)

    def _doctype(self, *_: object) -> None:
        """Rejects document types, the only place in which entities can be declared."""
        start = max(self.text.find(_DOCTYPE), 0)
        what = "a document type (<!DOCTYPE …>)"
        raise Diagnosed(codes.XML_REFUSED.at(self._span(start, start + len(_DOCTYPE)), what=what))

    def _start(self, full_name: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MAX_ELEMENTS:
            self._too_large(f"too large: more than {MAX_ELEMENTS} elements")
        if len(self._open) >= MAX_DEPTH:
            self._too_large(f"more than {MAX_DEPTH} levels deep")
        if len(attributes) > MAX_ATTRIBUTES:
            self._too_large(f"too large: more than {MAX_ATTRIBUTES} attributes in one element")
        namespace, _, name = full_name.rpartition(_SEPARATOR)
        element = Element(name, namespace, attributes, self._here(len(name) + 1), source=self.raw)
        element.start = self.parser.CurrentByteIndex
        places, element.is_empty = self._places()
        if attributes:
            written = [one for one in places if one[0] != "xmlns" and not one[0].startswith("xmlns:")]
            # both in the document's order
            element.names = {name: one[1] for name, one in zip(attributes, written, strict=False)}
            element.places = {name: one[2] for name, one in zip(attributes, written, strict=False)}
        element.tags = (self._named(name, 1),)
        if self._open:
            self._open[-1].content.append(element)
        else:
            self.root = element
        self._open.append(element)

    def _too_large(self, limit: str) -> NoReturn:
        raise Diagnosed(codes.XML_TOO_LARGE.at(self._here(), limit=limit))

    def _end(self, _: str) -> None:
        here = self.parser.CurrentByteIndex  # for an empty element, the index after it
        element = self._open.pop()
        element.end = here if element.is_empty else self.raw.find(b">", here) + 1
        if not element.is_empty:
            element.tags += (self._named(element.name, 2),)

    def _characters(self, text: str) -> None:
        if self._open:
            self._open[-1].content.append(text)

    def _index(self) -> int:
        return self._lines[self.parser.CurrentLineNumber - 1] + self.parser.CurrentColumnNumber

    def _named(self, name: str, at: int) -> Span:
        """The location of a name in the current tag, perhaps behind a prefix, from the character `at`."""
        start = self._index() + at
        written = _NAME.match(self.text, start)
        end = written.end() if written else start + len(name)
        return self._span(end - len(name), end)

    def _places(self) -> tuple[list[tuple[str, Span, Span]], bool]:
        """The current tag's attributes, with the locations of names and values, and whether the tag ends the element,
        too: expat does not say."""
        found: list[tuple[str, Span, Span]] = []
        match = _TAG.match(self.text, self._index())
        end = match.end() if match else self._index()
        while match and (match := _ATTRIBUTE.match(self.text, end)):
            found.append((match[1], self._span(*match.span(1)), self._span(match.start(2) + 1, match.end(2) - 1)))
            end = match.end()
        return found, _EMPTY.match(self.text, end) is not None

    def _span(self, start: int, end: int) -> Span:
        first, last = bisect.bisect_right(self._lines, start), bisect.bisect_right(self._lines, end)
        return Span(self.path, first, start - self._lines[first - 1] + 1, last, end - self._lines[last - 1] + 1)
