"""Endpoints as Ice spells them: `tcp -h 10.0.0.2 -p 10001`."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.source import properties

_ENDPOINT = r"\s*(tcp|udp|ssl|ws|wss|default)\b((?:\"[^\"]*\"|[^:\"])*)"
_OPTION = r"-(\w)\s+(\"[^\"]*\"|\S+)"


class IceEndpoint(msgspec.Struct, frozen=True):
    """Where an adapter listens: the first endpoint of its property. `host` is '' for all interfaces."""

    port: int
    protocol: str = "tcp"
    host: str = ""

    def reached_at(self, address: str) -> str:
        """The same for a proxy, whose component runs at `address`."""
        return f"{self.protocol} -h {spelled_host(self.host or address)} -p {self.port}"


def spelled_host(address: str) -> str:
    """A colon ends an endpoint, so an IPv6 address stands in quotes."""
    return f'"{address}"' if ":" in address else address


def parse_endpoint(value: str) -> IceEndpoint | None:
    """The first endpoint of a property with a fixed port."""
    match = re.match(_ENDPOINT, properties.unquoted(value))
    if not match:
        return None
    options = dict(re.findall(_OPTION, match[2]))
    port = options.get("p", "")
    if not port.isascii() or not port.isdigit() or not 0 < int(port) < 65536:
        return None
    host = options.get("h", "").strip('"')
    return IceEndpoint(int(port), match[1], "" if host in ("*", "0.0.0.0", "::") else host)
