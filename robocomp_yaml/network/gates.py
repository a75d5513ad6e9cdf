"""Gates. A gate is a process between a group and the processes outside, if `expose:` has a rate or an access rule.

A gate is a small program of rcyaml that forwards calls of any interface. Its configuration is the program itself, with
the rules in it, so that it runs on every host with Python and Ice.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedGroup, LinkedInstance, Served
from robocomp_yaml.model import deployment as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.network.draft import Draft, Drafts, LocatedText, Offer
from robocomp_yaml.network.network import Connection
from robocomp_yaml.network.order import Dependence

PROGRAM = "templates/gate/gate.py"
_TABLE = "SERVED = ()\n"


class Gates(msgspec.Struct):
    """The gates of a network, by group, with their `connections` and the dependences `needs`."""

    drafts: Drafts
    connections: list[Connection] = []
    needs: list[Dependence] = []
    _of: dict[LinkedGroup, Draft] = {}

    def add(self) -> None:
        """Adds a draft for each gate, on the host of the first member that it forwards to."""
        for group in self.drafts.linked.groups.values():
            ruled = [(served, owner) for served in _ruled(group) if (owner := self.drafts.of(served.instance))]
            if not ruled:
                continue
            first = ruled[0][1]
            name = f"{group.name}.gate"
            while name in self.drafts.linked.instances:
                name += "_"
            python, how, span = Text(first.host.python or "python3"), Text(model.ARGUMENT), group.group.span
            enabled = any(owner.instance.entry.enabled for _, owner in ruled)
            entry = model.Entry(name, model.PROGRAM, python, config_as=how, enabled=enabled, span=span)
            folder = first.instance.folder
            instance = LinkedInstance(name, entry, group.document, group.scope, folder=folder, groups=(group,))
            draft = self._of[group] = self.drafts.drafts[instance] = Draft(
                instance, first.host, protocol=self.drafts.protocol
            )
            for served, owner in ruled:
                interface = next((o.interface for o in owner.offers if o.adapter == served.adapter), served.name)
                draft.offers.append(Offer(draft, served.name, interface, _span(served), served.port))

    def is_gate(self, draft: Draft) -> bool:
        return draft in self._of.values()

    def before(self, source: LinkedInstance, name: str) -> Iterator[Draft]:
        """The gates of the group `name`, and of the groups in it, that `source` outside the group has to pass."""
        if not self._of:
            return
        for group in self.drafts.linked.find(name, source.scope)[0]:
            members = group.members if isinstance(group, LinkedGroup) else []
            if source not in members:
                yield from (gate for inner, gate in self._of.items() if set(inner.members) <= set(members))

    def through(self, offer: Offer, source: LinkedInstance, *, inside: LinkedGroup | None = None) -> Offer:
        """What `source` is connected to instead of a member's offer: the outermost gate on the way. `inside` is the
        group of a gate, for which the connection is."""
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
        """The groups, the outermost first. Of two groups with the same members, of which none contains the other, the
        later one counts as the outer one."""
        return sorted(self.drafts.linked.groups.values(), key=lambda group: group.breadth)[::-1]

    def connect(self) -> None:
        """Connects each gate to the members behind it, or to the gates of inner groups."""
        for group, gate in self._of.items():
            for served, offer in self._behind(group):
                if offer.endpoint is None:
                    continue
                target, proxy, span = offer.owner.name, offer.proxy, _span(served)
                gate.proxies[served.name] = LocatedText(proxy, span)
                connection = Connection(gate.name, served.name, offer.interface, target, proxy=proxy, span=span)
                self.connections.append(connection)
                self.needs.append(Dependence(gate.name, target, "", served.name, span))

    def _behind(self, group: LinkedGroup) -> Iterator[tuple[Served, Offer]]:
        for served in _ruled(group):
            owner = self.drafts.of(served.instance)
            for offer in owner.offers if owner else ():
                if offer.adapter == served.adapter:
                    yield served, self.through(offer, served.instance, inside=group)

    def program(self, draft: Draft) -> str:
        """The text of the program of a gate."""
        group = next(group for group, gate in self._of.items() if gate is draft)
        rows = []
        for served in _ruled(group):
            offer = next((one for one in draft.offers if one.adapter == served.name), None)
            if offer is None or served.rule is None or served.name not in draft.proxies:
                continue
            allowed = None if served.rule.allow is None else tuple(method.text for method in served.rule.allow)
            proxy = draft.proxies[served.name].text
            row = (served.name, offer.interface.lower(), offer.text, proxy, served.rule.rate, allowed)
            rows.append(f"    {row!r},\n")
        return resources.text(PROGRAM).replace(_TABLE, f"SERVED = (\n{''.join(rows)})\n")


def _ruled(group: LinkedGroup) -> list[Served]:
    return [served for served in group.serves if served.rule is not None]


def _span(served: Served) -> Span:
    return served.rule.span if served.rule is not None else served.instance.entry.span
