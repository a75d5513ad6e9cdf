"""What a component's own configuration says about where it is, and where the others are."""

from __future__ import annotations

import msgspec

from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.flat_configs import FlatConfig
from robocomp_yaml.link.program import LinkedComponent, LinkedValues
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.texts import unquoted

MANAGER = "IceStorm/TopicManager:default -p 9999"
"""The proxy of the topic manager in a first `etc/config`."""


class OwnText(msgspec.Struct, frozen=True):
    """An endpoint or a proxy, and its location. `is_as_written`: rcyaml wrote it, and nobody changed it."""

    text: str
    span: Span
    is_as_written: bool = False


class OwnAddresses(msgspec.Struct, frozen=True):
    """The endpoints by the names of adapters (`HeardTopic` for a topic), the proxies by the names of ports, and the
    proxy of the topic manager."""

    endpoints: dict[str, OwnText] = {}
    proxies: dict[str, OwnText] = {}
    manager: OwnText | None = None


def of_values(values: LinkedValues) -> OwnAddresses:
    """The addresses of a values document and its layers."""
    from robocomp_yaml.parameters.layers import settings  # most components have no values document

    found = OwnAddresses()
    for one in settings.settings(values):
        text = OwnText(unquoted(one.node.lexeme), one.node.span)
        if one.section == "endpoints":
            found.endpoints[one.name] = text
            found.endpoints.setdefault(one.name.removesuffix(connections.OLDEST), text)
        elif one.section == "proxies":
            found.proxies[one.name] = text
        elif one.path == settings.MANAGER:
            found = OwnAddresses(found.endpoints, found.proxies, text)
    return found


def of_flat(flat: FlatConfig, linked: LinkedComponent) -> OwnAddresses:
    """The addresses of a flat config, under any spelling of their properties."""

    def first(*keys: str) -> OwnText | None:
        for key in keys:
            if entry := flat.entries.get(key):
                span = Span(flat.path, entry.line, entry.column, entry.line, entry.column + len(entry.key))
                return OwnText(unquoted(entry.value), span, flat.is_as_written(key))
        return None

    endpoints = {name: first(*connections.endpoints(name)) for name in adapters(linked)}
    endpoints |= {f"{one.name}Topic": first(*connections.topic_endpoints(one.name)) for one in linked.subscribes}
    proxies = {one.name: first(*connections.proxy(one.name)) for one in linked.requires}
    return OwnAddresses(
        {name: text for name, text in endpoints.items() if text is not None},
        {name: text for name, text in proxies.items() if text is not None},
        first(*connections.MANAGER),
    )


def adapters(linked: LinkedComponent) -> list[str]:
    """The names of the adapters of a component."""
    return list(dict.fromkeys([*(use.name for use in linked.component.implements), COMMON_BEHAVIOR]))
