"""Of two processes on one machine, only one can listen on a port."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.network.network import LOOPBACK, Endpoint, Network, Process, is_loopback
from robocomp_yaml.source.ice_endpoint import parse_endpoint


def check(network: Network) -> Iterator[Diagnostic]:
    seen: dict[tuple[str, bool, int], list[tuple[str, Process, Endpoint]]] = {}
    named = {name for name, host in network.hosts.items() if host.span.file}
    for process in network.enabled():
        if named and process.host not in named:
            continue  # its host is not known, which has been told
        machine = _machine(network.address(process))
        for endpoint in process.endpoints:
            if not endpoint.port:
                continue
            parsed = parse_endpoint(endpoint.text)
            bound = _machine(parsed.host, keep=True) if parsed and parsed.host else ""
            others = seen.setdefault((machine, endpoint.protocol == "udp", endpoint.port), [])
            for host, other, served in others:
                if not host or not bound or host == bound:
                    yield codes.PORT_CONFLICT.at(
                        endpoint.span,
                        port=endpoint.port,
                        name=_name(process, endpoint),
                        other=_name(other, served),
                        host=f"host '{process.host}'" if network.hosts[process.host].span.file else "this machine",
                        hint=_mend(process, endpoint, served),
                        related=[Related(f"{_name(other, served)} has it, too", served.span)],
                    )
                    break
            others.append((bound, process, endpoint))


def _mend(process: Process, endpoint: Endpoint, other: Endpoint) -> str:
    if endpoint.span != other.span:
        return "give one of them another port"
    if process.component:
        return "leave the port out, and each of them gets one of its own"
    return f"give each one of its own; {{i}} counts instances: `-p {endpoint.port // 10}{{i}}`"


def _machine(address: str, *, keep: bool = False) -> str:
    """All loopback addresses lead to one machine; with `keep`, they are told apart."""
    if address in (LOOPBACK, "127.0.0.1", "::1") or (is_loopback(address) and not keep):
        return LOOPBACK
    return address


def _name(process: Process, endpoint: Endpoint) -> str:
    return f"'{process.name}' ({endpoint.interface})"
