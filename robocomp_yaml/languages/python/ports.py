"""A component's ports as Python spells them: accessors, and the worker's methods with their signatures.

All that is here goes to the templates as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.languages.python.names import (
    WORKER_ATTRIBUTES,
    Names,
    ice_name,
    module_variable,
    parameters,
    proxy_method,
)
from robocomp_yaml.languages.python.text import about, docstring, one_line, signature
from robocomp_yaml.languages.python.types import hint, qualified, result_hint, results, zero
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.component import WAIT
from robocomp_yaml.model.interface import Method, TypeRef

IN = "    "


class MethodView(msgspec.Struct, frozen=True):
    """A method of the worker that a servant calls; `value` is what its stub returns, '' where there is nothing;
    `plain_signature` has no hints."""

    operation: str
    name: str
    signature: str
    plain_signature: str
    throws: str
    is_tuple: str
    docstring: str
    summary: str
    value: str


class ServedView(msgspec.Struct, frozen=True):
    """An implemented or subscribed port. `new_methods` are those that no earlier port has brought."""

    name: str
    identity: str
    topic: str
    interface: str
    title: str
    methods: list[MethodView]
    new_methods: list[MethodView]


class AccessorView(msgspec.Struct, frozen=True):
    """A proxy that the worker has. `absent` and `timeout` are '' where the run time's default holds."""

    name: str
    topic: str
    attribute: str
    proxy: str
    docstring: str
    summary: str
    absent: str = ""
    timeout: str = ""


class Ports:
    """All ports of a component, with names that do not clash."""

    def __init__(self, component: LinkedComponent) -> None:
        self._names = Names(WORKER_ATTRIBUTES)
        self._methods: dict[tuple[int, str, str], MethodView] = {}
        self._modules = [module_variable(linked.module.name) for linked in component.modules()]
        self.requires = [self._required(port) for port in component.requires]
        self.publishes = [self._published(port) for port in component.publishes]
        self.implements = [
            self._served(port, f"{port.name}: other components call these.", port.interface.methods)
            for port in component.implements
        ]
        self.subscribes = [
            self._served(port, f"{port.name}: events that others publish.", _published_methods(port))
            for port in component.subscribes
        ]

    def _required(self, port: Port) -> AccessorView:
        text = port.use.doc or port.interface.doc
        note = f"{port.name}, at the address that the property `{port.name}Proxy` gives.\n\n{text}"
        return AccessorView(
            name=port.name,
            topic="",
            attribute=self._names.take(f"{port.name.lower()}_proxy"),
            proxy=_proxy(port),
            docstring=docstring(note, IN * 2),
            summary=f"calls {port.name}",
            absent="" if port.use.absent == WAIT else port.use.absent,
            timeout="" if port.use.timeout is None else repr(port.use.timeout),
        )

    def _published(self, port: Port) -> AccessorView:
        events = ", ".join(
            f"{proxy_method(m.name)}({', '.join(member.name for member in m.inputs)})" for m in _published_methods(port)
        )
        lower = port.name.lower()
        return AccessorView(
            name=port.name,
            topic=port.interface.name,
            attribute=self._names.take(f"{lower}_proxy", f"{lower}_pubproxy"),
            proxy=_proxy(port),
            docstring=docstring(f"Publishes {port.name}: {events}.\n\n{port.use.doc or port.interface.doc}", IN * 2),
            summary=f"publishes {port.name}",
        )

    def _served(self, port: Port, title: str, methods: Sequence[Method]) -> ServedView:
        every, new = [], []
        for method in methods:
            key = (id(port.scope), port.interface.name, method.name)
            if key not in self._methods:
                self._methods[key] = self._method(port, method)
                new.append(self._methods[key])
            every.append(self._methods[key])
        name = port.interface.name
        return ServedView(port.name, name.lower(), name, qualified(port.scope, name), title, every, new)

    def _method(self, port: Port, method: Method) -> MethodView:
        scope = port.scope
        name = self._names.take(f"{port.interface.name}_{method.name}")
        names = list(parameters((member.name for member in method.inputs), self._modules))
        typed = [f"{n}: {hint(member.type, scope)}" for n, member in zip(names, method.inputs, strict=True)]
        throws = [_exception(ref, scope) for ref in method.throws]
        doc = method.doc or f"{port.interface.name}.{method.name}"
        details = "\n".join(_details(method, names, throws))
        return MethodView(
            operation=ice_name(method.name),
            name=name,
            signature=signature(name, typed, result_hint(method, scope), IN),
            plain_signature=f"def {name}({', '.join(['self', *names])}):",
            throws=_throws(throws),
            is_tuple=", is_tuple=True" if len(results(method)) > 1 else "",
            docstring=docstring(f"{doc}\n\n{details}", IN * 2),
            summary=docstring(one_line(doc.strip().partition("\n")[0]), IN * 2),
            value=", ".join(zero(ref, scope) for ref in results(method)),
        )


def _details(method: Method, names: Sequence[str], throws: Sequence[str]) -> Iterator[str]:
    """What the signature does not say."""
    for name, member in zip(names, method.inputs, strict=True):
        if note := about(member):
            yield f"{name}: {note}"
    if method.outputs:
        result = [] if method.returns is None else ["the result"]
        yield f"Returns {', '.join([*result, *(member.name for member in method.outputs)])}."
    for member in method.outputs:
        if note := about(member):
            yield f"{member.name}: {note}"
    if throws:
        yield f"Raises {', '.join(throws)}."


def _throws(exceptions: Sequence[str]) -> str:
    """The argument of the method's row in the table."""
    inner = ", ".join(exceptions)
    return f", throws=({inner},)" if len(exceptions) == 1 else f", throws=({inner})" if exceptions else ""


def _published_methods(port: Port) -> list[Method]:
    return [method for method in port.interface.methods if method.can_be_published]


def _proxy(port: Port) -> str:
    return f"{module_variable(port.scope.module.name)}.{port.interface.name}Prx"


def _exception(ref: TypeRef, scope: LinkedModule) -> str:
    found = scope.find(ref)
    if found is None:
        raise LookupError(f"{ref.text} is not linked: {scope.module.path}")
    return qualified(found[0], found[1].name)
