"""A component's ports as Python spells them: accessors, and the worker's methods with their signatures.

All that is here goes to the templates as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.lowering.types import resolve, results
from robocomp_yaml.languages.python.names import PORTS, ice_name, module_variable, parameters
from robocomp_yaml.languages.python.text import about, docstring, one_line, signature
from robocomp_yaml.languages.python.types import hint, qualified, result_hint, zero
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
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
    """All ports of a component, as Python has them."""

    def __init__(self, component: LinkedComponent) -> None:
        found = lowering.lower(component, PORTS)
        modules = [module_variable(linked.module.name) for linked in component.modules()]
        self.requires = [_accessor(accessor) for accessor in found.requires]
        self.publishes = [_accessor(accessor, accessor.port.interface.name) for accessor in found.publishes]
        self.implements = [_served(service, modules) for service in found.implements]
        self.subscribes = [_served(service, modules) for service in found.subscribes]


def _accessor(accessor: lowering.Accessor, topic: str = "") -> AccessorView:
    port = accessor.port
    return AccessorView(
        name=port.name,
        topic=topic,
        attribute=accessor.name,
        proxy=f"{module_variable(port.scope.module.name)}.{port.interface.name}Prx",
        docstring=docstring(f"{accessor.about}\n\n{accessor.doc}", IN * 2),
        summary=accessor.summary,
        absent=accessor.absent,
        timeout="" if port.use.timeout is None else repr(port.use.timeout),
    )


def _served(service: lowering.Service, modules: Sequence[str]) -> ServedView:
    port = service.port
    topic, interface = port.interface.name, qualified(port.scope, port.interface.name)
    every = [_method(called, modules) for called in service.methods]
    new = [_method(called, modules) for called in service.new]
    return ServedView(port.name, service.identity, topic, interface, service.title, every, new)


def _method(called: lowering.CalledMethod, modules: Sequence[str]) -> MethodView:
    port, method, name = called.port, called.method, called.name
    scope = port.scope
    names = list(parameters((member.name for member in method.inputs), modules))
    typed = [f"{n}: {hint(member.type, scope)}" for n, member in zip(names, method.inputs, strict=True)]
    throws = [qualified(*_home(ref, scope)) for ref in method.throws]
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


def _home(ref: TypeRef, scope: LinkedModule) -> tuple[LinkedModule, str]:
    home, definition = resolve(ref, scope)
    return home, definition.name


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
