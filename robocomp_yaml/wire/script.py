"""Mock scripts (`NAME.mock.yaml`): what stand-ins answer and publish, compared with the interfaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import msgspec

from robocomp_yaml.diag.codes import calls as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.program import LinkedModule, interfaces_by_name
from robocomp_yaml.model.duration import seconds
from robocomp_yaml.source import tree
from robocomp_yaml.source.ice_texts import ENDPOINT, PROXY, of_text
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.wire.interfaces import RETURNS, Operation, WireInterface
from robocomp_yaml.wire.types import Types
from robocomp_yaml.wire.values import Fault

RATE = 1.0
"""Messages per second where the script says nothing."""


class Answer(msgspec.Struct, frozen=True):
    """What one call returns, as Ice has it, or raises; `delay` is in seconds."""

    result: Any = None
    raises: Exception | None = None
    delay: float = 0.0


class Served(msgspec.Struct, frozen=True):
    """An interface to serve. `endpoint` is '' where the script says nothing; `answers` are those of each method, in
    turn."""

    interface: WireInterface
    endpoint: str
    answers: Mapping[str, tuple[Answer, ...]]


class Published(msgspec.Struct, frozen=True):
    """A topic to publish: messages in turn, each an operation with its arguments, and how many in a second."""

    interface: WireInterface
    rate: float
    messages: tuple[tuple[Operation, tuple[Any, ...]], ...]


class Script(msgspec.Struct):
    """What a script says. `storm` is the proxy of IceStorm's topic manager, or ''."""

    served: list[Served] = []
    published: list[Published] = []
    storm: str = ""
    diagnostics: list[Diagnostic] = []


