"""The values with which a component runs: those of its values document, or of the flat config that replaces it."""

from __future__ import annotations

import os
from collections.abc import Iterable

from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.addresses.flat_values import FlatValues, flat_values
from robocomp_yaml.addresses.own_configuration import own_configuration
from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.link.flat_configs import flat_at
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Program
from robocomp_yaml.parameters.editing.settings import DEFAULT, SET, OverriddenValue, ShownSetting, run_time_defaults
from robocomp_yaml.parameters.editing.show import Value
from robocomp_yaml.parameters.layers.settings import Setting, settings
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.source.yaml_text import flow


def flat_file(path: str, program: Program) -> FlatValues | None:
    """A component's flat config as values; None if it cannot be read."""
    flat, home = flat_at(path, program.disk), os.path.realpath(os.path.dirname(os.path.dirname(os.path.abspath(path))))
    for real, linked in program.components.items():
        if os.path.dirname(real) == home and flat is not None:
            return flat_values(flat, linked.parameters, linked)
    return None


def replacing(values: LinkedValues, program: Program) -> LinkedValues | None:
    """The flat config that replaces a values document, because the user changed it."""
    component = values.parameters.component if values.parameters else None
    if component is None or values.parameters is None:
        return None
    own = own_configuration(component, program)
    if own.replaced is not values or own.flat is None:
        return None
    return flat_values(own.flat, values.parameters, component).layer


def overriding(rows: Iterable[Value], others: Iterable[Value]) -> list[Value]:
    """The rows, each with the value of the other rows that it overrides."""
    before = {row.path: row for row in others}
    found = []
    for row in rows:
        other = before.get(row.path)
        nodes = (other.node, *other.overrode) if other is not None and other.node is not None else ()
        found.append(replace(row, overrode=(*row.overrode, *nodes)))
    return found


def settings_of(
    values: LinkedValues, document: LinkedValues | None, addresses: Addresses, *, reveal: bool
) -> list[ShownSetting]:
    """The properties that are no parameters. `document` are the values that a flat config replaces."""
    replaced = {one.key: one for one in settings(document)} if document is not None and document is not values else {}
    found = {one.key: _shown(one, replaced.get(one.key), reveal=reveal) for one in settings(values)}
    component = values.parameters.component if values.parameters else None
    if component is not None and not component.broken:
        for made in (*_addresses(component, addresses), *run_time_defaults()):
            found.setdefault(made.key, made)
    return list(found.values())


def _shown(one: Setting, replaced: Setting | None, *, reveal: bool) -> ShownSetting:
    def text(node: Node) -> str:
        spelled = node.lexeme if isinstance(node, Scalar) else flow(node.data)
        return spelled if reveal else secrets.value(one.key, spelled)

    nodes = [*one.overrode, *((replaced.node, *replaced.overrode) if replaced is not None else ())]
    overrode = tuple(OverriddenValue(text(node), node.span) for node in nodes)
    return ShownSetting(one.key, text(one.node), SET, one.node.span, overrode)


def _addresses(component: LinkedComponent, addresses: Addresses) -> Iterable[ShownSetting]:
    """The endpoints and proxies that a compile writes if nobody sets them."""
    from robocomp_yaml.emit.config import connections

    for key, value in connections(component, addresses.table(component), {}).items():
        yield ShownSetting(key, value, DEFAULT)
