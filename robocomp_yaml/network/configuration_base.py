"""The base of an instance's configuration: the values document or the flat config that `config:` names."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from robocomp_yaml.addresses.own import MANAGER as DEFAULT_MANAGER
from robocomp_yaml.addresses.own import OwnAddresses, of_flat, of_values
from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.link.flat_configs import FlatConfig, flat_at
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Program
from robocomp_yaml.parameters.writing.sections import CLASSIC, FLAT_TOML, dialect
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source import tree
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Node, Scalar

_DIALECT_B = ("Endpoints.", "Proxies.", "Period.", "Agent.")


class ConfigurationBase(msgspec.Struct):
    """`values` is None for a flat config, `flat`. Without a base, both are None. `is_own`: no `config:` names it, so
    that it is the component's own."""

    values: LinkedValues | None = None
    flat: FlatConfig | None = None
    is_own: bool = False

    @property
    def properties(self) -> Mapping[str, str]:
        """The properties of a flat config as Ice reads them."""
        return self.flat.properties if self.flat is not None else {}

    @property
    def dialect(self) -> str:
        if self.values is not None:
            return dialect(self.values)
        return FLAT_TOML if any(key.startswith(_DIALECT_B) for key in self.properties) else CLASSIC

    @property
    def manager(self) -> str:
        """The proxy of the topic manager in the base, or ''. What rcyaml writes if nobody sets one is not a choice."""
        if self.values is None:
            manager = self.first(*connections.MANAGER)
            return "" if self.is_own and manager == DEFAULT_MANAGER else manager
        node = _entries(self.values, "topics").get("manager")
        return str(node.data) if node is not None else ""

    def topic(self, port: str, interface: str, *, is_out: bool) -> str:
        """The name of a topic as generated components compose it, from a prefix and a name."""
        prefixes = f"{port}Pub" if is_out else port
        if self.values is None:
            prefix, name = self.first(connections.prefix(prefixes)), self.first(port)
        else:
            prefix = _text(_entries(self.values, "topics", "prefix").get(prefixes))
            name = _text(_entries(self.values, "topics", "name").get(port))
        return connections.topic(prefix, name, interface)

    def first(self, *keys: str) -> str:
        return connections.first(self.properties.get, *keys)

    def proxy_key(self, name: str) -> Scalar | None:
        """The property that replaces the usual property of a proxy."""
        node = _entries(self.values, "proxies").get(name) if self.values is not None else None
        key = node.get("key") if isinstance(node, tree.Mapping) else None
        return key if isinstance(key, Scalar) else None

    def addresses(self, component: LinkedComponent) -> OwnAddresses:
        """The endpoints and proxies in the base."""
        if self.values is not None:
            return of_values(self.values)
        return of_flat(self.flat, component) if self.flat is not None else OwnAddresses()


def base_of_component(linked: LinkedComponent, program: Program) -> ConfigurationBase:
    """What a component without a deployment starts with."""
    from robocomp_yaml.addresses.own_configuration import own_configuration

    own = own_configuration(linked, program)
    return ConfigurationBase(own.values, own.flat, is_own=True)


def base_of(instance: LinkedInstance, disk: Disk) -> ConfigurationBase:
    if instance.entry.config is None and instance.component is not None:
        from robocomp_yaml.addresses.own_configuration import chosen  # programs have none

        own = chosen(instance.component, instance.values, disk)
        return ConfigurationBase(own.values, own.flat, is_own=True)
    flat = flat_at(instance.flat, disk) if instance.flat else None
    return ConfigurationBase(instance.values if flat is None else None, flat, instance.entry.config is None)


def _entries(values: LinkedValues, *sections: str) -> Mapping[str, Node]:
    from robocomp_yaml.parameters.layers.settings import merged_entries  # flat configs, and programs, have none

    return merged_entries(values, *sections)


def _text(node: Node | None) -> str:
    return unquoted(node.lexeme) if isinstance(node, Scalar) else ""