class Reader:
    """Reads scripts for the interfaces of some modules. `errors` are those of their documents: an interface that
    depends on one of them is not used."""

    def __init__(self, modules: Iterable[LinkedModule], errors: Iterable[Diagnostic]) -> None:
        self._types, self._errors = Types(), tuple(errors)
        self._known = interfaces_by_name(modules)

    def of_names(self, names: Iterable[Scalar]) -> Script:
        """Stand-ins with example values for interfaces and topics that are named."""
        script = Script()
        for name in names:
            found = self._interface(name, script)
            if found is not None and found.interface.is_topic:
                script.published.append(_examples(found))
            elif found is not None:
                script.served.append(Served(found, "", {}))
        return script

    def of_document(self, root: tree.Mapping) -> Script:
        """The script of a document, which has the shape of its schema."""
        script = Script(storm=_text(root.get("storm")))
        script.diagnostics += _of_ice(PROXY, root.get("storm"))
        for key, node in _entries(root.get("interfaces")):
            found = self._interface(key, script, is_topic=False)
            script.diagnostics += _of_ice(ENDPOINT, node.get("endpoint") if isinstance(node, tree.Mapping) else None)
            if found is not None:
                methods = node.get("methods") if isinstance(node, tree.Mapping) else None
                answers = {
                    operation.name: tuple(self._answer(operation, one, script) for one in each)
                    for operation, each in self._methods(found, methods, script)
                }
                script.served.append(Served(found, _text(node.get("endpoint")), answers))
        for key, node in _entries(root.get("topics")):
            found = self._interface(key, script, is_topic=True)
            if found is not None:
                script.published.append(self._topic(found, node, script))
        return script

    def _interface(self, key: Scalar, script: Script, *, is_topic: bool | None = None) -> WireInterface | None:
        name = key.lexeme
        found = self._known.get(name, [])
        if not found:
            hint = did_you_mean(name, self._known)
            script.diagnostics.append(codes.UNKNOWN_INTERFACE.at(key.span, name=name, hint=hint))
        elif len(found) > 1:
            modules = [scope.module.name for scope, _ in found]
            script.diagnostics.append(
                codes.AMBIGUOUS_INTERFACE.at(
                    key.span, name=name, modules=", ".join(modules), hint=f"write '{modules[0]}.{name}'"
                )
            )
        elif is_topic is not None and found[0][1].is_topic != is_topic:
            kind, home = ("an interface", "interfaces") if is_topic else ("a topic", "topics")
            script.diagnostics.append(
                codes.NOT_ITS_KIND.at(key.span, name=name, kind=kind, hint=f"write it under `{home}:`")
            )
        else:
            files = {scope.module.path for scope in found[0][0].closure()}
            errors = [one for one in self._errors if one.span.file in files]
            if not errors:
                return WireInterface(*found[0], self._types)
            script.diagnostics += [one for one in errors if one not in script.diagnostics]
        return None

    def _methods(
        self, interface: WireInterface, node: Node | None, script: Script
    ) -> Iterator[tuple[Operation, list[Node]]]:
        for key, value in _entries(node):
            operation = self._operation(interface, key, script)
            if operation is not None:
                yield operation, value.items if isinstance(value, tree.Sequence) else [value]

    def _operation(self, interface: WireInterface, key: Scalar, script: Script) -> Operation | None:
        operation = interface.operations.get(key.lexeme)
        if operation is None:
            hint = did_you_mean(key.lexeme, interface.operations) or f"it has {', '.join(interface.operations)}"
            script.diagnostics.append(
                codes.UNKNOWN_METHOD.at(key.span, interface=interface.interface.name, name=key.lexeme, hint=hint)
            )
        return operation

    def _answer(self, operation: Operation, node: Node, script: Script) -> Answer:
        report = reporting(script.diagnostics)
        delay = seconds(node.get("delay")) or 0.0
        for _, thrown in _entries(node.get("throws")):
            return Answer(raises=self._exception(operation, node.get("throws"), thrown, script), delay=delay)
        values = operation.examples()
        for key, value in _entries(node):
            if key.lexeme == RETURNS:
                if RETURNS in operation.results:
                    values[RETURNS] = operation.results[RETURNS].to_ice(value, (RETURNS,), report)
                else:
                    report(Fault(key.span, RETURNS, f"is superfluous: {operation.name} returns nothing"))
        for key, value in _entries(node.get("out")):
            type_ = operation.results.get(key.lexeme) if key.lexeme != RETURNS else None
            if type_ is None:
                names = [name for name in operation.results if name != RETURNS]
                hint = did_you_mean(key.lexeme, names) or f"it has {', '.join(names) or 'no out parameter'}"
                report(Fault(key.span, key.lexeme, f"is not an out parameter of {operation.name}", hint))
            else:
                values[key.lexeme] = type_.to_ice(value, (key.lexeme,), report)
        return Answer(operation.as_result(values), delay=delay)

    def _exception(self, operation: Operation, node: Node | None, members: Node, script: Script) -> Exception | None:
        key = next(key for key, _ in _entries(node))
        thrown = operation.throws.get(key.lexeme)
        if thrown is None:
            hint = did_you_mean(key.lexeme, operation.throws) or (
                f"it throws {', '.join(operation.throws)}" if operation.throws else "it declares no exception"
            )
            script.diagnostics.append(
                codes.UNKNOWN_EXCEPTION.at(key.span, method=operation.name, name=key.lexeme, hint=hint)
            )
            return None
        return thrown.make(_mapping(members), (key.lexeme,), reporting(script.diagnostics))

    def _topic(self, interface: WireInterface, node: Node, script: Script) -> Published:
        rate, listed = node.get("rate"), node.get("messages")
        made = []
        for message in listed.items if isinstance(listed, tree.Sequence) else ():
            for key, arguments in _entries(message):
                operation = self._operation(interface, key, script)
                if operation is not None:
                    report = reporting(script.diagnostics)
                    made.append((operation, operation.arguments(_mapping(arguments), report)))
        examples = _examples(interface)
        return Published(interface, float(rate.data) if rate else RATE, tuple(made) or examples.messages)  # type: ignore[arg-type]


def reporting(diagnostics: list[Diagnostic]) -> Callable[[Fault], None]:
    """Adds faults of values to a list, as diagnostics."""

    def report(fault: Fault) -> None:
        found = codes.WRONG_VALUE.at(fault.span, path=f"'{fault.path}'", problem=fault.problem, hint=fault.hint)
        diagnostics.append(found)

    return report


def _examples(interface: WireInterface) -> Published:
    every = interface.operations.values()
    return Published(interface, RATE, tuple((one, one.example_arguments()) for one in every))


def _mapping(node: Node) -> tree.Mapping:
    return node if isinstance(node, tree.Mapping) else tree.mapping_at(node.span, {})


def _entries(node: Node | None) -> Iterable[tuple[Scalar, Node]]:
    return list(node.items()) if isinstance(node, tree.Mapping) else ()


def _of_ice(what: str, node: Node | None) -> list[Diagnostic]:
    found = of_text(what, node) if isinstance(node, Scalar) else None
    return [found] if found is not None else []


def _text(node: Node | None) -> str:
    return node.lexeme if isinstance(node, Scalar) else ""
