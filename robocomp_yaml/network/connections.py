"""Connections of what each component requires: as `connect:` says, else to the process with an equal interface."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.addresses.interface_comparison import InterfaceComparison, name_of
from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.deployments import LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.link.program import Port
from robocomp_yaml.model.component import IGNORE
from robocomp_yaml.model.deployment import Pair
from robocomp_yaml.network.draft import Draft, Drafts, LocatedText, Offer, is_broken, text_fault
from robocomp_yaml.network.gates import Gates
from robocomp_yaml.network.network import Connection
from robocomp_yaml.network.order import Dependence
from robocomp_yaml.source.ice_options import BLANKS, InvalidIceText
from robocomp_yaml.source.ice_proxy import parse_proxy


class Providers(msgspec.Struct):
    """Offers by interface. `_within` has them by interface and by the include or closed group that contains them, so
    that a large deployment of many equal components is searched as fast as a small one."""

    _every: dict[str, list[Offer]] = {}
    _within: dict[tuple[str, str], list[Offer]] = {}

    def add(self, draft: Draft) -> None:
        """Adds what a component implements, and what a program has an endpoint for."""
        around = _around(draft.instance)
        for offer in draft.offers:
            if offer.port or offer.explicit:
                self._every.setdefault(offer.interface, []).append(offer)
                for holder in around:
                    self._within.setdefault((offer.interface, holder), []).append(offer)

    def rings(self, draft: Draft, interface: str) -> Iterator[list[Offer]]:
        """The candidates for a draft, except those that closed groups hide. The first list shares the most includes
        and closed groups with the draft, the last list none."""
        shared: dict[Offer, int] = {}
        for holder in _around(draft.instance):
            for offer in self._within.get((interface, holder), ()):
                shared[offer] = shared.get(offer, 0) + 1
        for rank in sorted(set(shared.values()), reverse=True):
            yield [offer for offer, count in shared.items() if count == rank and _reaches(draft, offer)]
        yield [o for o in self._every.get(interface, ()) if o not in shared and _reaches(draft, o)]


def _around(instance: LinkedInstance) -> list[str]:
    """The includes and closed groups that contain an instance."""
    steps = instance.scope.split(".")[:-1]
    includes = [".".join(steps[:n]) for n in range(1, len(steps) + 1)]
    return includes + [f"group {group.name}" for group in instance.groups if group.is_closed]


def _reaches(draft: Draft, offer: Offer) -> bool:
    """Whether an offer is of another process, and is exposed by every closed group that contains it, but not the
    draft."""
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
    """Connects what is required. `connections` are the connections, `needs` the dependences that follow."""

    drafts: Drafts
    comparison: InterfaceComparison
    gates: Gates
    addresses: Addresses
    connections: list[Connection] = []
    needs: list[Dependence] = []
    diagnostics: list[Diagnostic] = []
    _providers: Providers = msgspec.field(default_factory=Providers)

    def resolve(self) -> None:
        for draft in self.drafts.drafts.values():
            if not self.gates.is_gate(draft):
                self._providers.add(draft)
        for draft in self.drafts.drafts.values():
            component, explicit = draft.instance.component, {pair.name: pair for pair in draft.instance.entry.connect}
            for port in component.requires if component else ():
                pair = explicit.get(port.name)
                if pair is not None:
                    self._explicit(draft, pair, port)
                else:
                    self._implicit(draft, port)
            for pair in explicit.values() if component is None else ():
                self._explicit(draft, pair, None)

    def _explicit(self, draft: Draft, pair: Pair, port: Port | None) -> None:
        """Connects as `connect:` says. `port` is None for a program, of which only the proxy's name is known."""
        interface = port.interface.name if port else pair.name
        if is_proxy(pair.text):
            self.diagnostics += _faults(draft, pair)
            proxy = pair.text.strip(BLANKS)  # Ice ignores them, and the value of a property cannot end with a tab
            draft.proxies[pair.name] = LocatedText(proxy, pair.span)
            self.connections.append(Connection(draft.name, pair.name, interface, "", proxy=proxy, span=pair.span))
            return
        target = named(self.drafts, draft, pair)
        if isinstance(target, Diagnostic):
            self.diagnostics.append(target)
        if not isinstance(target, ConnectTarget):
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
            served = ", ".join(dict.fromkeys(name for name, _ in target.served)) or "nothing"
            not_served = codes.NOT_SERVED.at(
                pair.span, target=pair.text, interface=interface, hint=f"it serves {served}"
            )
            self.diagnostics.append(not_served)

    def _implicit(self, draft: Draft, port: Port) -> None:
        """Connects a port without an entry in `connect:` to the nearest process that serves an equal interface."""
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
        return self.comparison.is_equal(port, offer.port)

    def _connect(self, draft: Draft, name: str, interface: str, offer: Offer, span: Span, port: Port | None) -> None:
        offer = self.gates.through(offer, draft.instance)
        target = offer.owner
        if offer.endpoint is None:  # the endpoint is not valid, which has been reported
            return
        draft.proxies[name] = LocatedText(offer.proxy, span)
        self.connections.append(Connection(draft.name, name, interface, target.name, proxy=offer.proxy, span=span))
        if target is not draft:
            self.needs.append(Dependence(draft.name, target.name, port.use.absent if port else "", name, span))
        if draft.instance.entry.enabled and not target.instance.entry.enabled and not _may_be_absent(port):
            related = [Related("not enabled here", target.span)]
            off = codes.NOT_ENABLED.at(
                span, source=draft.name, interface=interface, target=target.name, related=related
            )
            self.diagnostics.append(off)

    def _ambiguous(
        self, draft: Draft, name: str, interface: str, offers: list[Offer], span: Span, port: Port | None = None
    ) -> None:
        names = [self._name(offer, draft) for offer in offers]
        by_span = {offer.span: name for name, offer in reversed(list(zip(names, offers[:_MANY], strict=False)))}
        related = [Related(f"'{name}' serves it", span) for span, name in reversed(by_span.items())]
        self.diagnostics.append(
            codes.AMBIGUOUS.at(
                span,
                source=draft.name,
                port=name,
                interface=interface,
                candidates=some(names, _MANY),
                hint=f"write `connect: {{{name}: {names[0]}}}`, or another one",
                related=related + _required(port),
            )
        )

    def _name(self, offer: Offer, draft: Draft) -> str:
        """The name of an offer in `connect:`; a member of a closed group is named by the group."""
        for group in self.drafts.linked.closed_groups_of(offer.owner.instance, draft.instance)[:1]:
            for served in group.serves:
                if self.drafts.of(served.instance) is offer.owner and served.adapter == offer.adapter:
                    return f"{group.name}.{served.name}"
        return offer.owner.name if _is_only(offer) else offer.full_name

    def _mismatch(self, draft: Draft, port: Port, offer: Offer, span: Span) -> None:
        if offer.port is None:
            self._unresolved(draft, port)
            return
        found = self.comparison.difference(port, offer.port)
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
        linked, name, component = self.drafts.linked, port.interface.name, draft.instance.component
        own = self.addresses.own_proxy(component, draft.own, port) if component is not None else None
        if own is not None:  # the component's own choice is an external server
            external = Connection(draft.name, port.name, name, "", proxy=own.text, span=draft.span)
            self.connections.append(external)
            return
        self.connections.append(Connection(draft.name, port.name, name, "", span=draft.span))
        if linked.is_included or not self.drafts.complete:
            return
        unresolved = codes.UNRESOLVED.at(
            draft.span,
            source=draft.name,
            interface=name,
            related=_required(port),
            hint=f"add a component that implements {name}, or name its proxy: "
            f'`connect: {{{port.name}: "{name.lower()}:tcp -h HOST -p PORT"}}`',
        )
        self.diagnostics.append(unresolved.as_severity(WARNING) if _may_be_absent(port) else unresolved)


