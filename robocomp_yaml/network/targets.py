"""What `connect:` names: an entry, one of its interfaces, or a group, with all that is served there."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.deployments import LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.model.deployment import Pair
from robocomp_yaml.network.draft import Draft, Offer
from robocomp_yaml.network.drafts import Drafts, is_broken


class Named(msgspec.Struct, frozen=True):
    """`served` are offers by the names under which they are served; `interface` is what stands behind the target's
    name, or ''."""

    served: tuple[tuple[str, Offer], ...]
    interface: str

    def chosen(self) -> list[Offer]:
        """Those that are meant: all, where no interface is named."""
        return [
            offer
            for name, offer in self.served
            if not self.interface or self.interface in (name, offer.adapter, offer.interface)
        ]


class Targets(msgspec.Struct):
    drafts: Drafts
    diagnostics: list[Diagnostic] = []

    def named(self, draft: Draft, pair: Pair) -> Named | None:
        """What an entry of `connect:` names; None where that has been told to be wrong."""
        linked, instance = self.drafts.linked, draft.instance
        targets, behind = linked.find(pair.text, instance.scope)
        if not targets:
            if not instance.broken:
                self.diagnostics.append(self._not_there(draft, pair))
            return None
        served: list[tuple[str, Offer]] = []
        for target in targets:
            around = linked.closed_groups_of(target, instance)
            if isinstance(target, LinkedStorm):
                self.diagnostics.append(
                    codes.NOT_SERVED.at(
                        pair.span, target=pair.text, interface=pair.name, hint="it is an IceStorm, which carries topics"
                    )
                )
                return None
            if around:
                group = around[0].name
                self.diagnostics.append(
                    codes.CLOSED_GROUP.at(
                        pair.span,
                        target=pair.text,
                        group=group,
                        hint=f"connect to '{group}', which serves what it exposes",
                    )
                )
                return None
            if self._lacks_something(target):
                return None
            served += self._of_group(target, draft) if isinstance(target, LinkedGroup) else self._of(target)
        return Named(tuple(served), behind)

    def _not_there(self, draft: Draft, pair: Pair) -> Diagnostic:
        proxy = f'"{pair.name.lower()}:tcp -h HOST -p PORT"'
        return codes.NO_TARGET.at(
            pair.span,
            name=pair.text,
            hint=did_you_mean(
                pair.text,
                self.drafts.linked.names.get(draft.instance.scope, {}),
                otherwise=f"what is outside is named by its proxy, in quotes: {proxy}",
            ),
        )

    def _lacks_something(self, target: Target) -> bool:
        """Whether something that the target may serve could not be read."""
        if isinstance(target, LinkedGroup):
            return is_broken(target) or any(map(self._lacks_something, target.members))
        if isinstance(target, LinkedInstance):
            is_read = self.drafts.of(target) is not None and not target.broken
            return not is_read or bool(target.component and target.component.broken)
        return False

    def _of(self, instance: LinkedInstance) -> Iterator[tuple[str, Offer]]:
        """What an entry serves; a second name of a process, what stands under it, else what the process does."""
        owner = self.drafts.of(instance)
        own = {pair.name for pair in instance.entry.endpoints} if instance.process else set()
        for offer in owner.offers if owner else ():
            if not own or offer.adapter in own:
                yield offer.adapter, offer

    def _of_group(self, group: LinkedGroup, draft: Draft) -> Iterator[tuple[str, Offer]]:
        """What a group serves to those outside of it, under names of its own; to its own members, everything."""
        is_outside = group.is_closed and draft.instance not in group.members
        names = {(one.instance.process or one.instance, one.adapter): one.name for one in group.serves}
        owners = dict.fromkeys(owner for member in group.members if (owner := self.drafts.of(member)))
        for offer in (offer for owner in owners for offer in owner.offers):
            name = names.get((offer.owner.instance, offer.adapter))
            if name is not None if is_outside else offer.port or offer.given:
                yield name or offer.adapter, offer
