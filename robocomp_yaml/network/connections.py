"""Who serves what each component requires: as `connect:` says, else the one that serves an equal interface."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.link.program import Port
from robocomp_yaml.model.component import IGNORE
from robocomp_yaml.model.deployment import Pair
from robocomp_yaml.network import ice_texts
from robocomp_yaml.network.contents import Contents, name_of
from robocomp_yaml.network.draft import Draft, Given, Offer
from robocomp_yaml.network.drafts import Drafts, is_broken
from robocomp_yaml.network.gates import Gates
from robocomp_yaml.network.network import Connection
from robocomp_yaml.network.order import Need
from robocomp_yaml.network.targets import Targets
from robocomp_yaml.source.ice_options import BLANKS, InvalidIceText
from robocomp_yaml.source.ice_proxy import parse_proxy


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


_MANY = 6


class Connections(msgspec.Struct):
    """`found` are the lines of the graph, `needs` says who waits for whom."""

    drafts: Drafts
    contents: Contents
    gates: Gates
    targets: Targets
    found: list[Connection] = []
    needs: list[Need] = []
    diagnostics: list[Diagnostic] = []
    _providers: Providers = msgspec.field(default_factory=Providers)

    def resolve(self) -> None:
        for draft in self.drafts.drafts.values():
            if not self.gates.is_gate(draft):
                self._providers.add(draft)
        for draft in self.drafts.drafts.values():
            component, given = draft.instance.component, {pair.name: pair for pair in draft.instance.entry.connect}
            for port in component.requires if component else ():
                pair = given.get(port.name)
                if pair is not None:
                    self._given(draft, pair, port)
                else:
                    self._look_for(draft, port)
            for pair in given.values() if component is None else ():
                self._given(draft, pair, None)

    def _given(self, draft: Draft, pair: Pair, port: Port | None) -> None:
        """`port` is None for a program, of which nothing but the proxy's name is known."""
        interface = port.interface.name if port else pair.name
        if is_proxy(pair.text):
            self.diagnostics += _faults(draft, pair)
            proxy = pair.text.strip(BLANKS)  # they mean nothing there, and no property's value can end with a tab
            draft.proxies[pair.name] = Given(proxy, pair.span)
            self.found.append(Connection(draft.name, pair.name, interface, "", proxy=proxy, span=pair.span))
            return
        target = self.targets.named(draft, pair)
        if target is None:
            return
        behind = target.interface
        fitting = [offer for offer in target.chosen() if offer.interface == interface or (port is None and behind)]
        equal = [offer for offer in fitting if port is None or self._is_equal(port, offer)]
        exact = [offer for offer in equal if offer.adapter in (behind, pair.name)]
        if len(equal) > 1 and len(exact) == 1:
            equal = exact
        if len(equal) == 1:
            self._connect(draft, pair.name, interface, equal[0], pair.span, port)
        elif equal:
            self._ambiguous(draft, pair.name, interface, equal, pair.span)
        elif fitting and port is not None:
            self._mismatch(draft, port, fitting[0], pair.span)
        else:
            served = ", ".join(dict.fromkeys(name for name, _ in target.served))
            self.diagnostics.append(
                codes.NOT_SERVED.at(
                    pair.span,
                    target=pair.text,
                    interface=interface,
                    hint=f"it serves {served}" if served else "it serves nothing",
                )
            )

    def _look_for(self, draft: Draft, port: Port) -> None:
        """Connects a port that nothing is said of: the nearest that serve an equal interface decide."""
        other: Offer | None = None
        for ring in self._providers.rings(draft, port.interface.name):
            equal = [offer for offer in ring if self._is_equal(port, offer)]
            equal = [offer for offer in equal if offer.owner.instance.entry.enabled] or equal
            if len(equal) == 1:
                self._connect(draft, port.name, port.interface.name, equal[0], draft.span, port)
            elif equal:
                self._ambiguous(draft, port.name, port.interface.name, equal, draft.span, port)
            if equal:
                return
            other = other or next(iter(ring), None)
        if other is not None:
            self._mismatch(draft, port, other, draft.span)
        else:
            self._unresolved(draft, port)

    def _is_equal(self, port: Port, offer: Offer) -> bool:
        if offer.port is None:
            module = offer.adapter.rpartition(".")[0]
            return module in ("", *name_of(port)[:1], port.scope.module.stem)
        return name_of(offer.port) == name_of(port) and self.contents.difference(port, offer.port) is None

    def _connect(self, draft: Draft, name: str, interface: str, offer: Offer, span: Span, port: Port | None) -> None:
        offer = self.gates.through(offer, draft.instance)
        target = offer.owner
        if offer.endpoint is None:  # the document's endpoint is none, which has been said
            return
        draft.proxies[name] = Given(offer.proxy, span)
        self.found.append(Connection(draft.name, name, interface, target.name, proxy=offer.proxy, span=span))
        if target is not draft:
            self.needs.append(Need(draft.name, target.name, port.use.absent if port else "", name, span))
        if draft.instance.entry.enabled and not target.instance.entry.enabled and not _may_be_absent(port):
            self.diagnostics.append(
                codes.NOT_ENABLED.at(
                    span,
                    source=draft.name,
                    interface=interface,
                    target=target.name,
                    related=[Related("not enabled here", target.span)],
                )
            )

    def _ambiguous(
        self, draft: Draft, name: str, interface: str, offers: list[Offer], span: Span, port: Port | None = None
    ) -> None:
        shown = [self._called(offer, draft) for offer in offers]
        more = f" and {len(shown) - _MANY} more" if len(shown) > _MANY else ""
        places = {offer.span: word for word, offer in reversed(list(zip(shown, offers[:_MANY], strict=False)))}
        related = [Related(f"'{word}' serves it", span) for span, word in reversed(places.items())]
        self.diagnostics.append(
            codes.AMBIGUOUS.at(
                span,
                source=draft.name,
                port=name,
                interface=interface,
                candidates=", ".join(shown[:_MANY]) + more,
                hint=f"write `connect: {{{name}: {shown[0]}}}`, or another",
                related=related + _required(port),
            )
        )

    def _called(self, offer: Offer, draft: Draft) -> str:
        """As `connect:` may name it: a member of a closed group by the group."""
        for group in self.drafts.linked.closed_around(offer.owner.instance, draft.instance)[:1]:
            for served in group.serves:
                if self.drafts.of(served.instance) is offer.owner and served.adapter == offer.adapter:
                    return f"{group.name}.{served.name}"
        return offer.owner.name if _is_only(offer) else offer.full_name

    def _mismatch(self, draft: Draft, port: Port, offer: Offer, span: Span) -> None:
        if offer.port is None:
            self._unresolved(draft, port)
            return
        found = self.contents.difference(port, offer.port)
        if found is not None:
            self.diagnostics.append(
                codes.MISMATCH.at(
                    span,
                    interface=port.interface.name,
                    source=draft.name,
                    target=offer.owner.name,
                    difference=found.message,
                    hint="let both import the same document",
                    related=found.sides(draft.name, offer.owner.name),
                )
            )

    def _unresolved(self, draft: Draft, port: Port) -> None:
        linked, name = self.drafts.linked, port.interface.name
        self.found.append(Connection(draft.name, port.name, name, "", span=draft.span))
        if linked.is_included or not self.drafts.complete:
            return
        told = codes.UNRESOLVED.at(
            draft.span,
            source=draft.name,
            interface=name,
            related=_required(port),
            hint=f"add a component that implements {name}, or say where it is: "
            f'`connect: {{{port.name}: "{name.lower()}:tcp -h HOST -p PORT"}}`',
        )
        self.diagnostics.append(told.as_severity(WARNING) if _may_be_absent(port) else told)