def is_proxy(text: str) -> bool:
    """Whether a text of `connect:` is the proxy of an external server."""
    return text[:1] in "\"'" or any(char in text for char in f":@{BLANKS}")


def _faults(draft: Draft, pair: Pair) -> Iterator[Diagnostic]:
    """What Ice would reject, and what it would ignore."""
    try:
        found = parse_proxy(pair.text)
    except InvalidIceText as refused:
        usual = f'write it in the syntax of Ice: `"{pair.name.lower()}:tcp -h HOST -p PORT"`'
        yield text_fault(codes.BAD_PROXY, draft, pair.span, pair.text, refused, usual, text=pair.text)
        return
    for unknown in found.unknown:
        yield text_fault(codes.IGNORED_ENDPOINT, draft, pair.span, pair.text, unknown)


def _may_be_absent(port: Port | None) -> bool:
    return port is not None and port.use.absent == IGNORE


def _required(port: Port | None) -> list[Related]:
    return [] if port is None else [Related(f"{port.name} is required here", port.use.span)]


def _is_only(offer: Offer) -> bool:
    return sum(other.interface == offer.interface for other in offer.owner.offers) == 1


class ConnectTarget(msgspec.Struct, frozen=True):
    """What `connect:` names. `served` are offers by the names under which they are served. `interface` is the interface
    after the target's name, or ''."""

    served: tuple[tuple[str, Offer], ...]
    interface: str

    def chosen(self) -> list[Offer]:
        """The offers of the named interface; all offers if no interface is named."""
        return [
            offer
            for name, offer in self.served
            if not self.interface or self.interface in (name, offer.adapter, offer.interface)
        ]


