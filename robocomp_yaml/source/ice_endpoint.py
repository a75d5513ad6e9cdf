"""Endpoints, read as Ice 3.7 reads them: `tcp -h 10.0.0.2 -p 10001`, several with colons between them.

What Ice takes is taken and what it refuses is refused, oddities and all: of two `-p` the last counts, `-timeout 5` is
`-t 5`. Protocols of plug-ins (ssl, wss, bt) are known: whether a program loads them is its own business.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

import msgspec

from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_options import BLANKS, PROTOCOLS, Refused, words_of

_EVERYWHERE = ("*", "0.0.0.0", "::")
_USUAL = ("tcp", "ssl", "udp", "ws", "wss", "default")  # those that a misspelled protocol may mean


class IceEndpoint(msgspec.Struct, frozen=True):
    """One endpoint. `host` is '' for all interfaces, or where none is given; `port` is 0 for any. `options` are those
    but host and port, as they are spelled."""

    port: int
    protocol: str = "tcp"
    host: str = ""
    options: str = ""

    def reached_at(self, address: str) -> str:
        """The same for a proxy, whose component runs at `address`."""
        return f"{self.protocol} -h {spelled_host(self.host or address)} -p {self.port}"


def spelled_host(address: str) -> str:
    """A colon ends an endpoint, and a blank an option, so an IPv6 address stands in quotes."""
    return f'"{address}"' if re.search(f"[{BLANKS}:']", address) else address


@lru_cache(4096)
def parse_endpoints(text: str) -> tuple[IceEndpoint, ...]:
    """What an object adapter listens at. Raises Refused."""
    found: list[IceEndpoint] = []
    end = 0
    while end < len(text):
        start = _after_blanks(text, end)
        if start == len(text) and not found:
            break
        end = _next_colon(text, start)
        if start == end:
            raise Refused("an endpoint is missing at a colon", max(start - 1, 0), max(start, 1))
        found.append(read_endpoint(text, start, end, for_adapter=True))
        end += 1
    return tuple(found)


def fixed_endpoint(text: str) -> IceEndpoint:
    """The first endpoint of an adapter, with a port that others can be told. Raises Refused."""
    found = parse_endpoints(text)
    if not found:
        raise Refused("it holds no endpoint", 0, len(text))
    if not found[0].port:
        raise Refused("it has no fixed port", 0, len(text))
    return found[0]


def parse_endpoint(text: str) -> IceEndpoint | None:
    """The same of a property, whose value may stand in quotes; None where there is none."""
    try:
        return fixed_endpoint(unquoted(text))
    except Refused:
        return None


def segments(text: str, colon: int) -> Iterator[tuple[int, int]]:
    """Where the endpoints of a proxy begin and end, the first one behind the colon."""
    end = colon
    while end < len(text):
        start, end = end + 1, _next_colon(text, end + 1)
        yield start, end


def _next_colon(text: str, start: int) -> int:
    """The next colon that stands in no double quotes; a quote that nothing closes hides none."""
    at, colon = start, -1
    while True:
        if colon < at:
            colon = text.find(":", at)
        opened = text.find('"', at, max(colon, at))
        closed = text.find('"', opened + 1) if opened >= 0 else -1
        if colon < 0:
            return len(text)
        if closed < 0:
            return colon
        at = closed + 1


def _after_blanks(text: str, start: int) -> int:
    while start < len(text) and text[start] in BLANKS:
        start += 1
    return start


class UnknownProtocol(Refused):
    """Which Ice passes over in a proxy that has other endpoints."""


def read_endpoint(text: str, start: int, end: int, *, for_adapter: bool) -> IceEndpoint:
    """The endpoint that stands there. Raises Refused."""
    words = words_of(text, start, end)
    if not words:
        raise Refused("an endpoint is missing behind the colon", max(start - 1, 0), max(end, start))
    protocol, options = words[0].text, words[1:]
    if protocol not in PROTOCOLS:
        raise UnknownProtocol(f"there is no protocol '{protocol}'", words[0].start, words[0].end, _USUAL)
    made = PROTOCOLS[protocol](protocol, for_adapter)
    options = made.take(options, made.is_known)
    if protocol in ("ws", "wss"):  # which reads what TCP leaves
        options = made.take(options, made.is_resource)
    if options:
        taken = f"{protocol} takes {_listed(made.takes)}"
        problem = f"'{options[0].text}' is no option of {protocol}"
        raise Refused(f"{problem}; {taken}", options[0].start, options[0].end, tuple(made.takes))
    made.finish(words[0])
    rest = " ".join(text[first.start : last.end] for first, last in made.others)
    host = "" if made.host in _EVERYWHERE else made.host
    return IceEndpoint(made.port, protocol, host, rest)


def _listed(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"