def is_proxy(text: str) -> bool:
    """Whether `connect:` names something outside, by its proxy."""
    return text[:1] in "\"'" or any(char in text for char in f":@{BLANKS}")


def _faults(draft: Draft, pair: Pair) -> Iterator[Diagnostic]:
    """What Ice would refuse, and what it would pass over."""
    try:
        found = parse_proxy(pair.text)
    except InvalidIceText as refused:
        usual = f'a proxy is spelled as Ice has it: `"{pair.name.lower()}:tcp -h HOST -p PORT"`'
        yield codes.BAD_PROXY.at(
            ice_texts.place(draft, pair.span, pair.text, refused),
            text=pair.text,
            problem=refused.problem,
            hint=ice_texts.hint(draft, pair.text, refused, usual),
        )
        return
    for unknown in found.unknown:
        yield codes.PASSED_OVER.at(
            ice_texts.place(draft, pair.span, pair.text, unknown),
            problem=unknown.problem,
            hint=ice_texts.hint(draft, pair.text, unknown, ""),
        )


def _may_be_absent(port: Port | None) -> bool:
    return port is not None and port.use.absent == IGNORE


def _required(port: Port | None) -> list[Related]:
    return [] if port is None else [Related(f"{port.name} is required here", port.use.span)]


def _is_only(offer: Offer) -> bool:
    return sum(other.interface == offer.interface for other in offer.owner.offers) == 1
