"""Resolves the names in a deployment: second names of processes, `after:`, members of groups, ports."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.codes.networks import DEADLOCK
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.digraph import reachable
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.link.expand_deployments import ExpandedDocument
from robocomp_yaml.link.knot import grow, tie
from robocomp_yaml.model.deployment import CONFIG, INDEX, PROCESS, Entry, Number, Pair
from robocomp_yaml.model.located import Text


class DeploymentNames(msgspec.Struct):
    """Resolves the names in the documents of a deployment. `included` are the members that groups include."""

    root: LinkedDeployment
    documents: Iterable[ExpandedDocument]
    included: Mapping[LinkedGroup, Iterable[LinkedInstance]]
    diagnostics: list[Diagnostic] = []

    def resolve(self) -> None:
        direct: dict[LinkedGroup, list[Target]] = {}
        for part in self.documents:
            for group in part.groups:
                direct[group] = list(self._direct(part, group))
        for part in self.documents:
            for group in part.groups:
                self._fill(part, group, direct)
        for part in self.documents:
            for instance in part.instances:
                self._processes(part, instance)
                for name in instance.entry.after:
                    for target in self._find(part, name, "`after:`", instance) or ():
                        if target is instance and part.is_own and instance.entry.instances is None:
                            circle = f"{instance.name} → {instance.name}"
                            self.diagnostics.append(DEADLOCK.at(name.span, circle=circle, hint="remove it"))
                        grow(instance, "after", *(target.members if isinstance(target, LinkedGroup) else [target]))
                if part.is_own and not instance.number:  # the same for all instances of an entry
                    self.diagnostics += _ports(instance)
                    self.diagnostics += [*_patterns(instance.entry), *_programs(instance.entry)]

    def _direct(self, part: ExpandedDocument, group: LinkedGroup) -> Iterator[Target]:
        for name in group.group.members:
            for target in self._find(part, name, f"the group '{group.group.name}'", group) or ():
                if isinstance(target, LinkedStorm):
                    hint = Hint("a service cannot be a member of a group")
                    self._unknown(part, name, f"the group '{group.group.name}'", hint)
                else:
                    yield target
        yield from self.included.get(group, ())
        if group in self.included:
            yield from (inner for inner in self.root.groups.values() if inner.name.startswith(f"{group.name}."))

    def _fill(self, part: ExpandedDocument, group: LinkedGroup, direct: dict[LinkedGroup, list[Target]]) -> None:
        """Sets the members of a group: its own instances, and those of its inner groups."""

        def into(target: Target) -> Iterable[Target]:
            return direct.get(target, ()) if isinstance(target, LinkedGroup) and target is not group else ()

        targets = list(reachable(direct[group], into))
        if group in targets:
            before = [group, *targets[: targets.index(group)]]
            if part.is_own and not any(isinstance(other, LinkedGroup) and other.broken for other in before):
                self.diagnostics.append(codes.GROUP_CYCLE.at(group.group.span, name=group.group.name))
            tie(group, broken=True)
        members = [target for target in targets if isinstance(target, LinkedInstance)]
        for target in members:
            grow(target, "groups", group)
        inner = [target for target in targets if isinstance(target, LinkedGroup) and target is not group]
        tie(group, members=tuple(members), inner=tuple(inner))

    def _processes(self, part: ExpandedDocument, instance: LinkedInstance) -> None:
        if instance.entry.kind != PROCESS:
            return
        name = instance.entry.target
        targets = self._find(part, name, "`process:`", instance)
        target = targets[0] if targets and len(targets) == 1 else None
        if isinstance(target, LinkedInstance) and target.entry.kind != PROCESS:
            tie(instance, process=target, host=target.host)
            return
        tie(instance, broken=True)
        if targets and part.is_own:
            self.diagnostics.append(codes.NOT_A_PROCESS.at(name.span, name=name.text, what=_kind_of(targets)))

    def _find(
        self, part: ExpandedDocument, name: Text, where: str, source: LinkedInstance | LinkedGroup
    ) -> tuple[Target, ...] | None:
        """The targets of a name; None if it is unknown, which is reported if this document is the cause."""
        targets, behind = self.root.find(name.text, part.scope)
        if targets and not behind:
            return targets
        tie(source, broken=True)
        hides = any(isinstance(target, LinkedGroup) and target.broken for target in targets)
        if part.is_whole and not hides:
            written, entries = _as_written(part, name), [entry.name for entry in part.document.entries]
            is_instance = isinstance(source, LinkedInstance) and source.number is not None
            if is_instance and INDEX in written.text and written.text not in entries:  # in all instances alike
                hint = did_you_mean(written.text, [one for one in entries if INDEX in one])
                self._unknown(part, written, where, hint if hint.meant else self._hint(part, name.text, source.name))
            else:
                self._unknown(part, name, where, self._hint(part, name.text, source.name))
        return None

    def _unknown(self, part: ExpandedDocument, name: Text, where: str, hint: Hint) -> None:
        if part.is_own:
            self.diagnostics.append(codes.UNKNOWN_NAME.at(name.span, where=where, name=name.text, hint=hint))

    def _hint(self, part: ExpandedDocument, text: str, own: str) -> Hint:
        if INDEX in text:
            return Hint(f"only an entry with `instances:` replaces {INDEX}")
        names = [
            scope.removeprefix(part.scope) + name
            for scope, names in self.root.names.items()
            if scope.startswith(part.scope)
            for name in names
            if scope + name != own
        ]
        return did_you_mean(text, names)


def _as_written(part: ExpandedDocument, name: Text) -> Text:
    """The name as it is in the document, in which {i} may stand for the number of the instance."""
    texts = (text for entry in part.document.entries for text in (*entry.after, entry.target))
    return next((text for text in texts if text is not None and text.span == name.span), name)


def _kind_of(targets: tuple[Target, ...]) -> str:
    if len(targets) > 1:
        return "an entry with instances"
    if isinstance(targets[0], LinkedGroup):
        return "a group"
    return "a service" if isinstance(targets[0], LinkedStorm) else "itself a second name"


def _ports(instance: LinkedInstance) -> Iterator[Diagnostic]:
    """Reports keys under `connect`, `topics`, `ports` and `endpoints` that name no port of the component."""
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
        otherwise = f"it has {', '.join(names)}" if names else ""
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
                text.span,
                text=text.text,
                hint=f'name the program that reads it, such as `program: python3, args: ["{CONFIG}"]`',
            )
