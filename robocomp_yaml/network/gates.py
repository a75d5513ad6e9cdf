"""Gates: a process between a group and those outside, where `expose:` has a rate or an access rule.

A gate is a small program of ours that passes calls on, whatever their interface; its configuration is the program
itself, with the rules in it, so that it runs wherever there is Python with Ice.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedGroup, LinkedInstance, Served
from robocomp_yaml.model import deployment as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.network.draft import Draft, Given, Offer
from robocomp_yaml.network.drafts import Drafts
from robocomp_yaml.network.network import Connection
from robocomp_yaml.network.order import Need

PROGRAM = "templates/gate/gate.py"
_TABLE = "SERVED = ()\n"


class Gates(msgspec.Struct):
    """The gates of a network, by group. `found` and `needs` are theirs, as those of `Connections`."""

    drafts: Drafts
    found: list[Connection] = []
    needs: list[Need] = []
    _of: dict[LinkedGroup, Draft] = {}

    def place(self) -> None:
        """Adds a draft for each gate, on the host of the member that it leads to first."""
        for group in self.drafts.linked.groups.values():
            ruled = [(served, owner) for served in _ruled(group) if (owner := self.drafts.of(served.instance))]
            if not ruled:
                continue
            first = ruled[0][1]
            name = f"{group.name}.gate"
            while name in self.drafts.linked.instances:
                name += "_"
            entry = model.Entry(
                name,
                model.PROGRAM,
                Text("python3"),
                config_as=Text(model.ARGUMENT),
                enabled=any(owner.instance.entry.enabled for _, owner in ruled),
                span=group.group.span,
            )
            instance = LinkedInstance(
                name, entry, group.document, group.scope, folder=first.instance.folder, groups=(group,)
            )
            draft = self._of[group] = self.drafts.drafts[instance] = Draft(instance, first.host)
            for served, owner in ruled:
                interface = next((o.interface for o in owner.offers if o.adapter == served.adapter), served.name)
                draft.offers.append(Offer(draft, served.name, interface, _place(served), served.port))

    def is_gate(self, draft: Draft) -> bool:
        return draft in self._of.values()

    def before(self, source: LinkedInstance, name: str) -> Iterator[Draft]:
        """The gates of what `source`, which stands outside, calls a group, and of the groups inside of that."""
        if not self._of:
            return
        for group in self.drafts.linked.find(name, source.scope)[0]:
            members = group.members if isinstance(group, LinkedGroup) else []
            if source not in members:
                yield from (gate for inner, gate in self._of.items() if set(inner.members) <= set(members))

    def through(self, offer: Offer, source: LinkedInstance, *, inside: LinkedGroup | None = None) -> Offer:
        """What `source` is connected to in place of a member's offer: the outermost gate on the way. `inside` is a
        group whose own gate asks."""
        if not self._of:
            return offer
        around = [group for group in self._outermost_first if group in offer.owner.instance.groups]
        if inside is not None:
            on_the_way = around[around.index(inside) + 1 :]
        else:
            on_the_way = [group for group in around if source not in group.members]
        for group in on_the_way:
            gate = self._of.get(group)
            for served in _ruled(group) if gate is not None else ():
                if served.adapter == offer.adapter and self.drafts.of(served.instance) is offer.owner:
                    assert gate is not None
                    return next(one for one in gate.offers if one.adapter == served.name)
        return offer

    @property
    def _outermost_first(self) -> list[LinkedGroup]:
        """Of groups that have the same members, and do not hold each other, the later one is taken to be the outer."""
        return sorted(self.drafts.linked.groups.values(), key=lambda group: group.breadth)[::-1]

    def connect(self) -> None:
        """Each gate to the members behind it, or to the gates of groups inside."""
        for group, gate in self._of.items():
            for served, offer in self._behind(group):
                if offer.endpoint is None:
                    continue
                gate.proxies[served.name] = Given(offer.proxy, _place(served))
                self.found.append(
                    Connection(
                        gate.name,
                        served.name,
                        offer.interface,
                        offer.owner.name,
                        proxy=offer.proxy,
                        span=_place(served),
                    )
                )
                self.needs.append(Need(gate.name, offer.owner.name, "", served.name, _place(served)))

    def _behind(self, group: LinkedGroup) -> Iterator[tuple[Served, Offer]]:
        for served in _ruled(group):
            owner = self.drafts.of(served.instance)
            for offer in owner.offers if owner else ():
                if offer.adapter == served.adapter:
                    yield served, self.through(offer, served.instance, inside=group)

    def program(self, draft: Draft) -> str:
        """The text of a gate's program."""
        group = next(group for group, gate in self._of.items() if gate is draft)
        rows = []
        for served in _ruled(group):
            offer = next((one for one in draft.offers if one.adapter == served.name), None)
            if offer is None or served.rule is None or served.name not in draft.proxies:
                continue
            allowed = None if served.rule.allow is None else tuple(method.text for method in served.rule.allow)
            row = (
                served.name,
                offer.interface.lower(),
                offer.text,
                draft.proxies[served.name].text,
                served.rule.rate,
                allowed,
            )
            rows.append(f"    {row!r},\n")
        return resources.text(PROGRAM).replace(_TABLE, f"SERVED = (\n{''.join(rows)})\n")


def _ruled(group: LinkedGroup) -> list[Served]:
    return [served for served in group.serves if served.rule is not None]


def _place(served: Served) -> Span:
    return served.rule.span if served.rule is not None else served.instance.entry.span
