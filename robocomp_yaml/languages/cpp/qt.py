"""C++ components with Qt: those with a window, and those with code for RoboComp's own tool."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator

from robocomp_yaml.emit.render import View, changed
from robocomp_yaml.languages._shared.text import IN, declaration
from robocomp_yaml.languages._shared.views import PortViews
from robocomp_yaml.languages.cpp.names import ice_name, older_names, parameter, qualified
from robocomp_yaml.languages.cpp.types import input_type, type_name
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Enum, Method

_ABSENT = "robocomp::Absent"


def qt_view(linked: LinkedComponent) -> View | None:
    """Qt in a component: `modules` for find_package, `libraries` to link, `base` the class of the window."""
    gui = linked.component.gui
    if not (gui or linked.component.compatibility):
        return None
    modules = ["Core", "Widgets"] if gui else ["Core"]
    libraries = " ".join(f"Qt${{QT_VERSION_MAJOR}}::{module}" for module in modules)
    return View(modules=" ".join(modules), libraries=libraries, base=gui.base if gui else "")


def robocomp_view(linked: LinkedComponent, ports: PortViews) -> View | None:
    """What code for RoboComp's own tool needs. `tie`, `tuple_types` and `map` list the accessors; `methods` are
    declared for classes that override them, protected, so that nobody else calls them; `legacy_sources` are the names
    of RoboComp's own files in `src/`; `headers` are those of listed classes, which its generic part included."""
    component = linked.component
    if not component.compatibility:
        return None
    accessors = ports.accessors
    classes = {accessor.name: accessor.proxy for accessor in accessors}
    handles = [  # of the proxies' classes of a module, as in Ice's older mapping
        View(module=ice_name(scope.module.name), names=[f"{one.name}Prx" for one in scope.module.all_interfaces])
        for scope in linked.modules() if scope.module.all_interfaces
    ]  # fmt: skip
    served = sorted({port.interface.name.lower() for port in (*linked.implements, *linked.subscribes)})
    return View(
        base=f"{component.gui.base}, public Ui_guiDlg" if component.gui else "QObject",
        tuple_types=", ".join(f"std::shared_ptr<{accessor.proxy}>" for accessor in accessors),
        tie=", ".join(accessor.name for accessor in accessors),
        map=", ".join(f'{{"{accessor.name}", {accessor.name}}}' for accessor in accessors),
        casts=_casts(accessors),
        methods=list(_methods(linked)),
        namespaces=[ice_name(scope.module.name) for scope in linked.modules()],
        enumerators=[_enumerators(scope) for scope in linked.modules()],
        legacy_sources="|".join(["commonbehaviorI", *(f"{name}I" for name in served)]),
        services=[_behind_pointer(service) for service in ports.services],
        older=[View(proxy=classes[now], name=name, now=now) for name, now in older_names(classes)],
        handles=handles,
        handle_names=sorted({name for one in handles for name in one.names}),
        headers=[os.path.basename(one.path) for one in component.sources if one.path.endswith((".h", ".hpp"))],
    )


def _casts(accessors: list[View]) -> list[str]:
    """A cast for each proxy in the map, as arguments."""
    casts = [f'Ice::uncheckedCast<{accessor.proxy}>(mprx["{accessor.name}"]),' for accessor in accessors]
    return [*casts[:-1], casts[-1].removesuffix(",")] if casts else []


def _behind_pointer(service: View) -> View:
    """RoboComp creates servants before the worker, and the worker has no log."""
    return changed(
        service,
        operations=[changed(one, body=_either(one)) if one.calls else one for one in service.operations],
        new_methods=[changed(method, stub=method.stub[1:]) for method in service.new_methods],
    )


def _either(operation: View) -> str:
    """The call of the worker's method, which the oldest versions of the tool name without the interface."""
    names = (operation.calls, operation.calls.partition("_")[2])
    calls = [f"worker.{name}({operation.arguments})" for name in names]
    absent = ", ".join(filter(None, (operation.arguments, f"{_ABSENT}()")))
    calls.append(f"worker.{operation.calls}({absent})")
    ways = [f"[&](auto& worker) -> decltype({call}) {{ return {call}; }}" for call in calls]
    return declaration("return robocomp::call", ["*worker_", *ways], ";", IN * 2)


def _methods(linked: LinkedComponent) -> Iterator[str]:
    """The worker's methods, with inputs by reference and by value: versions of RoboComp's tool differ in that. One
    more overload makes calls of the generic worker's own ones ambiguous: a servant finds a method of this name only if
    the user's class has it, which hides them all; else it calls that overload."""
    seen: set[str] = set()
    for port in (*linked.implements, *linked.subscribes):
        subscribed = port in linked.subscribes
        for method in port.interface.methods:
            name = f"{port.interface.name}_{method.name}"
            if name not in seen and (method.can_be_published or not subscribed):
                seen.add(name)
                yield from _variants(name, method, port)


def _variants(name: str, method: Method, port: Port) -> Iterator[str]:
    scope = port.scope
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    outputs = [f"{type_name(m.type, scope)}& {parameter(m.name)}" for m in method.outputs]
    by_reference = [f"{input_type(m.type, scope)} {parameter(m.name)}" for m in method.inputs]
    by_value = [f"{type_name(m.type, scope)} {parameter(m.name)}" for m in method.inputs]
    throws = f' {{ throw std::logic_error("{name}() is missing"); }}'
    for inputs in (by_reference, by_value) if by_reference != by_value else (by_value,):
        unnamed = [word.rpartition(" ")[0] for word in (*inputs, *outputs)]
        yield declaration(f"virtual {returns} {name}", unnamed, throws, IN)
    yield declaration(f"{returns} {name}", [*unnamed, f"{_ABSENT} = {{}}"], throws, IN)


def _enumerators(scope: LinkedModule) -> View:
    """The enumerators that no other definition of the module hides, as constants beside their enum, as in Ice's older
    mapping."""
    enums = [definition for definition in scope.module.definitions if isinstance(definition, Enum)]
    taken = Counter(definition.name for definition in scope.module.definitions)
    taken.update(enumerator.name for enum in enums for enumerator in enum.enumerators)
    constants = [
        f"inline constexpr auto {name} = {qualified(scope, enum.name)}::{name};"
        for enum in enums for name in (ice_name(enumerator.name) for enumerator in enum.enumerators)
        if taken[name] == 1
    ]  # fmt: skip
    return View(module=ice_name(scope.module.name), constants=constants)
