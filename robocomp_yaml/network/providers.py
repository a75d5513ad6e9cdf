"""Who serves an interface, the nearest first: those of the same includes and closed groups, then all others."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.network.draft import Draft, Offer
from robocomp_yaml.network.drafts import is_broken


class Providers(msgspec.Struct):
    """Offers by interface; `_within` has them by interface and by what holds them, an include or a closed group, so
    that a large deployment of many alike is searched as fast as a small one."""

    _every: dict[str, list[Offer]] = {}
    _within: dict[tuple[str, str], list[Offer]] = {}

    def add(self, draft: Draft) -> None:
        """Takes in what a component implements, and what a program has an endpoint for."""
        around = _around(draft.instance)
        for offer in draft.offers:
            if offer.port or offer.given:
                self._every.setdefault(offer.interface, []).append(offer)
                for holder in around:
                    self._within.setdefault((offer.interface, holder), []).append(offer)

    def rings(self, draft: Draft, interface: str) -> Iterator[list[Offer]]:
        """What could be connected to a draft: what shares most with it first. None of what closed groups hide."""
        shared: dict[Offer, int] = {}
        for holder in _around(draft.instance):
            for offer in self._within.get((interface, holder), ()):
                shared[offer] = shared.get(offer, 0) + 1
        for rank in sorted(set(shared.values()), reverse=True):
            yield [offer for offer, count in shared.items() if count == rank and _reaches(draft, offer)]
        yield [o for o in self._every.get(interface, ()) if o not in shared and _reaches(draft, o)]


def _around(instance: LinkedInstance) -> list[str]:
    """The includes and closed groups that hold an instance."""
    steps = instance.scope.split(".")[:-1]
    includes = [".".join(steps[:n]) for n in range(1, len(steps) + 1)]
    return includes + [f"group {group.name}" for group in instance.groups if group.is_closed]


def _reaches(draft: Draft, offer: Offer) -> bool:
    """Whether an offer is another one's, and every closed group around it that the draft is outside of exposes it."""
    source, target = draft.instance, offer.owner.instance
    return offer.owner is not draft and all(
        any(
            (served.instance.process or served.instance) is target and served.adapter == offer.adapter
            for served in group.serves
        )
        for group in target.groups
        if group.is_closed and not is_broken(group) and group not in source.groups
    )
