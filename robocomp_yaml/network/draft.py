"""Drafts of processes, from which a network is derived step by step: each instance and each IceStorm on its host, with
what it serves, its TCP ports, and what its configuration gets."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.addresses.own import OwnAddresses
from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm
from robocomp_yaml.link.program import Port
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.model import deployment as model
from robocomp_yaml.network.configuration_base import ConfigurationBase, base_of
from robocomp_yaml.network.listening import SSL, TCP, Listening, listening
from robocomp_yaml.network.network import LOOPBACK, Endpoint, NetworkHost, SshAccess
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint, spelled_host
from robocomp_yaml.source.ice_options import BLANKS, InvalidIceText

MANAGER, PUBLISH = "TopicManager", "Publish"
STORM_INSTANCE = "IceStorm"

_ANY_TEXT = "for any other text to a program that does not use Ice, use `args:` or `env:`"


class Offer(msgspec.Struct, eq=False):
    """An interface that a draft serves on the adapter `adapter`. `port` is the entry of the component's `implements`,
    None for an endpoint of a program and for CommonBehavior, of which only the name is known. `explicit` is the
    endpoint in a document; without one, `number` is its TCP port, 0 until it is assigned. `own` is its location in the
    component's own configuration, if that sets it."""

    owner: Draft
    adapter: str
    interface: str
    span: Span
    port: Port | None = None
    number: int = 0
    explicit: str = ""
    own: Span | None = None
    _endpoint: tuple[tuple[object, ...], IceEndpoint | None] = ((), None)

    @property
    def key(self) -> str:
        """As the entry's `ports:` names it."""
        return Endpoint(self.adapter, self.interface.lower(), self.number, "").key

    @property
    def full_name(self) -> str:
        """As `connect:` can name it."""
        return f"{self.owner.name}.{self.adapter}"

    @property
    def endpoint(self) -> IceEndpoint | None:
        """None if the endpoint in the document is not valid."""
        causes = self.number, self.explicit, self.owner.listening
        if self._endpoint[0] != causes:
            self._endpoint = causes, self._made_endpoint()
        return self._endpoint[1]

    def _made_endpoint(self) -> IceEndpoint | None:
        listens = self.owner.listening
        found = IceEndpoint(self.number, self.owner.protocol)
        if self.explicit:
            written, read = parse_endpoint(self.explicit), parse_endpoint(self.text)
            if written is None or read is None:
                return None
            found = replace(written, protocol=read.protocol)
        elsewhere = "" if listens.reached_at == listens.own else listens.reached_at
        return replace(found, host=found.host or elsewhere)

    @property
    def text(self) -> str:
        """The value of the adapter's property."""
        if not self.explicit:
            return self.owner.listening.endpoints(self.number)
        is_ours = self.owner.instance.component is not None
        return self.owner.listening.completed(self.explicit) if is_ours else self.explicit.strip(BLANKS)

    @property
    def published(self) -> str:
        """The value of the property with the endpoints that others get, '' if those are the endpoints themselves."""
        return "" if self.explicit else self.owner.listening.published(self.number)

    @property
    def proxy(self) -> str:
        endpoint = self.endpoint
        assert endpoint is not None
        return f"{self.interface.lower()}:{endpoint.reached_at(self.owner.host.address)}"

    def resolved(self) -> Endpoint:
        endpoint = self.endpoint or IceEndpoint(0)
        module = self.port.scope.module.name if self.port else ""
        if self.port is None and self.interface == COMMON_BEHAVIOR:
            module = f"RoboComp{COMMON_BEHAVIOR}"
        return Endpoint(
            self.adapter,
            self.interface.lower(),
            endpoint.port,
            self.text,
            endpoint.protocol,
            module,
            self.span,
            self.own or Span(""),
        )


class LocatedText(msgspec.Struct, frozen=True):
    """A text for a configuration, and the location in the deployment that it comes from."""

    text: str
    span: Span


