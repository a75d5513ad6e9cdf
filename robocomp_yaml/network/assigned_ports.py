"""The TCP ports of a network: as an entry sets them, else as its component's own configuration does, else defaults."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.addresses.own import OwnText
from robocomp_yaml.addresses.port_numbers import USUAL, FreePorts, usable
from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.deployment import Deployment
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.network.draft import MANAGER, PUBLISH, Draft, Drafts, Offer, StormDraft
from robocomp_yaml.network.network import is_loopback
from robocomp_yaml.source.ice_endpoint import parse_endpoints
from robocomp_yaml.source.ice_options import InvalidIceText

STORM_PORT = 9999
"""The port of a topic manager without a port of its own. In an include with a name, which can be included several
times, and in a deployment with a range of ports, a default port replaces it."""


def assign_ports(drafts: Drafts, addresses: Addresses) -> Iterator[Diagnostic]:
    """Assigns a TCP port to everything that is served. A port that nobody sets is a hash of the names of the instance
    and the adapter. If two are equal on one host, the later name gets the next free port, so that ports depend on
    names, not on the order of the document."""
    ranges = Ranges(drafts, addresses)
    yield from ranges.faults()
    free: dict[str, FreePorts] = {host.address: FreePorts() for host in drafts.hosts.values()}
    for storm in drafts.storms.values():
        is_free = bool(storm.linked.scope) or ranges.of(storm.linked.document) != USUAL
        storm.manager = storm.linked.storm.port or (0 if is_free else STORM_PORT)
        storm.publish = storm.linked.storm.publish or 0
        free[storm.host.address].taken |= {storm.manager, storm.publish} - {0}
    for draft in drafts.drafts.values():
        for offer in draft.adapters:
            _fix(draft, offer)
            if not offer.explicit and not offer.number:
                yield from _fix_by_own(draft, offer, addresses)
            if offer.endpoint is not None and (offer.explicit or offer.number):
                free[draft.host.address].taken.add(offer.endpoint.port)
    for name, served in sorted(_unassigned(drafts), key=lambda pair: pair[0]):
        of_storm = isinstance(served, StormDraft)
        host = (served if of_storm else served.owner).host  # type: ignore[union-attr]
        document = served.linked.document if isinstance(served, StormDraft) else served.owner.instance.document
        number = free[host.address].assign(*name, ranges.of(document))
        if isinstance(served, Offer):
            served.number = number
        elif name[1] == MANAGER:
            served.manager = number
        else:
            served.publish = number
    for one in free.values():
        yield from one.diagnostics()


class Ranges:
    """The ranges of default ports: that of an entry's document, else that of the deployment, else that of its
    workspace."""

    def __init__(self, drafts: Drafts, addresses: Addresses) -> None:
        self._deployment, self._addresses = drafts.linked.deployment, addresses
        self._documents = drafts.linked.documents

    def of(self, document: Deployment) -> PortRange:
        own = usable(document.ports) or usable(self._deployment.ports)
        return own or self._addresses.range_of(self._deployment.path)

    def faults(self) -> Iterator[Diagnostic]:
        for document in self._documents:
            if document.ports is not None and document.ports.is_empty:
                yield document.ports.fault()


def _unassigned(drafts: Drafts) -> Iterator[tuple[tuple[str, str], Offer | StormDraft]]:
    """Everything without a port, with the names from which its default is computed."""
    for draft in drafts.drafts.values():
        for offer in draft.offers:
            if not offer.explicit and not offer.number:
                yield (draft.name, offer.adapter), offer
    for storm in drafts.storms.values():
        if not storm.publish:
            yield (storm.name, f"{MANAGER}.{PUBLISH}"), storm
        if not storm.manager:
            yield (storm.name, MANAGER), storm


def _fix(draft: Draft, offer: Offer) -> None:
    """Sets the port that the document sets. `port:` is for the first interface; instances count all ports up."""
    entry = draft.instance.entry
    fixed = next((number for number in entry.ports if number.name == offer.key), None)
    if fixed is None and entry.port is not None and offer is draft.offers[0] and not offer.explicit:
        fixed = entry.port
    if fixed is not None:
        offer.number = fixed.number + _step(draft.instance)
        offer.span = fixed.span


def _fix_by_own(draft: Draft, offer: Offer, addresses: Addresses) -> Iterator[Diagnostic]:
    """Sets the endpoint that the component's own configuration sets. A plain port listens as all ports of the
    deployment do; a host, a protocol or options are kept."""
    component = draft.instance.component
    own = addresses.own_endpoint(component, draft.own, offer.adapter) if component is not None else None
    if component is None or own is None:
        return
    try:
        endpoints = parse_endpoints(own.text)
    except InvalidIceText:
        return  # the check of the values reports it
    fixed = endpoints[0].port if endpoints else 0
    if draft.instance.number is not None and fixed:
        if draft.instance.number == 0:
            yield _of_instances(draft, component, offer, own, fixed)
        return
    first = endpoints[0] if endpoints else None
    is_plain = first is not None and len(endpoints) == 1 and first.protocol in ("tcp", "default") and not first.options
    if first is not None and is_plain and (not first.host or is_loopback(first.host)):
        offer.number = first.port
    elif fixed:
        offer.explicit = own.text
    offer.own = own.span if fixed else None


def _of_instances(draft: Draft, component: LinkedComponent, offer: Offer, own: OwnText, port: int) -> Diagnostic:
    hint = f"`port: {port}`" if offer is draft.offers[0] else f"`ports: {{{offer.key}: {port}}}`"
    return codes.OWN_PORT_OF_INSTANCES.at(
        draft.span, component=component.component.name, adapter=offer.adapter, port=port,
        hint=f"set the port of the first instance, {hint}; the others count up",
        related=[Related("set here", own.span)],
    )  # fmt: skip


def _step(instance: LinkedInstance) -> int:
    """The difference between the ports of an instance and those of the first instance."""
    entry = instance.entry
    return (instance.number or 0) * (len(entry.ports) + (1 if entry.port is not None else 0))
