"""Drafts made of a linked deployment: each process and IceStorm on its host, with what it serves."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.link import deployments
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance
from robocomp_yaml.link.program import Port
from robocomp_yaml.model import deployment as model
from robocomp_yaml.network.draft import Draft, Offer, StormDraft
from robocomp_yaml.network.network import LOOPBACK, Host
from robocomp_yaml.network.port_numbers import COMMON_BEHAVIOR


class Drafts(msgspec.Struct):
    """Instances and IceStorms in the documents' order. `complete` is False where something could not be read, so that
    what is missing may be there."""

    linked: LinkedDeployment
    hosts: dict[str, Host] = {}
    drafts: dict[LinkedInstance, Draft] = {}
    storms: dict[deployments.LinkedStorm, StormDraft] = {}
    complete: bool = True

    def of(self, instance: LinkedInstance) -> Draft | None:
        """The draft of the process that an instance is, or is a second name of."""
        return self.drafts.get(instance.process or instance)


def drafts_of(linked: LinkedDeployment) -> Drafts:
    result = Drafts(linked, {name: _host(host) for name, host in linked.hosts.items()})
    result.complete = not (linked.broken or any(map(is_broken, linked.groups.values())))
    for storm in linked.storms.values():
        result.storms[storm] = StormDraft(storm, _placed(result.hosts, storm.host))
        result.complete &= not storm.broken
    for instance in linked.instances.values():
        is_known = instance.component is not None or instance.entry.kind != model.COMPONENT
        result.complete &= is_known and not instance.broken
        if is_known and instance.entry.kind != model.PROCESS:
            draft = result.drafts[instance] = Draft(instance, _placed(result.hosts, instance.host))
            draft.offers, draft.hears = list(_offers(draft)), list(_hears(draft))
            result.complete &= instance.component is None or not instance.component.broken
    for instance in linked.instances.values():
        owner = result.drafts.get(instance.process) if instance.process else None
        if owner is not None:
            owner.aliases.append(instance)
            owner.offers += _endpoints(owner, instance)
    return result


def is_broken(group: LinkedGroup) -> bool:
    """Whether something about a group has been reported, so that what it serves is not known."""
    return group.broken or len(group.serves) < len(group.group.exposed)


def _host(host: model.Host) -> Host:
    return Host(host.name, host.address.text, host.user, host.address.span)


def _placed(hosts: dict[str, Host], host: model.Host | None) -> Host:
    if host is not None:
        return hosts.setdefault(host.name, _host(host))
    return hosts.setdefault(LOOPBACK, Host(LOOPBACK))


def _offers(draft: Draft) -> Iterator[Offer]:
    component = draft.instance.component
    if component is None:
        yield from _endpoints(draft, draft.instance)
        return
    given = {pair.name: pair for pair in draft.instance.entry.endpoints}
    served: list[tuple[str, str, Port | None]] = [(p.name, p.interface.name, p) for p in component.implements]
    if all(port.name != COMMON_BEHAVIOR for port in component.implements):
        served.append((COMMON_BEHAVIOR, COMMON_BEHAVIOR, None))
    for name, interface, port in served:
        pair = given.get(name)
        yield Offer(draft, name, interface, pair.span if pair else draft.span, port, given=pair.text if pair else "")


def _hears(draft: Draft) -> Iterator[Offer]:
    entry, component = draft.instance.entry, draft.instance.component
    given = {pair.name: pair for pair in entry.endpoints}
    fixed = {number.name: number for number in entry.ports}
    for port in component.subscribes if component else ():
        where = given.get(port.name) or fixed.get(port.name)
        if where is not None:
            text = given[port.name].text if port.name in given else ""
            yield Offer(draft, f"{port.name}Topic", port.interface.name, where.span, port, given=text)


def _endpoints(owner: Draft, instance: LinkedInstance) -> Iterator[Offer]:
    """What an entry says that a program serves; the name may be qualified by a module."""
    for pair in instance.entry.endpoints:
        yield Offer(owner, pair.name, pair.name.rpartition(".")[2], pair.span, given=pair.text)
