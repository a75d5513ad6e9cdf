"""Where a node answers: an Ice proxy such as `laser:tcp -h localhost -p 10003`."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.source.ice_endpoint import spelled_host
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.text import OF_NO_LINE

TOPIC_MANAGER = "IceStorm/TopicManager"
_INTERFACE = re.compile(r"[_A-Za-z][A-Za-z0-9_]*(\.[A-Za-z0-9_]+)?")  # a key of `endpoints:`
_PROTOCOLS = frozenset(("tcp", "udp", "ssl", "default", "ws", "wss"))


class NodeEndpoint(msgspec.Struct, frozen=True):
    """`options` are those but host and port, as they are spelled."""

    identity: str
    protocol: str
    port: int
    host: str = ""
    options: str = ""

    @property
    def text(self) -> str:
        """What the adapter listens at: at every address of its host."""
        return f"{self.protocol} -p {self.port} {self.options}".rstrip()

    @property
    def is_storm(self) -> bool:
        return self.identity == TOPIC_MANAGER

    def proxy(self, host: str) -> str:
        """How others on any host find it: the spelling that needs not be kept."""
        return f"{self.identity}:{self.protocol} -h {spelled_host(host)} -p {self.port} {self.options}".rstrip()


def parse(text: str) -> NodeEndpoint | None:
    """None for what is no proxy with one address, names no port, or has an identity that no interface can have."""
    found = proxy_at(text)
    if found is None or found.options or found.unknown or len(found.endpoints) != 1:
        return None
    where = found.endpoints[0]
    is_name = found.identity == TOPIC_MANAGER or _INTERFACE.fullmatch(found.identity)
    if not is_name or where.protocol not in _PROTOCOLS or not where.port:
        return None
    if "--sourceAddress" in where.options or OF_NO_LINE.search(where.options):  # nothing that an adapter can have
        return None
    return NodeEndpoint(found.identity, where.protocol, where.port, where.host, where.options)
