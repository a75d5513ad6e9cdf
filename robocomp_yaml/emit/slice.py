"""The Slice target: the `.ice` file of a module, in the style of a person.

Indentation is two blanks, and definitions are separated by an empty line. A definition comes after those that it uses,
else in the author's order. The text depends only on the module and its imports.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

from robocomp_yaml.digraph import postorder
from robocomp_yaml.emit.slice_comment import WIDTH, comment, described
from robocomp_yaml.link.numbers import arrives, compiles, is_integer_literal
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.link.references import macro, types_of
from robocomp_yaml.model import interface as model
from robocomp_yaml.model.interface import Definition

IN = "  "

_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')


def file_name(linked: LinkedModule) -> str:
    """The name of the file of a module."""
    return f"{linked.module.stem}.ice"


def guard(linked: LinkedModule) -> str:
    """The include guard of the file. No identifier of Slice ends with an underscore."""
    return f"ROBOCOMP{macro(linked.module.stem)}_ICE_"


def text(linked: LinkedModule) -> str:
    """The text of the file of a module without errors."""
    return "\n".join(_File(linked).lines()) + "\n"


def in_order(linked: LinkedModule) -> list[Definition]:
    """The definitions of a module, each after those that it uses, else in the author's order. Interfaces, which no
    definition uses, are last."""
    module = linked.module
    own: dict[str, Definition] = {d.name: d for d in (*module.constants, *module.types, *module.exceptions)}

    def used(name: str) -> list[str]:
        definitions = (linked.find(ref) for ref in types_of(own[name]) if not ref.is_basic)
        return [other[1].name for other in definitions if other and other[0] is linked and other[1].name in own]

    return [*(own[name] for name in postorder(own, used)), *module.all_interfaces]


class _File:
    def __init__(self, linked: LinkedModule) -> None:
        self.linked = linked
        self.module = linked.module
        self._names: dict[str, tuple[str, str]] = {}
        self.own_names = {definition.name.lower() for definition in linked.module.definitions}

    def lines(self) -> Iterator[str]:
        body = list(self._module())
        yield f"// Compiled by rcyaml from {self.module.path.rpartition('/')[2]}: change that file, not this one."
        yield from (f"#ifndef {guard(self.linked)}", f"#define {guard(self.linked)}", "")
        if any("_" in line and _has_underscores(line) for line in body):
            yield from ('[["underscore"]]', "")
        if self.linked.imports:
            yield from (f"#include <{file_name(imported)}>" for imported in self.linked.imports)
            yield ""
        yield from body
        yield from ("", "#endif")

    def _module(self) -> Iterator[str]:
        yield from comment(self.module.doc)
        yield from (f"module {self.module.name}", "{")
        for number, definition in enumerate(in_order(self.linked)):
            if number:
                yield ""
            yield from self._definition(definition)
        yield "};"

    def _definition(self, definition: Definition) -> Iterator[str]:
        unit = definition.unit if isinstance(definition, model.Constant) else ""
        yield from comment(definition.doc, IN, unit=unit)
        match definition:
            case model.Constant():
                value = self._value(definition.type, definition.value)
                yield f"{IN}const {self._type(definition.type)} {definition.name} = {value};"
            case model.Struct():
                yield from _braced(f"struct {definition.name}", self._members(definition))
            case model.ExceptionType():
                yield from _braced(f"exception {definition.name}", self._members(definition))
            case model.Enum():
                yield from _enum(definition)
            case model.Sequence():
                yield f"{IN}sequence<{self._type(definition.element)}> {definition.name};"
            case model.Map():
                key, value = self._type(definition.key), self._type(definition.value)
                yield f"{IN}dictionary<{key}, {value}> {definition.name};"
            case model.Interface():
                yield from _braced(f"interface {definition.name}", self._methods(definition))

    def _members(self, definition: model.Struct | model.ExceptionType) -> Iterator[str]:
        for member in definition.members:
            yield from comment(member.doc, IN * 2, unit=member.unit)
            default = f" = {self._value(member.type, member.default)}" if member.default is not None else ""
            yield f"{IN * 2}{self._type(member.type)} {member.name}{default};"

    def _methods(self, interface: model.Interface) -> Iterator[str]:
        hidden = {method.name.lower() for method in interface.methods}
        documented = False
        for number, method in enumerate(interface.methods):
            doc = comment(method.doc, IN * 2, tags=self._tags(method))
            if number and (doc or documented):
                yield ""
            yield from doc
            yield from self._method(method, hidden)
            documented = bool(doc)

    def _tags(self, method: model.Method) -> list[tuple[str, str]]:
        """The tags for parameters and result, and for exceptions if the method has any documentation."""
        tags = [(f"@param {p.name}", described(p.doc, p.unit)) for p in (*method.inputs, *method.outputs)]
        tags.append(("@return", described(method.returns_doc, method.returns_unit)))
        if (method.doc or any(doc for _, doc in tags)) and "@throws" not in method.doc:
            for ref in method.throws:
                definition = self.linked.find(ref)
                tags.append((f"@throws {self._type(ref)}", described(definition[1].doc, "") if definition else ""))
        return tags

    def _method(self, method: model.Method, hidden: set[str]) -> Iterator[str]:
        returns = self._type(method.returns, hidden) if method.returns else "void"
        head = f"{IN * 2}{'idempotent ' if method.idempotent else ''}{returns} {method.name}("
        parameters = [self._parameter(parameter, "", hidden) for parameter in method.inputs]
        parameters += [self._parameter(parameter, "out ", hidden) for parameter in method.outputs]
        throws = [self._type(ref, hidden) for ref in method.throws]
        line = f"{head}{', '.join(parameters)}){' throws ' if throws else ''}{', '.join(throws)};"
        if len(line) <= WIDTH:
            yield line
            return
        end = ")" if throws else ");"
        yield head + ("" if parameters else end)
        yield from _listed(parameters, IN * 4, end)
        if throws:
            yield f"{IN * 3}throws"
            yield from _listed(throws, IN * 4, ";")

    def _parameter(self, parameter: model.Member, direction: str, hidden: set[str]) -> str:
        return f"{direction}{self._type(parameter.type, hidden)} {parameter.name}"

    def _type(self, ref: model.TypeRef, hidden: Collection[str] = ()) -> str:
        """The name of a type, absolute if its first word has another meaning: `hidden` are the names, in lower case,
        that have another meaning at this position."""
        if ref.text not in self._names:
            self._names[ref.text] = self._name(ref)
        name, first_word = self._names[ref.text]
        if first_word not in hidden:
            return name
        return f"::{name}" if "::" in name else f"::{self.module.name}::{name}"

    def _name(self, ref: model.TypeRef) -> tuple[str, str]:
        """The name of a type, and its first word in lower case ('' if that cannot have another meaning)."""
        if ref.is_basic:
            return ref.text, ""
        resolved = self.linked.find(ref)
        if resolved is None:
            return ref.text.replace(".", "::"), ""
        scope, definition = resolved
        if scope is self.linked:
            return definition.name, definition.name.lower()
        name, first_word = f"{scope.module.name}::{definition.name}", scope.module.name.lower()
        return (f"::{name}", "") if first_word in self.own_names else (name, first_word)

    def _value(self, type_: model.TypeRef, value: model.Literal) -> str:
        """A value in Slice. An enumerator is qualified with its enum, because other definitions may have the same
        name."""
        return literal(value, type_.text) if type_.is_basic else f"{self._type(type_)}::{value.lexeme}"


def _listed(items: list[str], indent: str, end: str) -> Iterator[str]:
    for number, item in enumerate(items, 1):
        yield f"{indent}{item}{',' if number < len(items) else end}"


def _braced(head: str, body: Iterable[str]) -> Iterator[str]:
    lines = list(body)
    yield from (f"{IN}{head}", f"{IN}{{", *lines, f"{IN}}};") if lines else (f"{IN}{head} {{}};",)


def _enum(enum: model.Enum) -> Iterator[str]:
    names = [e.name if e.value is None else f"{e.name} = {e.value}" for e in enum.enumerators]
    line = f"{IN}enum {enum.name} {{ {', '.join(names)} }};"
    if len(line) <= WIDTH and not any(e.doc for e in enum.enumerators):
        yield line
        return
    lines: list[str] = []
    for number, name in enumerate(names, 1):
        lines += comment(enum.enumerators[number - 1].doc, IN * 2)
        lines.append(f"{IN * 2}{name}{',' if number < len(names) else ''}")
    yield from _braced(f"enum {enum.name}", lines)


def _has_underscores(line: str) -> bool:
    """Whether a line has names with underscores, which Slice accepts only with a directive."""
    return not line.lstrip().startswith(("/*", "*")) and "_" in _STRING.sub("", line)


_INTEGER = r"[-+]?(?:0|[1-9][0-9]*)\Z"
_REAL = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\Z"
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def literal(value: model.Literal, type_name: str) -> str:
    """The literal of a basic type."""
    match type_name:
        case "string":
            return quoted(str(value.value))
        case "bool":
            return "true" if value.value else "false"
        case "float" | "double":
            return _real(value, type_name)
        case _:
            return value.lexeme if re.match(_INTEGER, value.lexeme) else str(value.value)


def quoted(text: str) -> str:
    """A string literal, in which `??` is split, because the preprocessor replaces trigraphs."""
    escaped = "".join(_ESCAPES.get(c) or (f"\\{ord(c):03o}" if ord(c) < 0x20 or ord(c) == 0x7F else c) for c in text)
    return '"' + escaped.replace("??", "?\\?") + '"'


def _real(value: model.Literal, type_name: str) -> str:
    number = float(value.value)
    if re.match(_INTEGER, value.lexeme):
        return value.lexeme if is_integer_literal(number) else f"{value.lexeme}.0"
    if is_integer_literal(number) and not (compiles(number, type_name) and arrives(number, type_name)):
        return str(int(number))
    return value.lexeme if re.match(_REAL, value.lexeme) else repr(number)
