"""What stands at a place in a document."""

from __future__ import annotations

import msgspec

from robocomp_yaml.diag.span import Span

_PLACES = frozenset({"span", "node", "at"})


class Located(msgspec.Struct, frozen=True, eq=False):
    """Equal to another one of the same content, wherever the two stand: `span`, other names that end in `_span`, `node`
    and `at` do not count."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in self._content())

    def __ne__(self, other: object) -> bool:  # a struct has its own, which knows nothing of the other
        return not self == other

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in self._content()))

    def _content(self) -> list[str]:
        return [name for name in self.__struct_fields__ if name not in _PLACES and not name.endswith("_span")]


class Spanned(Located, frozen=True, kw_only=True):
    """A part of a document, with its span."""

    span: Span = Span("")


class Text(Spanned, frozen=True):
    """A text of a document: a name, a path, an argument or an expression."""

    text: str

    def __str__(self) -> str:
        return self.text
