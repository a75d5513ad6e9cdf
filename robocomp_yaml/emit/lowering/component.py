"""The component as such: what every generated file says of it, and which Slice it needs."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.slice import file_name
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.defaults import period

BEHAVIOR = "RoboCompCommonBehavior"
COMMON = "CommonBehavior.ice"


class LoweredComponent(msgspec.Struct, frozen=True):
    """`source` is the document's file, `doc` the name with what the document says of it. `files` are the Slice files of
    all `modules`, `imported` those that the component's document imports; `is_common` says that CommonBehavior's file
    is ours, and not among the user's."""

    source: str
    name: str
    doc: str
    period: int
    modules: tuple[str, ...]
    files: tuple[str, ...]
    imported: tuple[str, ...]
    is_common: bool


def lower(linked: LinkedComponent) -> LoweredComponent:
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
    )
