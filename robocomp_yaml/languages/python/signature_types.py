"""Types in annotations of Python, as a type checker sees them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable

from robocomp_yaml.emit.specific.types import ANY_OF, LIST, MAP, NOTHING, TUPLE, KnownTypes, TypeForm, differ
from robocomp_yaml.languages.python.names import python_name
from robocomp_yaml.link.program import LinkedComponent

_OWN = re.compile(
    r"^\s*(\w+)\s*(?::[^=\n]+)?=(?!=)|\bas\s+(\w+)|^\s*class\s+(\w+)|\bimport\s+(?:[\w, ]*\b)?(\w+)", re.MULTILINE
)
_BASIC = {"bool": "bool", "int": "int", "float": "float", "str": "string", "bytes": "bytes"}
_OF_SLICE = {"byte": "int", "short": "int", "int": "int", "long": "int", "float": "float", "double": "float",
             "bool": "bool", "string": "string"}  # fmt: skip
_WIDER = {"bool": ("int", "float"), "int": ("float",)}
_ITERABLE = frozenset(("Iterable", "Sequence", "Collection", "MutableSequence", "Iterator"))
_HEADS = {"list": LIST, "List": LIST, "dict": MAP, "Dict": MAP, "Mapping": MAP, "MutableMapping": MAP, "tuple": TUPLE,
          "Tuple": TUPLE}  # fmt: skip
_TYPING = frozenset(("typing", "t", "collections.abc", "abc", "builtins", ""))


class SignatureTypes:
    """Compares annotations in the signatures of a component's code, `texts`. Without an annotation, nothing differs."""

    def __init__(self, linked: LinkedComponent, texts: Iterable[str], *, converts: bool) -> None:
        users = {name for text in texts for match in _OWN.finditer(text) for name in match.groups() if name}
        of_slice = {name: TypeForm(head) for name, head in _OF_SLICE.items()}
        self._known = KnownTypes(
            linked, python_name, users - {scope.module.name for scope in linked.modules()}, of_slice
        )
        self._users = users

    def differ(self, yours: str, expected: str, is_result: bool) -> bool:
        if not is_result:
            yours, expected = (text.partition(" : ")[2].partition(" = ")[0] for text in (yours, expected))
        mine, needed = self.form(yours), self.form(expected)
        if mine is None or needed is None or needed.head == NOTHING:
            return False
        return differ(*self._widened(mine, needed, is_result))

    def _widened(self, mine: TypeForm, needed: TypeForm, is_result: bool) -> tuple[TypeForm, TypeForm]:
        """The types, alike if one may be passed for the other."""
        narrow, wide = (mine, needed) if is_result else (needed, mine)
        if mine.head == ANY_OF:
            forms = [self._widened(one, needed, is_result)[0] if one else None for one in mine.arguments]
            return TypeForm(ANY_OF, tuple(forms)), needed
        if wide.head in _WIDER.get(narrow.head, ()) or {mine.head, needed.head} == {"bytes", LIST}:
            return needed, needed
        return mine, needed

    def form(self, text: str) -> TypeForm | None:
        """The form of an annotation; None if it may be any."""
        try:
            return self._read(ast.parse(text.strip(), mode="eval").body)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return None

    def _read(self, node: ast.expr) -> TypeForm | None:
        match node:
            case ast.Constant(value=None):
                return TypeForm(NOTHING)
            case ast.Constant(value=str(text)):
                return self.form(text)
            case ast.BinOp(left=left, op=ast.BitOr(), right=right):
                return self._any_of((left, right))
            case ast.Name() | ast.Attribute():
                return self._named(node)
            case ast.Subscript(value=ast.Name() | ast.Attribute() as value, slice=inner):
                return self._generic(ast.unparse(value), inner.elts if isinstance(inner, ast.Tuple) else [inner])
        return None

    def _named(self, node: ast.Name | ast.Attribute) -> TypeForm | None:
        *outer, name = ast.unparse(node).split(".")
        if ".".join(outer) in _TYPING and (not outer or outer[0] not in self._known.modules):
            if name in _BASIC and name not in self._users:
                return TypeForm(_BASIC[name])
            if name in _HEADS:
                return TypeForm(_HEADS[name])
        return self._known.named(name, outer)

    def _generic(self, name: str, arguments: list[ast.expr]) -> TypeForm | None:
        home, _, last = name.rpartition(".")
        if home not in _TYPING:
            return None
        if last == "Optional":
            return self._any_of((*arguments, ast.Constant(None)))
        if last == "Union":
            return self._any_of(arguments)
        if last in _HEADS:
            is_open = any(isinstance(one, ast.Constant) and one.value is Ellipsis for one in arguments)
            return TypeForm(_HEADS[last], () if is_open else tuple(map(self._read, arguments)))
        if last in _ITERABLE:
            element = tuple(map(self._read, arguments))
            return TypeForm(ANY_OF, (TypeForm(LIST, element), TypeForm("bytes"), TypeForm("string"), TypeForm(MAP)))
        return None

    def _any_of(self, nodes: Iterable[ast.expr]) -> TypeForm:
        return TypeForm(ANY_OF, tuple(map(self._read, nodes)))
