"""What an instance's configuration is built on: the values document or the flat file that `config:` names."""

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


class Base(msgspec.Struct):
    """`values` are None for a flat file, of which `flat` is the text and `properties` what Ice makes of it; without
    either there is nothing to build on."""

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
        """The topic manager's proxy that it names, or ''."""
        if self.values is None:
            return self.first(*connections.MANAGER)
        for layer in reversed(self.values.layers()):
            topics = layer.document.section("topics")
            if topics is not None and "manager" in topics.entries:
                return str(topics.entries["manager"][1].data or "")
        return ""

    def topic(self, port: str, interface: str, *, is_out: bool) -> str:
        """The name of a topic, as generated components make it: a prefix, and a name of its own."""
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
        """The property that a proxy has instead of its usual one."""
        node = dict(merged_entries(self.values, "proxies")).get(name) if self.values is not None else None
        key = node.get("key") if isinstance(node, Mapping) else None
        return key if isinstance(key, Scalar) else None


def base_of(instance: LinkedInstance, disk: Disk) -> Base:
    if instance.values is not None:
        return Base(instance.values)
    raw = disk.read(instance.flat)[0] if instance.flat and disk.has_file(instance.flat) else None
    if raw is None:
        return Base()
    text = raw.decode("utf-8", "replace")
    return Base(None, text, properties.read(text).values)


def _text(node: Node | None) -> str:
    return unquoted(node.lexeme) if isinstance(node, Scalar) else ""
