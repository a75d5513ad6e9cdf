"""The base of an instance's configuration: the values document or the flat config that `config:` names."""

from __future__ import annotations

import msgspec

from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.link.program import LinkedValues
from robocomp_yaml.parameters.writing.properties import CLASSIC, FLAT_TOML, dialect, merged_entries
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source import properties
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Mapping, Node, Scalar

_DIALECT_B = ("Endpoints.", "Proxies.", "Period.", "Agent.")


class ConfigurationBase(msgspec.Struct):
    """`values` is None for a flat config: then `flat` is its text, and `properties` are its properties as Ice reads
    them. Without a base, both are None."""

    values: LinkedValues | None = None
    flat: str | None = None
    properties: dict[str, str] = {}

    @property
    def dialect(self) -> str:
        if self.values is not None:
            return dialect(self.values)
        return FLAT_TOML if any(key.startswith(_DIALECT_B) for key in self.properties) else CLASSIC

    @property
    def manager(self) -> str:
        """The proxy of the topic manager in the base, or ''."""
        if self.values is None:
            return self.first(*connections.MANAGER)
        for layer in reversed(self.values.layers()):
            topics = layer.document.section("topics")
            if topics is not None and "manager" in topics.entries:
                return str(topics.entries["manager"][1].data or "")
        return ""

    def topic(self, port: str, interface: str, *, is_out: bool) -> str:
        """The name of a topic as generated components compose it, from a prefix and a name."""
        prefixes = f"{port}Pub" if is_out else port
        if self.values is None:
            prefix, name = self.first(connections.prefix(prefixes)), self.first(port)
        else:
            prefix = _text(dict(merged_entries(self.values, "topics", "prefix")).get(prefixes))
            name = _text(dict(merged_entries(self.values, "topics", "name")).get(port))
        return connections.topic(prefix, name, interface)

    def first(self, *keys: str) -> str:
        return connections.first(self.properties.get, *keys)

    def proxy_key(self, name: str) -> Scalar | None:
        """The property that replaces the usual property of a proxy."""
        node = dict(merged_entries(self.values, "proxies")).get(name) if self.values is not None else None
        key = node.get("key") if isinstance(node, Mapping) else None
        return key if isinstance(key, Scalar) else None


def base_of(instance: LinkedInstance, disk: Disk) -> ConfigurationBase:
    if instance.values is not None:
        return ConfigurationBase(instance.values)
    raw = disk.read(instance.flat)[0] if instance.flat and disk.has_file(instance.flat) else None
    if raw is None:
        return ConfigurationBase()
    text = raw.decode("utf-8", "replace")
    return ConfigurationBase(None, text, properties.read(text).values)


def _text(node: Node | None) -> str:
    return unquoted(node.lexeme) if isinstance(node, Scalar) else ""
