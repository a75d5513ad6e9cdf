"""Parts of a document: each has a location, which does not count when two are compared."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span

_LOCATIONS = frozenset({"span", "node", "at"})


class Located(msgspec.Struct, frozen=True, eq=False):
    """Equal to any value with the same content. Locations are ignored: `span`, `node`, `at`, and names that end in
    `_span`."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in self._content())

    def __ne__(self, other: object) -> bool:  # msgspec has a `__ne__` that does not call this `__eq__`
        return not self == other

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in self._content()))

    def _content(self) -> list[str]:
        return [name for name in self.__struct_fields__ if name not in _LOCATIONS and not name.endswith("_span")]


class Spanned(Located, frozen=True, kw_only=True):
    """A part of a document with one main span."""

    span: Span = Span("")


class Text(Spanned, frozen=True):
    """A text of a document: a name, a path, an argument or an expression."""

    text: str

    def __hash__(self) -> int:  # the same for equal texts, and much faster
        return hash(self.text)

    def __str__(self) -> str:
        return self.text