class Draft(msgspec.Struct, eq=False):
    """An instance that becomes a process. `aliases` are the entries that are second names of it. `subscribers` are the
    adapters that receive events of topics, if the document sets their ports; no other process needs these. For its
    configuration it has `proxies` (by the proxy's name), `topics` (full names by the port's name), and `manager` (the
    proxy of its IceStorm). `base` is the base of that configuration, and `own` what the base says about addresses.
    `protocol` is that of its endpoints."""

    instance: LinkedInstance
    host: NetworkHost
    aliases: list[LinkedInstance] = []
    offers: list[Offer] = []
    subscribers: list[Offer] = []
    proxies: dict[str, LocatedText] = {}
    topics: dict[str, LocatedText] = {}
    manager: LocatedText | None = None
    base: ConfigurationBase = msgspec.field(default_factory=ConfigurationBase)
    own: OwnAddresses = msgspec.field(default_factory=OwnAddresses)
    protocol: str = TCP
    _listening: Listening | None = None

    @property
    def listening(self) -> Listening:
        if self._listening is None or self._listening.protocol != self.protocol:
            listen = tuple(one.text for one in self.instance.entry.listen)
            self._listening = listening(self.host, listen, self.protocol)
        return self._listening

    @property
    def name(self) -> str:
        return self.instance.name

    @property
    def span(self) -> Span:
        return self.instance.entry.span

    @property
    def adapters(self) -> list[Offer]:
        return [*self.offers, *self.subscribers]


class StormDraft(msgspec.Struct, eq=False):
    """An IceStorm, with the TCP ports of its topic manager and of its publishers."""

    linked: LinkedStorm
    host: NetworkHost
    manager: int = 0
    publish: int = 0
    protocol: str = TCP

    @property
    def listening(self) -> Listening:
        return listening(self.host, protocol=self.protocol)

    @property
    def name(self) -> str:
        return self.linked.name

    @property
    def span(self) -> Span:
        return self.linked.storm.span

    @property
    def proxy(self) -> str:
        address = self.listening.reached_at if self.host.listen else self.host.address
        return f"{STORM_INSTANCE}/{MANAGER}:{self.protocol} -h {spelled_host(address)} -p {self.manager}"

    def endpoints(self) -> tuple[Endpoint, Endpoint]:
        storm = self.linked.storm
        manager = Endpoint(
            MANAGER,
            f"{STORM_INSTANCE}/{MANAGER}",
            self.manager,
            self.listening.endpoints(self.manager),
            self.protocol,
            module="IceStorm",
            span=storm.port_span if storm.port else storm.span,
        )
        span = storm.publish_span if storm.publish else storm.span
        publish = self.listening.endpoints(self.publish)
        return manager, Endpoint(PUBLISH, "", self.publish, publish, self.protocol, span=span)

    def published(self) -> tuple[str, str]:
        """The endpoints that others get, if those are not the endpoints."""
        return self.listening.published(self.manager), self.listening.published(self.publish)


class Drafts(msgspec.Struct):
    """Instances and IceStorms in the documents' order. `complete` is False if something could not be read: then what
    is missing may be in it."""

    linked: LinkedDeployment
    hosts: dict[str, NetworkHost] = {}
    drafts: dict[LinkedInstance, Draft] = {}
    storms: dict[LinkedStorm, StormDraft] = {}
    complete: bool = True

    @property
    def protocol(self) -> str:
        """That of what rcyaml's own programs serve."""
        return SSL if self.linked.deployment.security == model.TLS else TCP

    def of(self, instance: LinkedInstance) -> Draft | None:
        """The draft of an instance's process, also for a second name. None if it has no draft."""
        return self.drafts.get(instance.process or instance)


def drafts_of(linked: LinkedDeployment, disk: Disk) -> Drafts:
    """Drafts of all processes of a deployment, still without ports and connections."""
    result = Drafts(linked, {name: _host(host) for name, host in linked.hosts.items()})
    result.complete = not (linked.broken or any(map(is_broken, linked.groups.values())))
    for storm in linked.storms.values():
        if linked.storm_instead(storm) is not storm:
            continue
        result.storms[storm] = StormDraft(storm, _placed(result.hosts, storm.host), protocol=result.protocol)
        result.complete &= not storm.broken
    for instance in linked.instances.values():
        is_known = instance.component is not None or instance.entry.kind != model.COMPONENT
        result.complete &= is_known and not instance.broken
        if is_known and instance.entry.kind != model.PROCESS:
            base = base_of(instance, disk)
            own = base.addresses(instance.component) if instance.component is not None else OwnAddresses()
            draft = result.drafts[instance] = Draft(instance, _placed(result.hosts, instance.host), base=base, own=own)
            if instance.component is not None and instance.component.component.language.target.has_tls:
                draft.protocol = result.protocol
            draft.offers, draft.subscribers = list(_offers(draft)), list(_subscribers(draft))
            result.complete &= instance.component is None or not instance.component.broken
    for instance in linked.instances.values():
        owner = result.drafts.get(instance.process) if instance.process else None
        if owner is not None:
            owner.aliases.append(instance)
            owner.offers += _endpoints(owner, instance)
    return result


