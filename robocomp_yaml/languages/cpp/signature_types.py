"""Types in signatures of C++, as the compiler sees them: without const, references and the names of namespaces."""

from __future__ import annotations

import re
from collections.abc import Iterable

from robocomp_yaml.emit.specific.types import LIST, MAP, NOTHING, NUMBERS, KnownTypes, TypeForm, differ
from robocomp_yaml.languages.cpp.names import ice_name
from robocomp_yaml.link.program import LinkedComponent

_OWN = re.compile(
    r"\busing\s+(\w+)\s*=|\btypedef\b[^;{}]*?\b(\w+)\s*(?:\[[^;]*\])?;|#\s*define\s+(\w+)"
    r"|\b(?:class|struct|enum|enum\s+class|typename|concept)\s+(\w+)"
)
_TOKEN = re.compile(r"\w+|::|[<>,]|\S")
_IGNORED = frozenset("const volatile & struct class enum typename mutable constexpr inline virtual static".split())
_WORDS = frozenset("unsigned signed long short int char float double bool void".split())
_BASIC = {
    "bool": "bool", "float": "float", "double": "double", "void": NOTHING,
    **dict.fromkeys(("unsigned char", "uint8_t", "Byte"), "byte"),
    **dict.fromkeys(("short", "short int", "int short", "int16_t", "Short"), "short"),
    **dict.fromkeys(("int", "int32_t", "Int", "signed", "signed int"), "int"),
    **dict.fromkeys(("long", "long int", "long long", "long long int", "int64_t", "Long"), "long"),
    "Float": "float", "Double": "double", "Bool": "bool", "string": "string",
}  # fmt: skip
_OF_ICE = {"StringSeq": "string", "IntSeq": "int", "FloatSeq": "float", "DoubleSeq": "double", "BoolSeq": "bool",
           "ByteSeq": "byte", "ShortSeq": "short", "LongSeq": "long"}  # fmt: skip
_HOMES = frozenset(("std", "Ice", ""))
_BASIC_FORMS = {name: TypeForm(name) for name in (*NUMBERS, "string")}


class SignatureTypes:
    """Compares types in the signatures of a component's code, `texts`. `converts`: arguments are converted as C++ does,
    because the worker is called by templates."""

    def __init__(self, linked: LinkedComponent, texts: Iterable[str], *, converts: bool) -> None:
        users = {name for text in texts for match in _OWN.finditer(text) for name in match.groups() if name}
        self._known = KnownTypes(linked, ice_name, users, _BASIC_FORMS)
        self._users, self._converts = users, converts

    def differ(self, yours: str, expected: str, is_result: bool) -> bool:
        mine, needed = self.form(yours), self.form(expected)
        if self._converts and mine is not None and needed is not None:
            if {mine.head, needed.head} <= {*NUMBERS} or NOTHING in (mine.head, needed.head):
                return False
        return differ(mine, needed)

    def form(self, text: str) -> TypeForm | None:
        """The form of a type; None if it may be any."""
        tokens = [word for word in _TOKEN.findall(text) if word not in _IGNORED]
        form, rest = self._read(tokens)
        return form if not rest else None

    def _read(self, tokens: list[str]) -> tuple[TypeForm | None, list[str]]:
        words: list[str] = []
        while tokens and tokens[0] in _WORDS:
            words, tokens = [*words, tokens[0]], tokens[1:]
        if words:
            return self._basic(" ".join(words), ""), tokens
        path, before = list[str](), "::"
        while tokens and (tokens[0] == "::" or re.fullmatch(r"\w+", tokens[0])):
            if tokens[0] != "::":
                if before != "::":
                    break
                path.append(tokens[0])
            before, tokens = tokens[0], tokens[1:]
        if not path:
            return None, tokens
        *outer, name = path
        if tokens and tokens[0] == "<":
            arguments, tokens = self._arguments(tokens[1:])
            return self._template(name, outer, arguments), tokens
        home = outer[-1] if outer else ""
        if home in _HOMES and (basic := self._basic(name, home)) is not None:
            return basic, tokens
        if home in ("Ice", "") and name in _OF_ICE and name not in self._users:
            return TypeForm(LIST, (TypeForm(_OF_ICE[name]),)), tokens
        return self._known.named(name, outer), tokens

    def _arguments(self, tokens: list[str]) -> tuple[list[TypeForm | None], list[str]]:
        """The arguments of a template, and what follows them."""
        found: list[TypeForm | None] = []
        while tokens:
            form, tokens = self._read(tokens)
            depth, is_clean = 0, True
            while tokens and (depth or tokens[0] not in (",", ">")):
                depth += {"<": 1, ">": -1}.get(tokens[0], 0)
                is_clean, tokens = False, tokens[1:]
            found.append(form if is_clean else None)
            if not tokens or tokens[0] == ">":
                break
            tokens = tokens[1:]
        return found, tokens[1:]

    def _template(self, name: str, outer: list[str], arguments: list[TypeForm | None]) -> TypeForm | None:
        if outer not in ([], ["std"]) or name in self._users:
            return None
        if name == "vector":
            return TypeForm(LIST, (*arguments[:1],))
        return TypeForm(MAP, (*arguments[:2],)) if name == "map" else None

    def _basic(self, name: str, home: str) -> TypeForm | None:
        head = _BASIC.get(name)
        return TypeForm(head) if head is not None and (home or name not in self._users) else None
