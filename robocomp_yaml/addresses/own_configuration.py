"""A component's own configuration: which of its files has the values with which it runs alone.

There is one answer for all commands. `compile` keeps a flat config of the user exactly if it is the own configuration.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.link.flat_configs import FlatConfig, flat_config
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Program
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.transactions.settings import unlike

if TYPE_CHECKING:
    from robocomp_yaml.parameters.writing.sections import Section


class OwnConfiguration(msgspec.Struct, frozen=True, eq=False):
    """The values document or the flat config of a component; both None if it has neither. `replaced` is the document
    that has no effect, because the user changed the flat config."""

    values: LinkedValues | None = None
    flat: FlatConfig | None = None
    replaced: LinkedValues | None = None


def own_configuration(linked: LinkedComponent, program: Program) -> OwnConfiguration:
    return chosen(linked, own_values(linked, program), program.disk)


def chosen(linked: LinkedComponent, values: LinkedValues | None, disk: Disk) -> OwnConfiguration:
    """The own configuration of a component with this `etc/config.yaml`."""
    flat = flat_config(os.path.dirname(linked.component.path), disk)
    if values is None:
        return OwnConfiguration(None, flat)
    return OwnConfiguration(None, flat, values) if users_properties(flat, values) else OwnConfiguration(values)


def own_values(linked: LinkedComponent, program: Program) -> LinkedValues | None:
    """The `etc/config.yaml` of a component."""
    values = program.values.get(own_document(linked, program.disk))
    return values if values is not None and values.parameters and values.parameters.component is linked else None


def is_own(values: LinkedValues, disk: Disk) -> bool:
    """Whether a values document is the `etc/config.yaml` of its component."""
    component = values.parameters.component if values.parameters else None
    return component is not None and own_document(component, disk) == disk.real(values.document.path)


def own_document(linked: LinkedComponent, disk: Disk) -> str:
    """The real path of a component's own values document."""
    return disk.real(os.path.join(os.path.dirname(linked.component.path), "etc", "config.yaml"))


def users_properties(flat: FlatConfig | None, values: LinkedValues) -> list[str]:
    """The keys for which an `etc/config` is the user's, and replaces the document which it is generated from."""
    if flat is None or flat.is_unchanged:
        return []
    from robocomp_yaml.parameters.layers.effective import effective
    from robocomp_yaml.parameters.writing.properties import properties as written

    found = effective(values)[0] if values.parameters is not None else None
    if found is None:
        return []  # the errors of the document are reported
    return users_keys(flat, stated_in(written(values, found, beside=True)[0]))


def stated_in(sections: Iterable[Section]) -> dict[str, str]:
    return {made.key: made.value for section in sections for made in section.properties}


def users_keys(
    flat: FlatConfig | None, stated: Mapping[str, str], beside: Mapping[str, str] | None = None
) -> list[str]:
    """The keys of the properties that make a flat config the user's: those with a value that neither rcyaml wrote nor
    a document states; if there are none, and rcyaml never wrote the file, those that it lacks. `beside` are the
    properties of a file that programs read before it."""
    if flat is None or flat.is_unchanged:
        return []
    keys = unlike(flat.properties, stated, flat.base)
    if not keys and not flat.is_written:
        keys = unlike(stated, {**(beside or {}), **flat.properties})
    return keys
