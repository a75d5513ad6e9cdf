"""Lowers the component itself: what all generated files need of it, and its Slice files."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.slice import file_name
from robocomp_yaml.languages.record import PORTS
from robocomp_yaml.link.interface_hash import interface_hash
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.defaults import period

BEHAVIOR = "RoboCompCommonBehavior"
COMMON = "CommonBehavior.ice"


class InterfaceHash(msgspec.Struct, frozen=True):
    """The `content` of a port's interface, as a hash. `role` is the key of the component's document."""

    role: str
    port: str
    interface: str
    content: str


class LoweredComponent(msgspec.Struct, frozen=True):
    """`source` is the file name of the document, `doc` the name with the documentation, `period` in milliseconds.
    `files` are the Slice files of all `modules`, `imported` those that the document imports. `is_common`: the Slice
    file of CommonBehavior is that of rcyaml, not one of the user's."""

    source: str
    name: str
    doc: str
    period: int
    modules: tuple[str, ...]
    files: tuple[str, ...]
    imported: tuple[str, ...]
    is_common: bool
    interfaces: tuple[InterfaceHash, ...]


def lower(linked: LinkedComponent) -> LoweredComponent:
    """The views of a component."""
    component = linked.component
    scopes = linked.modules()
    is_common = all(scope.module.name != BEHAVIOR for scope in scopes)
    common = [COMMON] if is_common else []
    return LoweredComponent(
        source=component.path.rpartition("/")[2],
        name=component.name,
        doc=f"{component.name}: {component.doc}" if component.doc else component.name,
        period=period(linked.parameters.parameters),
        modules=tuple(dict.fromkeys([*(scope.module.name for scope in scopes), BEHAVIOR])),
        files=tuple(dict.fromkeys([*map(file_name, scopes), *common])),
        imported=(*map(file_name, linked.imports), *common),
        is_common=is_common,
        interfaces=tuple(
            InterfaceHash(role, port.name, f"{port.scope.module.name}.{port.interface.name}", interface_hash(port))
            for role in PORTS
            for port in getattr(linked, role)
        ),
    )
