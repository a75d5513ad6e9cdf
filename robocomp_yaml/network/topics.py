"""Topics: their names after renames and prefixes, the IceStorm that carries each, and who publishes and subscribes."""

from __future__ import annotations

import msgspec

from robocomp_yaml.addresses.interface_comparison import InterfaceComparison
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedStorm
from robocomp_yaml.link.program import Port
from robocomp_yaml.network.draft import Draft, Drafts, LocatedText, StormDraft
from robocomp_yaml.network.network import TOPIC, Connection
from robocomp_yaml.network.order import Dependence
from robocomp_yaml.network.topic_names import NamedEnd, full_names

_MANY = 6


class _TopicEnd(msgspec.Struct, frozen=True):
    """A port that publishes or subscribes to a topic, which its document calls `name`. For an external IceStorm,
    `storm` is None, and `manager` is the proxy of its topic manager."""

    draft: Draft
    port: Port
    is_out: bool
    name: str
    span: Span
    storm: StormDraft | None
    manager: str

    @property
    def named(self) -> NamedEnd:
        return NamedEnd(self.draft.name, self.draft.instance.scope, self.name, self.is_out)


class TopicConnections(msgspec.Struct):
    """Connects publishers and subscribers. `connections` are the connections, `needs` the dependences that follow."""

    drafts: Drafts
    comparison: InterfaceComparison
    connections: list[Connection] = []
    needs: list[Dependence] = []
    diagnostics: list[Diagnostic] = []
    _ends: dict[tuple[str, str], list[_TopicEnd]] = {}
    _several: list[list[LinkedStorm]] = []
    _without: list[Draft] = []

    def resolve(self) -> None:
        every: list[_TopicEnd] = []
        for draft in self.drafts.drafts.values():
            component = draft.instance.component
            if component is None or not (component.publishes or component.subscribes):
                continue
            storm, manager = self._storm(draft)
            if storm is not None:
                draft.manager = LocatedText(storm.proxy, draft.span)
                self.needs.append(Dependence(draft.name, storm.name, "", "TopicManager", draft.span))
            elif not manager:
                continue
            every += [self._end(draft, port, storm, manager, is_out=True) for port in component.publishes]
            every += [self._end(draft, port, storm, manager, is_out=False) for port in component.subscribes]
        for end, topic in zip(every, self._topics(every), strict=True):
            self._meet(end, topic)
        for (_, topic), ends in self._ends.items():
            self._compare(topic, ends)
        if self._without:
            self.diagnostics.append(self._no_storm())

    def _storm(self, draft: Draft) -> tuple[StormDraft | None, str]:
        """The IceStorm of the deployment, else the proxy of an external one, which the configuration names."""
        near = self.drafts.linked.storms_for(draft.instance)
        nearest = [storm for storm in near if storm.scope == near[0].scope]
        of_host = [storm for storm in nearest if self.drafts.storms[storm].host is draft.host]
        chosen = nearest if len(nearest) == 1 else of_host
        if len(chosen) == 1:
            return self.drafts.storms[chosen[0]], ""
        manager = draft.base.manager
        if nearest and nearest not in self._several:
            self._several.append(nearest)
            hint, storms = "keep only one of them: it serves all hosts", ", ".join(storm.name for storm in nearest)
            related = [Related(f"'{storm.name}'", storm.storm.span) for storm in nearest]
            several = codes.SEVERAL_STORMS.at(draft.span, hint=hint, related=related, source=draft.name, storms=storms)
            self.diagnostics.append(several)
        elif not nearest and not manager and not self.drafts.linked.is_included and self.drafts.complete:
            self._without.append(draft)
        return None, manager

    def _no_storm(self) -> Diagnostic:
        """One diagnostic for all components without an IceStorm."""
        first, *others = self._without
        component = first.instance.component
        assert component is not None
        port = (*component.publishes, *component.subscribes)[0]
        return codes.NO_STORM.at(
            first.span,
            source=first.name,
            does="publishes" if port in component.publishes else "subscribes to",
            topic=port.name,
            hint="add an IceStorm: `services: {storm: {icestorm: {}}}`" + _too(others),
            related=[Related(f"{port.name} is here", port.use.span)],
        )

    def _end(self, draft: Draft, port: Port, storm: StormDraft | None, manager: str, *, is_out: bool) -> _TopicEnd:
        for rename in (pair for pair in draft.instance.entry.topics if pair.name == port.name):
            draft.topics[port.name] = LocatedText(rename.text, rename.span)
            return _TopicEnd(draft, port, is_out, rename.text, rename.span, storm, manager)
        name = draft.base.topic(port.name, port.interface.name, is_out=is_out)
        return _TopicEnd(draft, port, is_out, name, draft.span, storm, manager)

    def _topics(self, every: list[_TopicEnd]) -> list[str]:
        """The full names of the ends' topics. With an external IceStorm, the names stay as in the documents, because
        other programs use them, too."""
        topics = [end.name for end in every]
        for storm in self.drafts.storms.values():
            carried = [index for index, end in enumerate(every) if end.storm is storm]
            ends = [every[index].named for index in carried]
            names = full_names(ends, self.drafts.linked.names, storm.linked.scope)
            for index, name in zip(carried, names, strict=True):
                topics[index] = name
        return topics

    def _meet(self, end: _TopicEnd, topic: str) -> None:
        draft, port, storm = end.draft, end.port, end.storm
        if topic != end.name:
            draft.topics[port.name] = LocatedText(topic, end.span)
        carrier, proxy = (storm.name, storm.proxy) if storm else ("", end.manager)
        interface = port.interface.name
        connection = Connection(draft.name, port.name, interface, carrier, TOPIC, topic, end.is_out, proxy, end.span)
        self.connections.append(connection)
        self._ends.setdefault((carrier or f":{end.manager}", topic), []).append(end)

    def _compare(self, topic: str, ends: list[_TopicEnd]) -> None:
        """All ends of a topic must have the same interface, and a topic with subscribers should have a publisher."""
        first = next((end for end in ends if end.is_out), ends[0])
        for end in ends:
            found = self.comparison.difference(first.port, end.port)
            if found is not None:
                hint = "let both import the same document, or rename one topic"
                source, target = end.draft.name, first.draft.name
                mismatch = codes.TOPIC_MISMATCH.at(
                    end.span, topic=topic, source=source, target=target, difference=found.message, hint=hint,
                    related=found.sides(target, source),
                )  # fmt: skip
                self.diagnostics.append(mismatch)
        is_closed = self.drafts.complete and not self.drafts.linked.is_included
        if first.is_out or not is_closed or not all(c.target for c in self.connections if c.topic == topic):
            return
        hint = self._other_names(first) + _too([end.draft for end in ends[1:]])
        related = [Related(f"subscribes to {first.port.name} here", first.port.use.span)]
        source = first.draft.name
        silent = codes.NOT_PUBLISHED.at(first.span, hint=hint, related=related, source=source, topic=topic)
        self.diagnostics.append(silent)

    def _other_names(self, end: _TopicEnd) -> str:
        """The hint for a topic that is not published: its interface is published under another name, or through another
        IceStorm."""
        names, storms = set(), set()
        for (_, topic), ends in self._ends.items():
            for other in ends:
                if other.is_out and other.port.interface.name == end.port.interface.name:
                    if other.storm is end.storm:
                        names.add(topic)
                    elif other.storm is not None:
                        storms.add(f"'{other.storm.name}'")
        if names:
            first = min(names)
            is_inside = end.storm is not None and end.draft.instance.scope != end.storm.linked.scope
            written = f"/{first}" if is_inside else first
            return f"the interface is published as {', '.join(sorted(names))}: `topics: {{{end.port.name}: {written}}}`"
        if storms:
            return (
                f"the interface is published through the IceStorm {', '.join(sorted(storms))}: use one IceStorm for all"
            )
        return "add the component that publishes it"


def _too(others: list[Draft]) -> str:
    """The end of a hint that names further components with the same fault."""
    if not others:
        return ""
    shown = [f"'{other.name}'" for other in others[:_MANY]]
    shown += [f"{len(others) - _MANY} more"] if len(others) > _MANY else []
    return f"; {', '.join(shown)} {'needs' if len(others) == 1 else 'need'} it, too"
