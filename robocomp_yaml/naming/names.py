"""The names of a program: where each is defined, and where it is used. Definition, references, hover, symbols,
completion and renaming read them.

Every location is that of the name alone: in `arm.elbow.Motor`, there are three.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import Program
from robocomp_yaml.source.tree import Node

MODULE, INTERFACE, TOPIC, METHOD, EVENT = "module", "interface", "topic", "method", "event"
ARGUMENT = "argument"
TYPE, CONSTANT, EXCEPTION, MEMBER, ENUMERATOR = "type", "constant", "exception", "member", "enumerator"
COMPONENT, PORT, STATE = "component", "port", "state"
PARAMETER, PARAMETER_TYPE, PARAMETER_MEMBER = "parameter", "type of parameters", "member of a record"
DEPLOYMENT, HOST, SERVICE, ENTRY, GROUP = "deployment", "host", "service", "entry", "group"

Key = tuple[str, ...]
"""What a name means: its kind, its document and the names around it."""


class DefinedName(msgspec.Struct, frozen=True):
    """`says` describes it in the words of the document; `inside` is the name that contains it."""

    key: Key
    name: str
    span: Span
    says: str = ""
    doc: str = ""
    inside: Key = ()

    @property
    def kind(self) -> str:
        return self.key[0]


class Names:
    """All names of a program. Keys have the path of the document that defines the name, as its span has it. `trees` are
    those of documents and of mock scripts, by path: what the model does not keep is read from them.

    `paths` are the uses that are paths, and not the name itself: `component: arm`. `identities` are those of objects in
    proxies, which are in lower case: `speech:tcp -p 10000`."""

    def __init__(self, program: Program, trees: Mapping[str, Node | None] | None = None) -> None:
        self.defined: dict[Key, DefinedName] = {}
        self.uses: dict[Key, list[Span]] = {}
        self.paths: set[Span] = set()
        self.identities: set[Span] = set()
        self._by_file: dict[str, list[tuple[Span, Key]]] = {}
        self._collect(program, trees or {})

    def _collect(self, program: Program, trees: Mapping[str, Node | None]) -> None:
        from robocomp_yaml.naming import of_components, of_deployments, of_interfaces, of_parameters

        of_interfaces.collect(self, program, trees)
        of_components.collect(self, program, trees)
        of_parameters.collect(self, program)
        of_deployments.collect(self, program)

    def at(self, file: str, line: int, column: int) -> tuple[Span, DefinedName] | None:
        """The name at a place, or right before it, with its definition."""
        found = [
            (span, key) for span, key in self._by_file.get(file, ())
            if span.line == line == span.end_line and span.column <= column <= span.end_column and key in self.defined
        ]  # fmt: skip
        if not found:
            return None
        span, key = min(found, key=lambda one: column == one[0].end_column)  # in a name before behind one
        return span, self.defined[key]

    def in_document(self, file: str) -> list[DefinedName]:
        """The names that a document defines, in its order."""
        found = (one for one in self.defined.values() if one.span.file == file)
        return sorted(found, key=lambda one: one.span)

    def of_kinds(self, *kinds: str) -> Iterator[DefinedName]:
        return (one for one in self.defined.values() if one.kind in kinds)

    def define(self, one: DefinedName) -> None:
        if one.key not in self.defined:
            one = msgspec.structs.replace(one, span=one.span.inside(one.name, 0, len(one.name)))
            self.defined[one.key] = one
            self._by_file.setdefault(one.span.file, []).append((one.span, one.key))

    def use(self, key: Key | None, span: Span, *, is_path: bool = False, is_identity: bool = False) -> None:
        if key is None or not span.file:
            return
        if is_path:
            self.paths.add(span)
        if is_identity:
            self.identities.add(span)
        spans = self.uses.setdefault(key, [])
        if span not in spans[-64:]:  # all instances of an entry have the same texts
            spans.append(span)
            self._by_file.setdefault(span.file, []).append((span, key))
