"""The ports of a component in Java: accessors, servants, and the worker's methods that servants call."""

from __future__ import annotations

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.types import resolve, results
from robocomp_yaml.emit.render import View
from robocomp_yaml.languages._shared.text import IN, declaration
from robocomp_yaml.languages._shared.views import PortViews
from robocomp_yaml.languages.java.names import PORTS, ice_name, parameter, proxy, qualified
from robocomp_yaml.languages.java.text import comment, literal, one_line
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Enum, Map, Member, Method, Sequence, TypeRef


def port_views(component: LinkedComponent) -> PortViews:
    lowered, servants = lowering.lower(component, PORTS), NameAllocator(("Services",))
    return PortViews(
        [_required(accessor) for accessor in lowered.requires],
        [_published(accessor) for accessor in lowered.publishes],
        [_service(one, servants, "Servant", one.identity) for one in lowered.implements],
        [_service(one, servants, "Subscriber", "") for one in lowered.subscribes],
    )


def _required(accessor: lowering.Accessor) -> View:
    milliseconds = -1 if accessor.milliseconds is None else min(accessor.milliseconds, 2**31 - 1)
    words = [literal(accessor.port.name), literal(accessor.port.use.absent), str(milliseconds)]
    return _accessor(accessor, f"connections.required({', '.join(words)})", accessor.summary)


def _published(accessor: lowering.Accessor) -> View:
    words = [literal(accessor.port.name), literal(accessor.port.interface.name)]
    return _accessor(accessor, f"connections.published({', '.join(words)})", f"{accessor.summary}: {accessor.events}")


def _accessor(accessor: lowering.Accessor, made: str, summary: str) -> View:
    """A proxy of the worker; `made` creates it."""
    return View(
        name=accessor.name,
        proxy=proxy(accessor.port.scope, accessor.port.interface.name),
        comment=comment(f"{accessor.about}\n{accessor.doc}", IN),
        summary=one_line(summary),
        made=made,
    )


def _service(service: lowering.Service, servants: NameAllocator, suffix: str, identity: str) -> View:
    """A port; `arguments` are those of the run time's `Service`. `new_methods` are those that no earlier port has."""
    port, calls = service.port, {called.method.name: called.name for called in service.methods}
    words = (port.name, identity, port.interface.name)
    return View(
        title=one_line(service.title),
        servant=servants.allocate(f"{port.name}{suffix}"),
        base=qualified(port.scope, port.interface.name),
        arguments=", ".join(map(literal, words)),
        operations=[_operation(method, port, calls.get(method.name, "")) for method in port.interface.methods],
        new_methods=[_method(called) for called in service.new],
    )


def _operation(method: Method, port: Port, calls: str) -> View:
    """The operation that calls the worker's method `calls`; '' for an operation that cannot be published."""
    names = [f"in{number}" for number in range(len(method.inputs))]
    typed = [f"{type_name(m.type, port.scope)} {name}" for m, name in zip(method.inputs, names, strict=True)]
    typed.append("com.zeroc.Ice.Current current")
    returns = result_type(method, port)
    return View(
        declaration=declaration(f"public {returns} {ice_name(method.name)}", typed, _throws(method, port), IN * 2),
        call=f"{'' if returns == 'void' else 'return '}worker().{calls}({', '.join(names)});",
        name=literal(calls),
        is_published=bool(calls),
    )


def _method(called: lowering.CalledMethod) -> View:
    """A method of the worker: abstract in GenericWorker, and as a stub in the user's class."""
    method, port = called.method, called.port
    returns = result_type(method, port)
    typed = [f"{type_name(member.type, port.scope)} {parameter(member.name)}" for member in method.inputs]
    throws = _throws(method, port)
    return View(
        comment=comment(_described(method, port), IN),
        declaration=declaration(f"public abstract {returns} {called.name}", typed, f"{throws};", IN),
        definition=declaration(f"public {returns} {called.name}", typed, f"{throws} {{", IN),
        stub=_stub(called, returns),
    )


def _throws(method: Method, port: Port) -> str:
    names = [type_name(ref, port.scope) for ref in method.throws]
    return f" throws {', '.join(names)}" if names else ""


def _stub(called: lowering.CalledMethod, returns: str) -> list[str]:
    """The statements of a method until the user writes it."""
    method, scope = called.method, called.port.scope
    hidden = "this." if any(member.name == "log" for member in method.inputs) else ""
    lines = [f'{hidden}log.info("{called.name}() is still to be written");']
    values = [zero(ref, scope) for ref in results(method)]
    if len(values) > 1:
        return [*lines, f"return new {returns}({', '.join(values)});"]
    return [*lines, f"return {values[0]};"] if values else lines


def _described(method: Method, port: Port) -> str:
    lines = [method.doc.strip() or f"{port.interface.name}.{method.name}"]
    for member in (*method.inputs, *method.outputs):
        if note := _note(member):
            lines.append(f"{ice_name(member.name)}: {note}")
    return "\n".join(lines)


def _note(member: Member) -> str:
    unit = f"[{member.unit}]" if member.unit else ""
    return " ".join(part for part in (" ".join(member.doc.split()), unit) if part)


_BASIC = {
    "bool": "boolean", "byte": "byte", "short": "short", "int": "int", "long": "long", "float": "float",
    "double": "double", "string": "String",
}  # fmt: skip
_BOXED = {
    "bool": "Boolean", "byte": "Byte", "short": "Short", "int": "Integer", "long": "Long", "float": "Float",
    "double": "Double", "string": "String",
}  # fmt: skip
_ZEROS = {"bool": "false", "string": '""', "float": "0.0f", "double": "0.0", "byte": "(byte) 0", "short": "(short) 0"}


def type_name(ref: TypeRef, scope: LinkedModule, *, boxed: bool = False) -> str:
    """The type of a value; `boxed` where a map holds it."""
    if ref.is_basic:
        return (_BOXED if boxed else _BASIC)[ref.text]
    home, definition = resolve(ref, scope)
    match definition:
        case Sequence(element=element):
            return f"{type_name(element, home)}[]"
        case Map(key=key, value=value):
            return f"java.util.Map<{type_name(key, home, boxed=True)}, {type_name(value, home, boxed=True)}>"
        case _:
            return qualified(home, definition.name)


def result_type(method: Method, port: Port) -> str:
    """The return type of a method: an object if there are several results."""
    types = results(method)
    if len(types) > 1:
        return f"{qualified(port.scope, port.interface.name)}.{method.name[:1].upper()}{method.name[1:]}Result"
    return type_name(types[0], port.scope) if types else "void"


def zero(ref: TypeRef, scope: LinkedModule) -> str:
    """The default value: zero, empty, the first enumerator, a struct of its defaults."""
    if ref.is_basic:
        return _ZEROS.get(ref.text, "0")
    home, definition = resolve(ref, scope)
    match definition:
        case Sequence():
            of = type_name(ref, scope)
            at = of.index("[]")
            return f"new {of[:at]}[0]{of[at + 2 :]}" if "<" not in of[:at] else "null"
        case Map():
            return "new java.util.HashMap<>()"
        case Enum(enumerators=(first, *_)):
            return f"{qualified(home, definition.name)}.{ice_name(first.name)}"
        case _:
            return f"new {qualified(home, definition.name)}()"