def is_broken(group: LinkedGroup) -> bool:
    """Whether an error in a group has been reported, so that what it serves is unknown."""
    return group.broken or len(group.serves) < len(group.group.exposed)


def _host(host: model.Host) -> NetworkHost:
    """The paths of a host start at the folder of its document; a folder without a name is that of the workspace, else
    of the document."""
    above = os.path.dirname(host.span.file)

    def absolute(path: str) -> str:
        return os.path.abspath(os.path.join(above, os.path.expanduser(path))) if path else ""

    ssh, root = host.ssh, root_above(above)
    folders = (absolute(pair.name) or os.path.abspath(above if root is None else root) for pair in host.paths)
    return NetworkHost(
        host.name,
        host.address.text,
        SshAccess(host.user or ssh.user, ssh.port or 0, absolute(ssh.identity), absolute(ssh.known_hosts), ssh.jump),
        tuple((here, os.path.normpath(pair.text)) for here, pair in zip(folders, host.paths, strict=True)),
        host.python.text if host.python else "",
        host.systemd,
        tuple(one.text for one in host.listen),
        span=host.address.span,
    )


def _placed(hosts: dict[str, NetworkHost], host: model.Host | None) -> NetworkHost:
    if host is not None:
        return hosts.get(host.name) or hosts.setdefault(host.name, _host(host))
    return hosts.setdefault(LOOPBACK, NetworkHost(LOOPBACK))


def _offers(draft: Draft) -> Iterator[Offer]:
    component = draft.instance.component
    if component is None:
        yield from _endpoints(draft, draft.instance)
        return
    endpoints = {pair.name: pair for pair in draft.instance.entry.endpoints}
    served: list[tuple[str, str, Port | None]] = [(p.name, p.interface.name, p) for p in component.implements]
    if all(port.name != COMMON_BEHAVIOR for port in component.implements):
        served.append((COMMON_BEHAVIOR, COMMON_BEHAVIOR, None))
    for name, interface, port in served:
        pair = endpoints.get(name)
        yield Offer(draft, name, interface, pair.span if pair else draft.span, port, explicit=pair.text if pair else "")


def _subscribers(draft: Draft) -> Iterator[Offer]:
    entry, component = draft.instance.entry, draft.instance.component
    endpoints = {pair.name: pair for pair in entry.endpoints}
    fixed = {number.name: number for number in entry.ports}
    for port in component.subscribes if component else ():
        where, adapter = endpoints.get(port.name) or fixed.get(port.name), f"{port.name}Topic"
        own = draft.own.endpoints.get(adapter)
        if where is not None or (own is not None and parse_endpoint(own.text) is not None):
            text = endpoints[port.name].text if port.name in endpoints else ""
            span = where.span if where is not None else draft.span
            yield Offer(draft, adapter, port.interface.name, span, port, explicit=text)


def _endpoints(owner: Draft, instance: LinkedInstance) -> Iterator[Offer]:
    """What a program serves by the `endpoints:` of an entry; a module can qualify the name."""
    for pair in instance.entry.endpoints:
        yield Offer(owner, pair.name, pair.name.rpartition(".")[2], pair.span, explicit=pair.text)


def text_fault(
    code: Code, draft: Draft, span: Span, written: str, refused: InvalidIceText, otherwise: str = "", **facts: Any
) -> Diagnostic:
    """What Ice would reject in a text of the document, with its location. `otherwise` is the hint without a suggestion.
    The location in the text of an instance is unknown, because `{i}` in it has been replaced."""
    where = span if draft.instance.number is not None else span.inside(written, refused.start, refused.end)
    hint = did_you_mean(written[refused.start : refused.end], refused.meant, otherwise=otherwise)
    if draft.instance.component is None:
        hint = replace(hint, text=f"{hint}; {_ANY_TEXT}")
    return code.at(where, problem=refused.problem, hint=hint, **facts)
