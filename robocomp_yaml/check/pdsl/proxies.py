"""Proxies and endpoints in a component's own configuration that Ice accepts, but that cannot work."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.addresses import impossible_proxies
from robocomp_yaml.addresses.own import MANAGER, OwnAddresses, adapters, of_flat, of_values
from robocomp_yaml.addresses.own_configuration import own_configuration
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import likeness
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port, Program
from robocomp_yaml.network.network import is_loopback
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint
from robocomp_yaml.source.ice_properties import PREFIX
from robocomp_yaml.source.ice_proxy import Proxy, proxy_at
from robocomp_yaml.source.tree import Mapping, Scalar

_NEAR = 0.75  # similarity of an identity that is surely misspelled
_LOCATOR = "Default.Locator"


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in sorted(program.values.values(), key=lambda values: values.document.path):
        yield from of_document(linked, program)


def of_document(linked: LinkedValues, program: Program) -> Iterator[Diagnostic]:
    """What is wrong with the proxies of a document, or of a flat config that was read as one."""
    is_migrated = "legacy" in linked.document.root.entries
    for fault in _faults(linked, program):
        yield fault.as_severity(WARNING) if is_migrated else fault


def _faults(linked: LinkedValues, program: Program) -> Iterator[Diagnostic]:
    component = linked.parameters.component if linked.parameters else None
    yield from _manager(linked)
    yield from _endpoints(linked)
    section = linked.document.root.get("proxies")
    if component is None or component.broken or not isinstance(section, Mapping):
        return
    ports = {port.name: port for port in component.requires}
    for name, node in section.items():
        text = node.get("proxy") if isinstance(node, Mapping) else node
        port = ports.get(name.lexeme)
        proxy = proxy_at(unquoted(text.lexeme)) if isinstance(text, Scalar) else None
        if port is None or text is None or proxy is None:
            continue
        expected = port.interface.name.lower()
        yield from _identity(proxy, port, text.span, program)
        is_plain = proxy.endpoints or proxy.adapter or _has_locator(linked)
        if problem := impossible_proxies.problem(proxy, port.interface, needs_endpoint=not is_plain):
            hint = f'such as "{expected}:tcp -h localhost -p 10002"'
            yield codes.IMPOSSIBLE_PROXY.at(text.span, port=port.name, problem=problem, hint=hint)


def _manager(linked: LinkedValues) -> Iterator[Diagnostic]:
    """The proxy of IceStorm's topic manager."""
    topics = linked.document.root.get("topics")
    text = topics.get("manager") if isinstance(topics, Mapping) else None
    proxy = proxy_at(unquoted(text.lexeme)) if isinstance(text, Scalar) else None
    if text is None or proxy is None:
        return
    name = MANAGER.partition(":")[0]
    if problem := impossible_proxies.problem(proxy):
        hint = f'such as "{name}:tcp -h localhost -p 9999"'
        yield codes.IMPOSSIBLE_PROXY.at(text.span, port="the topic manager", problem=problem, hint=hint)
    if proxy.name != name.rpartition("/")[2] and likeness(proxy.name, name.rpartition("/")[2]) >= _NEAR:
        where = f"an IceStorm serves its topic manager as '{name}'"
        other = codes.OTHER_IDENTITY.at(
            text.span, port="the topic manager", identity=proxy.identity, where=where, hint=f"write {name}"
        )
        yield other.as_severity(WARNING)


def _endpoints(linked: LinkedValues) -> Iterator[Diagnostic]:
    """Endpoints at which an adapter cannot listen: an impossible address, or the TCP port of another one."""
    section, seen = linked.document.root.get("endpoints"), dict[tuple[str, str, int], str]()
    for name, node in section.items() if isinstance(section, Mapping) else ():
        endpoint = parse_endpoint(unquoted(node.lexeme)) if isinstance(node, Scalar) else None
        if endpoint is None:
            continue
        problem = impossible_proxies.wrong_address(endpoint)
        other = seen.setdefault((endpoint.protocol, endpoint.host, endpoint.port), name.lexeme)
        if other != name.lexeme and endpoint.port:
            problem = f"{other} has the same port, {endpoint.port}"
        if problem:
            yield codes.IMPOSSIBLE_ENDPOINT.at(node.span, name=name.lexeme, problem=problem)


def _identity(proxy: Proxy, port: Port, span: Span, program: Program) -> Iterator[Diagnostic]:
    """The identity of an object that is not the one of the interface: rcyaml and RoboComp make it of the name."""
    interface = port.interface.name
    expected = interface.lower()
    if proxy.identity == expected:
        return
    numbers = {endpoint.port for endpoint in proxy.endpoints}
    owner = next((one for at, name, one in served(program) if at.port in numbers and name == interface), None)
    if owner is None and likeness(proxy.identity, expected) < _NEAR and not _is_local(proxy, port, program):
        return  # a foreign server may have any
    where = f"{owner.component.name} serves {interface} there" if owner else f"components serve {interface}"
    other = codes.OTHER_IDENTITY.at(
        span, port=port.name, identity=proxy.identity, where=f"{where} as '{expected}'", hint=f"write {expected}"
    )
    yield other if owner else other.as_severity(WARNING)


def _is_local(proxy: Proxy, port: Port, program: Program) -> bool:
    """Whether a proxy leads to this machine, and another component of the program serves the interface."""
    if not proxy.endpoints or not all(not one.host or is_loopback(one.host) for one in proxy.endpoints):
        return False
    every = (served for linked in program.components.values() for served in linked.implements)
    return any(served.interface.name == port.interface.name for served in every)


def served(program: Program) -> Iterator[tuple[IceEndpoint, str, LinkedComponent]]:
    """The endpoints that components' own configurations set, with the interfaces there."""
    for linked in sorted(program.components.values(), key=lambda one: one.component.path):
        own = own_configuration(linked, program)
        found = OwnAddresses()
        if own.values is not None:
            found = of_values(own.values)
        elif own.flat is not None:
            found = of_flat(own.flat, linked)
        for name in adapters(linked):
            text = found.endpoints.get(name)
            endpoint = parse_endpoint(text.text) if text is not None else None
            if endpoint is not None:
                yield endpoint, name, linked


def _has_locator(linked: LinkedValues) -> bool:
    """Whether Ice looks up objects without an address."""
    every = (layer.document.root for layer in linked.layers())
    names = {key for root in every for section in ("ice", "properties") for key in _keys(root.get(section))}
    return bool({_LOCATOR, f"{PREFIX}{_LOCATOR}"} & names)


def _keys(section: object) -> Iterator[str]:
    yield from section.entries if isinstance(section, Mapping) else ()
