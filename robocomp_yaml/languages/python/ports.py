"""The ports of a component in Python: accessors, and the worker's methods with their signatures.

Templates show these views unchanged.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.lowering.types import results
from robocomp_yaml.emit.render import View
from robocomp_yaml.languages._shared.text import IN
from robocomp_yaml.languages._shared.views import PortViews
from robocomp_yaml.languages.python.names import PORTS, ice_name, module_variable, parameters
from robocomp_yaml.languages.python.text import about, docstring, one_line, signature
from robocomp_yaml.languages.python.types import hint, qualified, result_hint, zero
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.interface import Method


def port_views(component: LinkedComponent) -> PortViews:
    lowered = lowering.lower(component, PORTS)
    modules = [module_variable(linked.module.name) for linked in component.modules()]
    return PortViews(
        [_accessor(accessor) for accessor in lowered.requires],
        [_accessor(accessor, accessor.port.interface.name) for accessor in lowered.publishes],
        [_served(service, modules) for service in lowered.implements],
        [_served(service, modules) for service in lowered.subscribes],
    )


def _accessor(accessor: lowering.Accessor, topic: str = "") -> View:
    """A proxy of the worker. `absent` and `timeout` are '' for the run time's default."""
    port = accessor.port
    return View(
        name=port.name,
        topic=topic,
        attribute=accessor.name,
        proxy=f"{module_variable(port.scope.module.name)}.{port.interface.name}Prx",
        docstring=docstring(f"{accessor.about}\n\n{accessor.doc}", IN * 2),
        summary=accessor.summary,
        absent=accessor.absent,
        timeout="" if port.use.timeout is None else repr(port.use.timeout),
    )


def _served(service: lowering.Service, modules: Sequence[str]) -> View:
    """An implemented or subscribed port. `new_methods` are the methods that no earlier port has."""
    port = service.port
    return View(
        name=port.name,
        identity=service.identity,
        topic=port.interface.name,
        interface=qualified(port.scope, port.interface.name),
        title=service.title,
        methods=[_method(called, modules) for called in service.methods],
        new_methods=[_method(called, modules) for called in service.new],
    )


def _method(called: lowering.CalledMethod, modules: Sequence[str]) -> View:
    """A method of the worker that a servant calls; `value` is what its stub returns, '' for nothing; `plain_signature`
    has no type hints."""
    port, method, name = called.port, called.method, called.name
    scope = port.scope
    names = list(parameters((member.name for member in method.inputs), modules))
    typed = [f"{n}: {hint(member.type, scope)}" for n, member in zip(names, method.inputs, strict=True)]
    throws = [hint(ref, scope) for ref in method.throws]
    doc = method.doc or f"{port.interface.name}.{method.name}"
    details = "\n".join(_details(method, names, throws))
    return View(
        operation=ice_name(method.name),
        name=name,
        signature=signature(name, typed, result_hint(method, scope), IN),
        plain_signature=f"def {name}({', '.join(['self', *names])}):",
        throws=f", throws=({', '.join(throws)}{',' * (len(throws) == 1)})" if throws else "",
        is_tuple=", is_tuple=True" if len(results(method)) > 1 else "",
        docstring=docstring(f"{doc}\n\n{details}", IN * 2),
        summary=docstring(one_line(doc.strip().partition("\n")[0]), IN * 2),
        value=", ".join(zero(ref, scope) for ref in results(method)),
    )


def _details(method: Method, names: Sequence[str], throws: Sequence[str]) -> Iterator[str]:
    """What the signature does not show."""
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