def named(drafts: Drafts, draft: Draft, pair: Pair) -> ConnectTarget | Diagnostic | None:
    """What an entry of `connect:` names, or the diagnostic of what is wrong; None if that has been reported."""
    linked, instance = drafts.linked, draft.instance
    targets, behind = linked.find(pair.text, instance.scope)
    if not targets:
        return None if instance.broken else _unknown(drafts, draft, pair)
    served: list[tuple[str, Offer]] = []
    for target in targets:
        around = linked.closed_groups_of(target, instance)
        if isinstance(target, LinkedStorm):
            hint = "it is an IceStorm, which carries topics"
            return codes.NOT_SERVED.at(pair.span, target=pair.text, interface=pair.name, hint=hint)
        if around:
            group = around[0].name
            hint = f"connect to '{group}', which serves what it exposes"
            return codes.CLOSED_GROUP.at(pair.span, target=pair.text, group=group, hint=hint)
        if _is_incomplete(drafts, target):
            return None
        served += _of_group(drafts, target, draft) if isinstance(target, LinkedGroup) else _of(drafts, target)
    return ConnectTarget(tuple(served), behind)


def _unknown(drafts: Drafts, draft: Draft, pair: Pair) -> Diagnostic:
    proxy = f'"{pair.name.lower()}:tcp -h HOST -p PORT"'
    names = drafts.linked.names.get(draft.instance.scope, {})
    hint = did_you_mean(pair.text, names, otherwise=f"name an external server by its proxy, in quotes: {proxy}")
    return codes.NO_TARGET.at(pair.span, name=pair.text, hint=hint)


def _is_incomplete(drafts: Drafts, target: Target) -> bool:
    """Whether something that the target serves could not be read."""
    if isinstance(target, LinkedGroup):
        return is_broken(target) or any(_is_incomplete(drafts, member) for member in target.members)
    if isinstance(target, LinkedInstance):
        is_read = drafts.of(target) is not None and not target.broken
        return not is_read or bool(target.component and target.component.broken)
    return False


def _of(drafts: Drafts, instance: LinkedInstance) -> Iterator[tuple[str, Offer]]:
    """What an entry serves. A second name of a process serves its own endpoints, or without any what the process
    serves."""
    owner = drafts.of(instance)
    own = {pair.name for pair in instance.entry.endpoints} if instance.process else set()
    for offer in owner.offers if owner else ():
        if not own or offer.adapter in own:
            yield offer.adapter, offer


def _of_group(drafts: Drafts, group: LinkedGroup, draft: Draft) -> Iterator[tuple[str, Offer]]:
    """What a group serves: to processes outside what it exposes, under its own names; to its members, everything."""
    is_outside = group.is_closed and draft.instance not in group.members
    names = {(one.instance.process or one.instance, one.adapter): one.name for one in group.serves}
    owners = dict.fromkeys(owner for member in group.members if (owner := drafts.of(member)))
    for offer in (offer for owner in owners for offer in owner.offers):
        name = names.get((offer.owner.instance, offer.adapter))
        if name is not None if is_outside else offer.port or offer.explicit:
            yield name or offer.adapter, offer
