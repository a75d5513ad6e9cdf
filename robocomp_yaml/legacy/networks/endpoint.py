"""Where a node answers: an Ice proxy such as `laser:tcp -h localhost -p 10003`."""

from __future__ import annotations

import re

import msgspec

TOPIC_MANAGER = "IceStorm/TopicManager"
_PROXY = re.compile(r"\s*(?P<identity>[^\s:@]+)\s*:\s*(?P<protocol>tcp|udp|ssl|default|ws|wss)\b(?P<options>[^:]*)")
_OPTION = re.compile(r"-(?P<name>\w+)(?:\s+(?P<value>[^\s-]\S*))?")


class Endpoint(msgspec.Struct, frozen=True):
    """`options` are those but host and port, as they are spelled."""

    identity: str
    protocol: str
    port: int
    host: str = ""
    options: str = ""

    @property
    def text(self) -> str:
        """What the adapter listens at: at every address of its host."""
        more = f" {self.options}" if self.options else ""
        return f"{self.protocol} -p {self.port}{more}"

    @property
    def is_storm(self) -> bool:
        return self.identity == TOPIC_MANAGER

    def proxy(self, host: str) -> str:
        """How others on any host find it: the spelling that needs not be kept."""
        more = f" {self.options}" if self.options else ""
        return f"{self.identity}:{self.protocol} -h {host} -p {self.port}{more}"


def parse(text: str) -> Endpoint | None:
    """None for what is no proxy with one address, or names no port."""
    found = _PROXY.fullmatch(text)
    if found is None:
        return None
    host, port, more = "", "", list[str]()
    for option in _OPTION.finditer(found["options"]):
        value = option["value"] or ""
        match option["name"]:
            case "h":
                host = value
            case "p":
                port = value
            case _:
                more.append(option[0])
    if not re.fullmatch(r"[0-9]{1,5}", port) or not 0 < int(port) < 65536:
        return None
    return Endpoint(found["identity"], found["protocol"], int(port), host, " ".join(more))
