"""The port of everything that is served: as the document says, else a default that is free on its host."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.network.draft import MANAGER, PUBLISH, Draft, Drafts, Offer, StormDraft
from robocomp_yaml.network.port_numbers import RESERVED, default_port, next_free

STORM_PORT = 9999
"""Of an IceStorm in an include with a name, which may be there several times, it is a default as all others."""


def assign(drafts: Drafts) -> None:
    """Fills in all numbers. Those that are not given are a hash of the instance's and the adapter's name; of two that
    meet on a host, the later name moves on: so they depend on names alone, not on the order of the document."""
    taken: dict[str, set[int]] = {host.address: set(RESERVED) for host in drafts.hosts.values()}
    for storm in drafts.storms.values():
        storm.manager = storm.linked.storm.port or (0 if storm.linked.scope else STORM_PORT)
        if storm.manager:
            taken[storm.host.address].add(storm.manager)
    for draft in drafts.drafts.values():
        for offer in draft.adapters:
            _fix(draft, offer)
            if offer.endpoint is not None and (offer.given or offer.number):
                taken[draft.host.address].add(offer.endpoint.port)
    for name, place in sorted(_open(drafts), key=lambda pair: pair[0]):
        ports = taken[place.host.address if isinstance(place, StormDraft) else place.owner.host.address]
        number = next_free(default_port(*name), ports)
        ports.add(number)
        if isinstance(place, Offer):
            place.number = number
        elif name[1] == MANAGER:
            place.manager = number
        else:
            place.publish = number


def _open(drafts: Drafts) -> Iterator[tuple[tuple[str, str], Offer | StormDraft]]:
    """What has no port yet, by the names that its default is made of."""
    for draft in drafts.drafts.values():
        for offer in draft.offers:
            if not offer.given and not offer.number:
                yield (draft.name, offer.adapter), offer
    for storm in drafts.storms.values():
        yield (storm.name, f"{MANAGER}.{PUBLISH}"), storm
        if not storm.manager:
            yield (storm.name, MANAGER), storm


def _fix(draft: Draft, offer: Offer) -> None:
    """The number that the document gives. `port:` is that of the first interface; instances count all up."""
    entry = draft.instance.entry
    name = offer.adapter.removesuffix("Topic") if offer in draft.hears else offer.adapter
    fixed = next((number for number in entry.ports if number.name == name), None)
    if fixed is None and entry.port is not None and offer is draft.offers[0] and not offer.given:
        fixed = entry.port
    if fixed is not None:
        offer.number = fixed.number + _step(draft.instance)
        offer.span = fixed.span


def _step(instance: LinkedInstance) -> int:
    """How far the ports of an instance are from those of the first."""
    entry = instance.entry
    return (instance.number or 0) * (len(entry.ports) + (1 if entry.port is not None else 0))
