"""Types in signatures of Java, as the compiler sees them: without the names of packages."""

from __future__ import annotations

import re
from collections.abc import Iterable

from robocomp_yaml.emit.specific.types import LIST, MAP, NOTHING, NUMBERS, KnownTypes, TypeForm, differ
from robocomp_yaml.languages.java.names import ice_name
from robocomp_yaml.link.program import LinkedComponent

_OWN = re.compile(
    r"\b(?:class|interface|enum|record)\s+(\w+)|\bimport\s+(?!slice\.)[\w.]*\b(\w+)\s*;|<\s*(\w+)\s+extends\b"
)
_TOKEN = re.compile(r"\w+|\S")
_BASIC = {
    "boolean": "bool", "byte": "byte", "short": "short", "int": "int", "long": "long", "float": "float",
    "double": "double", "String": "string", "void": NOTHING,
}  # fmt: skip
_BOXED = {"Boolean": "bool", "Byte": "byte", "Short": "short", "Integer": "int", "Long": "long", "Float": "float",
          "Double": "double"}  # fmt: skip
_FORMS = {name: TypeForm(name) for name in (*NUMBERS, "string")}


class SignatureTypes:
    """Compares types in the signatures of a component's code, `texts`."""

    def __init__(self, linked: LinkedComponent, texts: Iterable[str], *, converts: bool) -> None:
        users = {name for text in texts for match in _OWN.finditer(text) for name in match.groups() if name}
        self._known, self._users = KnownTypes(linked, ice_name, users, _FORMS), users

    def differ(self, yours: str, expected: str, is_result: bool) -> bool:
        return differ(self.form(yours), self.form(expected))

    def form(self, text: str) -> TypeForm | None:
        """The form of a type; None if it may be any."""
        form, rest = self._read([word for word in _TOKEN.findall(text) if word != "final"])
        return form if not rest else None

    def _read(self, tokens: list[str], *, inside: bool = False) -> tuple[TypeForm | None, list[str]]:
        path: list[str] = []
        while tokens and re.fullmatch(r"\w+", tokens[0]):
            path, tokens = [*path, tokens[0]], tokens[1:]
            if not tokens or tokens[0] != ".":
                break
            tokens = tokens[1:]
        if not path:
            return None, tokens
        arguments: list[TypeForm | None] = []
        if tokens and tokens[0] == "<":
            while tokens and tokens[0] != ">":
                form, tokens = self._read(tokens[1:], inside=True)
                while tokens and tokens[0] not in (",", ">"):
                    form, tokens = None, tokens[1:]
                arguments.append(form)
            tokens = tokens[1:]
        form = self._named(path, arguments, inside=inside)
        while tokens[:2] == ["[", "]"]:
            form, tokens = TypeForm(LIST, (form,)), tokens[2:]
        return form, tokens

    def _named(self, path: list[str], arguments: list[TypeForm | None], *, inside: bool) -> TypeForm | None:
        *outer, name = path
        if name == "Map" and outer in ([], ["java", "util"]):
            return TypeForm(MAP, tuple(arguments[:2])) if name not in self._users - {"Map"} else None
        basic = _BASIC.get(name) or (_BOXED.get(name) if inside else None)
        if basic and name not in self._users and outer in ([], ["java", "lang"]):
            return TypeForm(basic)
        return self._known.named(name, outer) if not arguments else None
