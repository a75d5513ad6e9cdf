"""What the names in a deployment mean: second names of processes, what to wait for, members of groups, ports."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.digraph import reached
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.link.expand_deployments import ExpandedDocument
from robocomp_yaml.link.knot import grow, tie
from robocomp_yaml.model.deployment import CONFIG, INDEX, PROCESS, Entry, Number, Pair
from robocomp_yaml.model.located import Text


class DeploymentNames(msgspec.Struct):
    """Resolves what the documents of a deployment name. `included` are the members that groups have by an include."""

    root: LinkedDeployment
    placed: Iterable[ExpandedDocument]
    included: Mapping[LinkedGroup, Iterable[LinkedInstance]]
    diagnostics: list[Diagnostic] = []

    def resolve(self) -> None:
        inside: dict[LinkedGroup, list[Target]] = {}
        for here in self.placed:
            for group in here.groups:
                inside[group] = list(self._direct(here, group))
        for here in self.placed:
            for group in here.groups:
                self._fill(here, group, inside)
        for here in self.placed:
            for instance in here.instances:
                self._processes(here, instance)
                for named in instance.entry.after:
                    for target in self._find(here, named, "`after:`", instance) or ():
                        grow(instance, "after", *(target.members if isinstance(target, LinkedGroup) else [target]))
                if here.is_own and not instance.number:  # what one instance says, all of them do
                    self.diagnostics += _ports(instance)
                    self.diagnostics += [*_patterns(instance.entry), *_programs(instance.entry)]

    def _direct(self, here: ExpandedDocument, group: LinkedGroup) -> Iterator[Target]:
        for named in group.group.members:
            for target in self._find(here, named, f"the group '{group.group.name}'", group) or ():
                if isinstance(target, LinkedStorm):
                    self._unknown(here, named, f"the group '{group.group.name}'", Hint("a service belongs to no group"))
                else:
                    yield target
        yield from self.included.get(group, ())
        if group in self.included:
            yield from (inner for inner in self.root.groups.values() if inner.name.startswith(f"{group.name}."))

    def _fill(self, here: ExpandedDocument, group: LinkedGroup, inside: dict[LinkedGroup, list[Target]]) -> None:
        """All instances in a group, those of its inner groups too."""

        def into(target: Target) -> Iterable[Target]:
            return inside.get(target, ()) if isinstance(target, LinkedGroup) and target is not group else ()

        found = list(reached(inside[group], into))
        if group in found:
            before = [group, *found[: found.index(group)]]
            if here.is_own and not any(isinstance(other, LinkedGroup) and other.broken for other in before):
                self.diagnostics.append(codes.GROUP_CYCLE.at(group.group.span, name=group.group.name))
            tie(group, broken=True)
        members = [target for target in found if isinstance(target, LinkedInstance)]
        for target in members:
            grow(target, "groups", group)
        inner = [target for target in found if isinstance(target, LinkedGroup) and target is not group]
        tie(group, members=tuple(members), inner=tuple(inner))

    def _processes(self, here: ExpandedDocument, instance: LinkedInstance) -> None:
        if instance.entry.kind != PROCESS:
            return
        named = instance.entry.target
        found = self._find(here, named, "`process:`", instance)
        target = found[0] if found and len(found) == 1 else None
        if isinstance(target, LinkedInstance) and target.entry.kind != PROCESS:
            tie(instance, process=target, host=target.host)
            return
        tie(instance, broken=True)
        if found and here.is_own:
            self.diagnostics.append(codes.NOT_A_PROCESS.at(named.span, name=named.text, what=_kind_of(found)))

    def _find(
        self, here: ExpandedDocument, named: Text, where: str, source: LinkedInstance | LinkedGroup
    ) -> tuple[Target, ...] | None:
        """What a name means; None (told, where it is this document's fault) when it means nothing."""
        found, behind = self.root.find(named.text, here.scope)
        if found and not behind:
            return found
        tie(source, broken=True)
        hides = any(isinstance(target, LinkedGroup) and target.broken for target in found)
        if here.is_whole and not hides:
            self._unknown(here, named, where, self._hint(here, named.text, source.name))
        return None

    def _unknown(self, here: ExpandedDocument, named: Text, where: str, hint: Hint) -> None:
        if here.is_own:
            self.diagnostics.append(codes.UNKNOWN_NAME.at(named.span, where=where, name=named.text, hint=hint))

    def _hint(self, here: ExpandedDocument, text: str, own: str) -> Hint:
        if INDEX in text:
            return Hint(f"{INDEX} counts in an entry that has `instances:` itself")
        names = [
            scope.removeprefix(here.scope) + name
            for scope, names in self.root.names.items()
            if scope.startswith(here.scope)
            for name in names
            if scope + name != own
        ]
        return did_you_mean(text, names)


def _kind_of(found: tuple[Target, ...]) -> str:
    if len(found) > 1:
        return "an entry with instances"
    if isinstance(found[0], LinkedGroup):
        return "a group"
    return "a service" if isinstance(found[0], LinkedStorm) else "itself a second name"


def _ports(instance: LinkedInstance) -> Iterator[Diagnostic]:
    """Every name that an entry says something about is one of its component's."""
    linked, entry = instance.component, instance.entry
    if linked is None or linked.broken:
        return
    served = ["CommonBehavior", *(port.name for port in (*linked.implements, *linked.subscribes))]
    topics = [port.name for port in (*linked.publishes, *linked.subscribes)]
    keyed: list[tuple[str, list[str], Iterable[Pair | Number]]] = [
        ("proxy", [port.name for port in linked.requires], entry.connect),
        ("topic", topics, entry.topics),
        ("interface", served, entry.ports),
        ("interface", served, entry.endpoints),
    ]
    for what, names, keys in keyed:
        otherwise = f"there are {', '.join(names)}" if names else ""
        for key in keys:
            if key.name not in names:
                yield codes.UNKNOWN_PORT.at(
                    key.name_span,
                    component=linked.component.name,
                    what=what,
                    name=key.name,
                    hint=did_you_mean(key.name, names, {other.name for other in keys}, otherwise=otherwise),
                    related=[Related("the component", linked.component.span)],
                )


def _patterns(entry: Entry) -> Iterator[Diagnostic]:
    if entry.ready is not None and entry.ready.log:
        try:
            re.compile(entry.ready.log)
        except (re.error, OverflowError, RecursionError) as error:
            yield codes.BAD_PATTERN.at(entry.ready.span, pattern=entry.ready.log, problem=error)


def _programs(entry: Entry) -> Iterator[Diagnostic]:
    for text in (entry.target, entry.executable):
        if text is not None and CONFIG in text.text:
            yield codes.CONFIG_AS_PROGRAM.at(
                text.span, text=text.text, hint=f'name what reads it, such as `program: python3, args: ["{CONFIG}"]`'
            )
