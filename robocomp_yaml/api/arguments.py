"""Arguments of methods as a command line has them: `width=2.5`, `pose.x=1`, `{width: 2.5}`, or YAML from standard
input."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import calls as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Member, Method, Struct
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import tree
from robocomp_yaml.source.tree import Node, Scalar

ALL, STDIN = "arguments", "standard input"
"""What locations name instead of a file; a single argument is `argument 1`."""

_ASSIGNED = pattern(r"(\w+(?:\.\w+)*)=(.*)\Z", 0x10)  # DOTALL
_MAPPING = pattern(r"\s*(\{|\w+:(\s|\Z))")


class Arguments(msgspec.Struct, frozen=True):
    """The arguments of a call as nodes, and the `texts` that their locations refer to."""

    root: tree.Mapping
    texts: Mapping[str, str]


class _Parts(msgspec.Struct):
    """What has been assigned so far, at one level: nodes, or the parts of a struct."""

    entries: dict[str, tuple[Scalar, Node | _Parts]] = {}


class _Reader(msgspec.Struct):
    scope: LinkedModule
    members: Sequence[Member]
    texts: dict[str, str]
    parts: _Parts = msgspec.field(default_factory=_Parts)
    faults: list[Diagnostic] = []

    def assign(self, file: str, name: str, value: str) -> None:
        """`name=value`, where the name may lead into structs."""
        column = 1
        steps = []
        for word in name.split("."):
            steps.append(tree.text_at(Span(file, 1, column, 1, column + len(word)), word))
            column += len(word) + 1
        node = self._value(file, name, value, column)
        if node is not None:
            self._put(steps, node)

    def _value(self, file: str, name: str, value: str, column: int) -> Node | None:
        """Text needs no quotes; any other value is YAML."""
        type_ = self._type(name.split("."))
        if type_ == "string":
            return tree.text_at(_span_of(file, value, column), value)
        if not value.strip():
            return tree.scalar_at(_span_of(file, value, column), "")
        lead = "" if "\n" in value else " " * (column - 1)
        node, faults = tree.parse(file, lead + value)
        self.faults += faults
        return node

    def _type(self, steps: Sequence[str]) -> str:
        """The name of the type at a path of members; '' if there is none."""
        scope, members, text = self.scope, self.members, ""
        for step in steps:
            member = next((one for one in members if one.name == step), None)
            if member is None:
                return ""
            found = None if member.type.is_basic else scope.find(member.type)
            text, members = member.type.text, ()
            if found is not None and isinstance(found[1], Struct):
                scope, members = found[0], found[1].members
        return text

    def whole(self, file: str, text: str) -> None:
        """A mapping of arguments."""
        root, faults = tree.parse(file, text)
        self.faults += faults
        if isinstance(root, tree.Mapping):
            for key, value in root.items():
                self._put([key], value)
        elif root is not None:
            problem, hint = "must be a mapping of arguments by their names", self._example()
            self.faults.append(codes.WRONG_VALUE.at(root.span, path="as a whole", problem=problem, hint=hint))

    def _put(self, steps: Sequence[Scalar], node: Node) -> None:
        parts = self.parts
        for step in steps[:-1]:
            _, inner = parts.entries.setdefault(step.lexeme, (step, _Parts()))
            if not isinstance(inner, _Parts):
                self._twice(step)
                return
            parts = inner
        last = steps[-1]
        if last.lexeme in parts.entries:
            self._twice(last)
        else:
            parts.entries[last.lexeme] = (last, node)

    def _twice(self, key: Scalar) -> None:
        path = f"'{key.lexeme}'"
        self.faults.append(codes.WRONG_VALUE.at(key.span, path=path, problem="is set twice", hint="keep one of them"))

    def _example(self) -> str:
        return f"write `{{{', '.join(f'{one.name}: …' for one in self.members)}}}`"


def read(scope: LinkedModule, method: Method, words: Sequence[str], stdin: str | None = None) -> Arguments:
    """The arguments in the words of a command line, of which `-` means the text `stdin`. Raises Refused if a word is
    neither an assignment nor a mapping, and Faulty if YAML cannot be parsed."""
    texts = {ALL: " ".join(words) or method.name}
    reader = _Reader(scope, method.inputs, texts)
    for number, word in enumerate(words, 1):
        file = STDIN if word == "-" else f"argument {number}"
        texts[file] = text = (stdin or "") if word == "-" else word
        if not _is_utf8(text):
            raise Refused(f"{file} is not UTF-8")
        assigned = _ASSIGNED.match(word)
        if word == "-" or _MAPPING.match(word):
            if text.strip():
                reader.whole(file, text)
        elif assigned:
            reader.assign(file, assigned[1], assigned[2])
        else:
            raise Refused(f"'{word}' is neither NAME=VALUE nor a mapping of arguments; {_usage(method, word)}")
    if reader.faults:
        raise Faulty(reader.faults, None, texts)
    return Arguments(_mapping(Span(ALL, 1, 1, 1, max(2, len(texts[ALL]) + 1)), reader.parts), texts)


def _mapping(span: Span, parts: _Parts) -> tree.Mapping:
    entries: dict[str, tuple[Scalar, Node]] = {}
    for name, (key, inner) in parts.entries.items():
        entries[name] = (key, _mapping(key.span, inner) if isinstance(inner, _Parts) else inner)
    return tree.mapping_at(span, entries)


def _is_utf8(text: str) -> bool:
    """Whether a text has only characters: Python keeps bytes that are not UTF-8 as surrogates."""
    return text.isascii() or not any("\ud800" <= char <= "\udfff" for char in text)


def _usage(method: Method, word: str) -> str:
    if not method.inputs:
        return f"{method.name} has no arguments"
    if len(method.inputs) == 1:
        only = method.inputs[0]
        return f"write {only.name}={typed(word) if only.type.is_basic else '…'}"
    return f"{method.name} has {_listed(one.name for one in method.inputs)}"


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"{name}=…" for name in names)


def _span_of(file: str, value: str, column: int) -> Span:
    lines = value.split("\n")
    end = column + len(value) if len(lines) == 1 else len(lines[-1]) + 1
    return Span(file, 1, column, len(lines), max(end, column + 1 if len(lines) == 1 else 1))
