"""What a manager accepts and a deployment does not: endpoints that several nodes name, nodes that wait for each other,
and interfaces that several nodes serve. A manager only pings endpoints, and reads no configuration."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.digraph import reachable
from robocomp_yaml.legacy.networks.components import KnownComponent
from robocomp_yaml.legacy.networks.node import NetworkNode
from robocomp_yaml.legacy.networks.served import ConfigAddresses
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.rcremote import LOCAL, LOOPBACK

_NOTHING = ConfigAddresses()


def host_of(node: NetworkNode) -> str:
    """Return the address on which a node is started; LOCAL for this host."""
    host = node.command.host if node.command is not None else LOCAL
    return LOCAL if host in LOOPBACK else host


class Processes(msgspec.Struct, eq=False):
    """The nodes of a network that are started. `owners` are the first nodes of their processes, by the names of the
    others; `components` and `configured` are by the names of first nodes."""

    running: Sequence[NetworkNode]
    owners: Mapping[str, NetworkNode]
    components: Mapping[str, KnownComponent]
    configured: Mapping[str, ConfigAddresses]

    def owner(self, node: NetworkNode) -> NetworkNode:
        return self.owners.get(node.name, node)

    def find_pinged(self) -> Iterator[Diagnostic]:
        """Mark the nodes whose endpoint is only pinged: it is on another host than the process, or a port that another
        process has, or that this one serves as something else."""
        serving: dict[tuple[str, int], tuple[str, str]] = {}  # the name and the interface in lower case
        for name, config in self.configured.items():
            host = next(host_of(node) for node in self.running if node.name == name)
            for interface, port in config.ports.items():
                serving.setdefault((host, port), (name, interface))
        named: set[tuple[str, int]] = set()
        for node in self.running:
            endpoint = node.endpoint
            if endpoint is None or endpoint.is_storm:
                continue
            host = LOCAL if endpoint.host in LOOPBACK else endpoint.host
            if host and host != host_of(node):
                node.is_only_pinged, node.elsewhere = True, endpoint.host
                continue
            owner = self.owner(node).name
            mine = (owner, endpoint.identity.lower())
            other = serving.setdefault((host_of(node), endpoint.port), mine)
            if (host_of(node), endpoint.port) in named and other == mine:
                node.is_only_pinged = True  # by its other name
                continue
            named.add((host_of(node), endpoint.port))
            is_same = other[0] == owner and other[1].removesuffix("comp") == mine[1].removesuffix("comp")
            if not is_same and (other[0] != owner or self.is_known(owner, node)):
                node.is_only_pinged = True
                yield codes.ONLY_PINGED.at(
                    node.endpoint_span, name=node.alias, port=endpoint.port, other=other[0], interface=other[1]
                )

    def is_known(self, owner: str, node: NetworkNode) -> bool:
        """Whether the configuration of a component says under another name what the endpoint's port serves."""
        names = [name for name, port in self.configured.get(owner, _NOTHING).ports.items()
                 if node.endpoint is not None and port == node.endpoint.port]  # fmt: skip
        served = [name.lower() for name in (*self.components[owner].implements, "CommonBehavior")] if names else []
        return any(name.removesuffix("comp") in served for name in names)

    def connections(self, node: NetworkNode, depends: Sequence[NetworkNode]) -> tuple[dict[str, str], list[Diagnostic]]:
        """Return what `connect:` says of a component: the node that it depends on, else the one at the address of its
        configuration; and the guesses."""
        component = self.components[node.name]
        config = self.configured.get(node.name, _NOTHING)
        connect: dict[str, str] = {}
        guesses: list[Diagnostic] = []
        for proxy, interface in component.requires.items():
            serving = [other for other in depends if other.interface.lower() == interface.lower()]
            text = config.proxy(proxy, interface)
            if len(serving) == 1 and not serving[0].is_only_pinged:
                connect[proxy] = serving[0].name
            elif len(serving) == 1 and serving[0].endpoint is not None:
                connect[proxy] = text or serving[0].endpoint.proxy(serving[0].elsewhere or host_of(serving[0]))
            elif len(candidates := self.candidates(node, interface)) > 1:
                target = self.at(text, candidates)
                connect[proxy] = target or text or self.named(candidates[0])
                if not target and not text:
                    guesses.append(codes.GUESSED_SERVER.at(
                        node.span, name=node.alias, interface=interface, target=candidates[0].name,
                    ))  # fmt: skip
            elif not candidates and (text := config.misspelled(proxy)):
                connect[proxy] = text
        return connect, guesses

    def candidates(self, node: NetworkNode, interface: str) -> list[NetworkNode]:
        """Return the nodes, other than this one, whose process serves an interface."""
        found = []
        for other in self.running:
            component = self.components.get(other.name)
            serves = component is not None and interface in component.implements
            is_pinged = other.endpoint is not None and other.interface.lower() == interface.lower()
            if other is not node and (serves or (is_pinged and component is None and not other.is_only_pinged)):
                found.append(other)
        return found

    def at(self, text: str, candidates: Sequence[NetworkNode]) -> str:
        """Return the name of the only candidate with the port of a proxy that is not a second name; or ''."""
        proxy = proxy_at(text)
        ports = {one.port for one in proxy.endpoints} if proxy is not None else set()
        at = [
            node.name for node in candidates
            if (node.endpoint is not None and node.endpoint.port in ports)
            or ports & set(self.configured.get(node.name, _NOTHING).ports.values())
        ]  # fmt: skip
        return at[0] if len(at) == 1 and at[0] not in self.owners and not self.has_aliases(at[0]) else ""

    def named(self, node: NetworkNode) -> str:
        """Return a node's name, or its proxy if the name does not tell which of a process's endpoints it is."""
        if node.endpoint is None or (node.name not in self.owners and not self.has_aliases(node.name)):
            return node.name
        return node.endpoint.proxy(host_of(node))

    def address_of(self, nodes: Sequence[NetworkNode]) -> str:
        """Return the host in the configurations' proxies to the ports of these nodes, if it is one; or ''."""
        ports = {node.endpoint.port for node in nodes if node.endpoint is not None}
        remote = {host_of(node) for node in self.running}
        found: set[str] = set()
        for config in self.configured.values():
            for text in config.proxies.values():
                proxy = proxy_at(text)
                for one in proxy.endpoints if proxy is not None else ():
                    if one.port in ports and one.host and one.host not in LOOPBACK | remote:
                        found.add(one.host)
        return found.pop() if len(found) == 1 else ""

    def has_aliases(self, name: str) -> bool:
        return any(owner.name == name for owner in self.owners.values())


def without_circles(waits: Mapping[str, Sequence[str]]) -> tuple[dict[str, list[str]], list[tuple[str, str]]]:
    """Return the waits without those that close a circle, and these."""
    kept: dict[str, list[str]] = {name: [] for name in waits}
    dropped: list[tuple[str, str]] = []
    for name, targets in waits.items():
        for target in targets:
            if target == name or name in reachable(kept.get(target, ()), lambda one: kept.get(one, ())):
                dropped.append((name, target))
            else:
                kept[name].append(target)
    return kept, dropped
