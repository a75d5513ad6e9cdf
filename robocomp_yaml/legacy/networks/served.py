"""What the configuration of a component says about addresses: ports that it serves, and proxies that it uses."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.legacy.networks.components import KnownComponent
from robocomp_yaml.source import properties
from robocomp_yaml.source.ice_endpoint import parse_endpoint
from robocomp_yaml.source.ice_proxy import Proxy, proxy_at
from robocomp_yaml.source.rcremote import NodeCommand
from robocomp_yaml.source.regular import text as text_of

OWN = "etc/config"


class ConfigAddresses(msgspec.Struct, frozen=True):
    """`ports` are those of the adapters by the adapter's name; `proxies` are texts by the proxy's name, both in lower
    case. `keys` are all properties as they are spelled."""

    ports: Mapping[str, int] = {}
    proxies: Mapping[str, str] = {}
    keys: frozenset[str] = frozenset()

    def proxy(self, name: str, interface: str) -> str:
        """The proxy of a required interface: by its name (older tools count from 0), else the only one to an object
        of the interface; or ''."""
        if found := self.proxies.get(name.lower()) or self.proxies.get(f"{name.lower()}0"):
            return found
        same = {text for text in self.proxies.values() if (proxy_at(text) or _NONE).identity == interface.lower()}
        return same.pop() if len(same) == 1 else ""

    def misspelled(self, name: str) -> str:
        """The text of a proxy whose key differs from the expected one only in case, so that components do not read it;
        or ''."""
        key = f"{name}Proxy"
        other = next((each for each in self.keys if each.lower() == key.lower()), key)
        return self.proxies.get(name.lower(), "") if key not in self.keys and other != key else ""


_NONE = Proxy("", "", "")


def is_missing(command: NodeCommand, component: KnownComponent, sources: str) -> bool:
    """Whether the configuration that a command passes to a component is not in the repository."""
    home = os.path.dirname(component.path) or "."
    return bool(command.config) and not any(
        os.path.isfile(path) for path in candidates(command.config, command.folder, home, sources)
    )


def addresses(command: NodeCommand, component: KnownComponent, sources: str) -> ConfigAddresses:
    """Return what the configuration says that a command passes to a component, else the component's own; empty if it is
    missing."""
    home = os.path.dirname(component.path) or "."
    name = command.config or OWN
    for path in candidates(name, command.folder, home, sources):
        if os.path.isfile(path):
            return _read(text_of(path) or "")
    return ConfigAddresses()


def candidates(name: str, folder: str, home: str, sources: str) -> Iterator[str]:
    """Yield where a configuration of another machine may be here: in the component's folder, or at the tail of its path
    in the repository."""
    below = relative_to(name, folder, home)
    if below:
        yield os.path.join(home, below)
    for tail in _tails(posixpath.join(folder, name)):
        yield os.path.join(sources, tail)


def relative_to(path: str, folder: str, home: str) -> str:
    """Return a path of the machine that the legacy file describes, relative to the component's folder; '' where it is
    not below."""
    if not posixpath.isabs(path) and not path.startswith("~"):
        path = posixpath.join(folder, path)
    name = os.path.basename(os.path.abspath(home))
    _, separator, inner = posixpath.normpath(path).rpartition(f"/{name}/")
    return inner if separator else ""


def _tails(path: str) -> Iterator[str]:
    """Yield the ends of a path of another machine, with two names at least, the longest first."""
    names = [name for name in posixpath.normpath(path).split("/") if name]
    yield from ("/".join(names[n:]) for n in range(len(names) - 1))


def _read(text: str) -> ConfigAddresses:
    ports: dict[str, int] = {}
    proxies: dict[str, str] = {}
    values = properties.read(text).values
    for key, value in values.items():
        plain = value[1:-1] if len(value) > 1 and value[0] == value[-1] == '"' else value
        name = key.lower()
        if name.endswith(".endpoints") or name.startswith("endpoints."):
            endpoint = parse_endpoint(plain)
            if endpoint is not None and endpoint.port:
                ports[name.removesuffix(".endpoints").removeprefix("endpoints.")] = endpoint.port
        elif (proxy := proxy_at(plain)) is not None and proxy.endpoints:
            proxies[name.removeprefix("proxies.").removesuffix("proxy").rstrip(".")] = plain
    return ConfigAddresses(ports, proxies, frozenset(values))
