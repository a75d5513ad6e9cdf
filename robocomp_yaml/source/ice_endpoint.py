"""Parses endpoints as Ice 3.7 does: `tcp -h 10.0.0.2 -p 10001`, several separated by colons.

This module accepts and rejects exactly what Ice does, in special cases, too: the last of two `-p` is used, `-timeout 5`
is `-t 5`. The protocols of Ice's plug-ins (ssl, wss, bt) are accepted; a program must load the plug-in.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

import msgspec

from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_options import BLANKS, PROTOCOLS, InvalidIceText, after_blanks, words_of

_EVERYWHERE = ("*", "0.0.0.0", "::")
_SECURED = {"tcp": "ssl", "default": "ssl", "ws": "wss"}
_USUAL = ("tcp", "ssl", "udp", "ws", "wss", "default")  # suggested for an unknown protocol


class IceEndpoint(msgspec.Struct, frozen=True):
    """One endpoint. `host` is '' for all network interfaces, or if absent; `port` is 0 for any port. `options` are all
    others, as written."""

    port: int
    protocol: str = "tcp"
    host: str = ""
    options: str = ""

    def reached_at(self, address: str) -> str:
        """The endpoint for a proxy to a component at `address`."""
        return f"{self.protocol} -h {spelled_host(self.host or address)} -p {self.port}"


@lru_cache(1 << 10)
def spelled_host(address: str) -> str:
    """The address as an option's value: an IPv6 address in quotes, because a colon would end the endpoint."""
    return f'"{address}"' if re.search(f"[{BLANKS}:']", address) else address


@lru_cache(4096)
def parse_endpoints(text: str) -> tuple[IceEndpoint, ...]:
    """The endpoints of an object adapter. Raises InvalidIceText."""
    endpoints: list[IceEndpoint] = []
    end = 0
    while end < len(text):
        start = after_blanks(text, end)
        if start == len(text) and not endpoints:
            break
        end = _next_colon(text, start)
        if start == end:
            raise InvalidIceText("an endpoint is missing at a colon", max(start - 1, 0), max(start, 1))
        endpoints.append(read_endpoint(text, start, end, for_adapter=True))
        end += 1
    return tuple(endpoints)


def completed(text: str, addresses: tuple[str, ...], protocol: str) -> str:
    """Endpoints of an adapter, in which each that names no host gets these `addresses`; with none of them it listens on
    all. With the `protocol` ssl, those over TCP become secure. Unchanged if the text is not valid."""
    try:
        parse_endpoints(text)
    except InvalidIceText:
        return text.strip(BLANKS)
    made: list[str] = []
    end = 0
    while end < len(text) and after_blanks(text, end) < len(text):
        start = after_blanks(text, end)
        end = _next_colon(text, start)
        kind, *options = words_of(text, start, end)
        name = _SECURED.get(kind.text, kind.text) if protocol == "ssl" else kind.text
        rest = text[kind.end : end].strip(BLANKS)
        hosts = [""] if any(one.text == "-h" for one in options) or not addresses else addresses
        made += [" ".join(filter(None, (name, f"-h {spelled_host(one)}" if one else "", rest))) for one in hosts]
        end += 1
    return ":".join(made)


def fixed_endpoint(text: str) -> IceEndpoint:
    """The first endpoint of an adapter, which must have a fixed port. Raises InvalidIceText."""
    endpoints = parse_endpoints(text)
    if not endpoints:
        raise InvalidIceText("it contains no endpoint", 0, len(text))
    if not endpoints[0].port:
        raise InvalidIceText("it has no fixed port", 0, len(text))
    return endpoints[0]


@lru_cache(1 << 14)
def parse_endpoint(text: str) -> IceEndpoint | None:
    """The first endpoint in a property's value, which may be in quotes; None if it is invalid or has no fixed port."""
    try:
        return fixed_endpoint(unquoted(text))
    except InvalidIceText:
        return None


def segments(text: str, colon: int) -> Iterator[tuple[int, int]]:
    """The start and end indices of a proxy's endpoints; the first one follows the colon."""
    end = colon
    while end < len(text):
        start, end = end + 1, _next_colon(text, end + 1)
        yield start, end


def _next_colon(text: str, start: int) -> int:
    """The index of the next colon outside of double quotes; an unclosed quote is ignored."""
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


class UnknownProtocol(InvalidIceText):
    """Ice ignores such an endpoint if the proxy has others."""


def read_endpoint(text: str, start: int, end: int, *, for_adapter: bool) -> IceEndpoint:
    """The endpoint in text[start:end]. Raises InvalidIceText."""
    words = words_of(text, start, end)
    if not words:
        raise InvalidIceText("an endpoint is missing after the colon", max(start - 1, 0), max(end, start))
    protocol, options = words[0].text, words[1:]
    if protocol not in PROTOCOLS:
        raise UnknownProtocol(f"unknown protocol '{protocol}'", words[0].start, words[0].end, _USUAL)
    parser = PROTOCOLS[protocol](protocol, for_adapter)
    options = parser.read(options, parser.is_known)
    if protocol in ("ws", "wss"):  # as in Ice, web sockets read the options that TCP does not know
        options = parser.read(options, parser.is_resource)
    if options:
        problem = f"{protocol} has no option '{options[0].text}', only {_listed(parser.accepted)}"
        raise InvalidIceText(problem, options[0].start, options[0].end, tuple(parser.accepted))
    parser.finish(words[0])
    rest = " ".join(text[first.start : last.end] for first, last in parser.others)
    host = "" if parser.host in _EVERYWHERE else parser.host
    return IceEndpoint(parser.port, protocol, host, rest)


def _listed(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"
