"""Proxies that Ice accepts, and with which no call can succeed."""

from __future__ import annotations

from robocomp_yaml.model.interface import Interface
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.ice_endpoint import IceEndpoint
from robocomp_yaml.source.ice_proxy import Proxy

_FOUR = pattern(r"(\d+)\.(\d+)\.(\d+)\.(\d+)\Z")
_ONE_WAY = {"o": "-o", "O": "-O", "d": "-d", "D": "-D"}


def problem(proxy: Proxy, interface: Interface | None = None, *, needs_endpoint: bool = False) -> str:
    """Why calls of the interface cannot succeed; '' if they may. `needs_endpoint`: nothing looks up objects by name."""
    if needs_endpoint and not proxy.endpoints and not proxy.adapter:
        return "it has no address, and no locator is configured"
    if proxy.endpoints and all(map(_of_endpoint, proxy.endpoints)):
        return _of_endpoint(proxy.endpoints[0])
    one_way = next((_ONE_WAY[letter] for letter in proxy.options if letter in _ONE_WAY), "")
    answering = next((one.name for one in interface.methods if one.returns or one.outputs), "") if interface else ""
    if one_way and answering:
        return f"{one_way} allows no answer, and {answering} has one"
    if proxy.endpoints and not one_way and all(one.protocol == "udp" for one in proxy.endpoints):
        return "udp carries no answers"
    return ""


def _of_endpoint(endpoint: IceEndpoint) -> str:
    if endpoint.protocol in ("tcp", "ssl", "ws", "wss", "default", "udp") and not endpoint.port:
        return "it has no TCP port"
    return wrong_address(endpoint)


def wrong_address(endpoint: IceEndpoint) -> str:
    """What is wrong with a host that looks like an IP address."""
    found = _FOUR.match(endpoint.host)
    if found and any(int(number) > 255 for number in found.groups()):
        return f"'{endpoint.host}' is not an IP address"
    return ""
