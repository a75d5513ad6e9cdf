"""A deployment's document becomes a `LinkedDeployment`: instances counted out, includes in their places, all on hosts.

What is wrong with a document is told when it is expanded itself, not once more for each that includes it; here that is
told which only the two together make wrong.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TypeVar

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link import deployment_paths as paths
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Tables
from robocomp_yaml.model.deployment import COMPONENT, INDEX, PROCESS, Deployment, Entry, Host
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar, Sequence, mapping_at, sequence_at, text_at

_Part = TypeVar("_Part")


class ExpandedDocument(msgspec.Struct):
    """A document in its scope, and what it put there. `chain` are the real paths of the documents around it, the
    outermost first, and `span` is where it is included. `hosts` are its own or, where it has none, those around it;
    `only` is the host of what names none. `is_whole` when nothing has errors that could hide a name of this scope,
    `is_homeless` when it has been told that there is none of several hosts for what it holds, or no such host.
    """

    document: Deployment
    scope: str = ""
    chain: tuple[str, ...] = ()
    span: Span | None = None
    hosts: Mapping[str, Host] = {}
    only: Host | None = None
    instances: list[LinkedInstance] = []
    groups: list[LinkedGroup] = []
    is_whole: bool = True
    is_homeless: bool = False

    @property
    def is_own(self) -> bool:
        """Whether this is the deployment's own document."""
        return not self.chain


class Expansion(msgspec.Struct):
    """Puts documents in their places. `deployments` are those that could be read, by real path; `placed` are those
    that this one consists of, and `included` is what groups have from the documents that they include."""

    root: LinkedDeployment
    tables: Tables
    deployments: Mapping[str, Deployment]
    disk: Disk
    placed: list[ExpandedDocument] = []
    included: dict[LinkedGroup, list[LinkedInstance]] = {}
    diagnostics: list[Diagnostic] = []
    _in_order: list[LinkedInstance] = []
    _hosts: dict[str, Host] = {}
    _storms: dict[str, LinkedStorm] = {}
    _groups: dict[str, LinkedGroup] = {}
    _names: dict[str, dict[str, tuple[Target, ...]]] = {}

    def run(self) -> None:
        self._place(ExpandedDocument(self.root.deployment))
        tie(
            self.root,
            hosts=self._hosts,
            instances={one.name: one for one in self._in_order},
            storms=self._storms,
            groups=self._groups,
            names=self._names,
            documents=tuple(here.document for here in self.placed),
        )

    def _place(self, here: ExpandedDocument) -> None:
        document = here.document
        self.placed.append(here)
        self._names.setdefault(here.scope, {})
        for host in document.hosts:
            self._merge_host(host, here)
        if document.hosts:
            here.hosts = {host.name: host for host in document.hosts}
        if here.only is None and len(here.hosts) == 1:
            here.only = next(iter(here.hosts.values()))
        for storm in document.services:
            linked = LinkedStorm(here.scope + storm.name, storm, document, here.scope)
            place, is_unknown = self._host(here, storm.host, storm.name, storm.span)
            tie(linked, host=place, broken=is_unknown)
            if self._name(here, storm.name, linked, storm.span):
                self._storms[linked.name] = linked
        for entry in document.entries:
            self._place_entry(here, entry)
        for group in document.groups:
            self._place_group(here, LinkedGroup(here.scope + group.name, group, document, here.scope))
        seen: set[str] = set()
        for include in document.includes:
            real = self._place_include(here, include, here.scope, here.only, seen)
            seen.add(real)

    def _place_entry(self, here: ExpandedDocument, entry: Entry) -> None:
        if (INDEX in entry.name) != (entry.instances is not None):
            if entry.instances is None:
                self._say(here, codes.STRAY_INDEX, entry.span, name=entry.name, hint="add `instances:`")
            else:
                hint = f"call it '{entry.name}{INDEX}'"
                self._say(here, codes.NO_INDEX, entry.instances_span, name=entry.name, hint=hint)
            tie(self.root, broken=True)
            here.is_whole = False  # what its instances are called is not known
            return
        every: list[Target] = []
        for number in (None,) if entry.instances is None else range(entry.instances):
            one = entry if number is None else _instance(entry, number)
            linked = LinkedInstance(here.scope + one.name, one, here.document, here.scope, number)
            if self._name(here, one.name, linked, entry.span):
                every.append(linked)
                self._in_order.append(linked)
                here.instances.append(linked)
                if entry.kind != PROCESS:
                    host, is_unknown = self._host(here, one.host, one.name, one.span)
                    tie(linked, host=host, broken=is_unknown)
                self._link(here, linked)
        if entry.instances is not None:
            self._names[here.scope][entry.name] = tuple(every)

    def _link(self, here: ExpandedDocument, linked: LinkedInstance) -> None:
        """The instance's component and configuration; what is not there has been told where it was looked for."""
        entry, component = linked.entry, ""
        if entry.kind == COMPONENT:
            found = paths.component_paths(here.document, entry.target.text, self.disk)
            if len(found) == 1:
                component = found[0]
                tie(linked, component=self.tables.components.get(os.path.realpath(component)))
            tie(linked, broken=linked.broken or linked.component is None)
        tie(linked, folder=paths.entry_folder(here.document, entry, component))
        config = self._config(here.document, linked)
        if config and linked.component is not None and paths.is_values(config):
            self._give_values(here, linked, linked.component, config)
        elif config:
            tie(linked, flat=config)

    def _config(self, document: Deployment, linked: LinkedInstance) -> str:
        if linked.entry.config is None:
            usual = paths.joined(linked.folder, os.path.join("etc", "config.yaml"))
            return usual if linked.component is not None and os.path.realpath(usual) in self.tables.values else ""
        places = paths.config_paths(document, linked.folder, linked.entry.config.text)
        found = next((path for path in places if self.disk.has_file(path)), "")
        tie(linked, broken=linked.broken or not found)
        return found

    def _give_values(
        self, here: ExpandedDocument, linked: LinkedInstance, component: LinkedComponent, path: str
    ) -> None:
        values = self.tables.values.get(os.path.realpath(path))
        tie(linked, values=values)
        if values is None:
            tie(linked, broken=True)
            return
        if linked.entry.settings is not None:
            tie(values, is_extended=True)  # `set:` completes what it lacks
        if values.parameters is None:  # a document that names no component is that of whoever takes it
            tie(values, parameters=component.parameters)
        elif values.parameters is component.parameters:
            pass
        elif _is_for(values, component):
            own = LinkedValues(values.document, values.extends, component.parameters, values.is_extended, values.broken)
            tie(linked, values=own)
        else:
            config, other = linked.entry.config, values.parameters.component
            self._say(
                here,
                codes.OTHER_VALUES,
                config.span if config else linked.entry.span,
                other=other.component.name if other else "another component",
                component=component.component.name,
                hint="each component has values of its own: see `component:` in this document",
            )
            tie(linked, values=None, broken=True)

    def _place_group(self, here: ExpandedDocument, linked: LinkedGroup) -> None:
        group = linked.group
        if not self._name(here, group.name, linked, group.span):
            return
        self._groups[linked.name] = linked
        here.groups.append(linked)
        host, is_unknown = here.only, False
        if group.host is not None:
            host, is_unknown = self._host(here, group.host, group.name, group.span)
            tie(linked, broken=is_unknown)
        if group.facade is not None:
            found = paths.component_paths(here.document, group.facade.text, self.disk)
            facade = self.tables.components.get(os.path.realpath(found[0])) if len(found) == 1 else None
            tie(linked, facade=facade, broken=linked.broken or facade is None)
        if group.include is not None:
            whole, before = here.is_whole, len(self._in_order)
            is_placed = self._place_include(here, group.include, f"{linked.name}.", host, set(), is_homeless=is_unknown)
            tie(linked, broken=linked.broken or not is_placed)
            here.is_whole = whole
            self.included[linked] = self._in_order[before:]

    def _place_include(
        self,
        here: ExpandedDocument,
        include: Text,
        scope: str,
        host: Host | None,
        seen: set[str],
        *,
        is_homeless: bool = False,
    ) -> str:
        """Puts an included deployment into a scope; its real path, or '' where it cannot be used."""
        path = paths.include_path(here.document, include.text, self.disk)
        real = os.path.realpath(path) if path else ""
        target = self.deployments.get(real)
        chain = (*here.chain, os.path.realpath(here.document.path))
        if target is not None and real in chain:
            if real == chain[0] == min(chain):  # each cycle is told once
                cycle = " → ".join(os.path.basename(one) for one in (*chain, real))
                self.diagnostics.append(
                    codes.INCLUDE_CYCLE.at(
                        include.span, path=include.text, cycle=cycle, hint="leave one of these includes out"
                    )
                )
            target = None
        if target is None:
            tie(self.root, broken=True)
            here.is_whole = False
            return ""
        if real in seen:
            self._say(here, codes.INCLUDED_TWICE, include.span, path=include.text)
            return real
        inner = ExpandedDocument(target, scope, chain, include.span, here.hosts, host, is_homeless=is_homeless)
        self._place(inner)
        here.is_whole &= inner.is_whole
        return real if inner.is_whole else ""

    def _name(self, here: ExpandedDocument, name: str, target: Target, span: Span) -> bool:
        """Gives a name its meaning; whether it was free."""
        known = self._names[here.scope].get(name)
        if known is None:
            self._names[here.scope][name] = (target,)
            return True
        if here.is_own or any(other.document is not here.document for other in known):
            related = [Related("it stands here first", _span_of(other)) for other in known[:1]]
            self.diagnostics.append(codes.DUPLICATE_NAME.at(span, name=name, related=related))
        return False

    def _merge_host(self, host: Host, here: ExpandedDocument) -> None:
        known = self._hosts.setdefault(host.name, host)
        if (known.address.text, known.user) != (host.address.text, host.user) and here.span is not None:
            self.diagnostics.append(
                codes.HOST_DIFFERS.at(
                    host.address.span,
                    name=host.name,
                    address=_reached(host),
                    other=_reached(known),
                    document=os.path.basename(host.address.span.file),
                    hint="one of the two needs another name",
                    related=[Related("the other one", known.address.span), Related("included here", here.span)],
                )
            )

    def _host(self, here: ExpandedDocument, named: Text | None, name: str, span: Span) -> tuple[Host | None, bool]:
        """The host of an entry or service, and whether that could not be told."""
        if named is None:
            if here.only is None and here.hosts and (here.is_own or not here.document.hosts):
                self._no_host(here, name, span)
            return here.only, here.only is None and bool(here.hosts)
        own = here.hosts if here.document.hosts else {}
        if named.text not in own:
            hint = did_you_mean(
                named.text,
                own,
                otherwise=f"there are {', '.join(own)}"
                if own
                else "`hosts:` names machines; without it all run on this one",
            )
            self._say(here, codes.UNKNOWN_HOST, named.span, name=named.text, hint=hint)
        return own.get(named.text), named.text not in own

    def _no_host(self, here: ExpandedDocument, name: str, span: Span) -> None:
        """Of an included document it is told once, for all that it holds."""
        host = next(iter(here.hosts))
        if here.span is None:
            self.diagnostics.append(codes.NO_HOST.at(span, name=name, hint=f"add `host: {host}`, or another"))
        elif not here.is_homeless:
            here.is_homeless = True
            path = os.path.basename(here.document.path)
            group = here.scope.rstrip(".").rpartition(".")[2] or path.partition(".")[0]
            self.diagnostics.append(
                codes.NO_HOST.at(
                    here.span,
                    name=here.scope.rstrip(".") or path,
                    hint=f"write `groups: {{{group}: {{include: {path}, host: {host}}}}}`, or `hosts:` in {path}",
                )
            )

    def _say(self, here: ExpandedDocument, code: Code, span: Span, *, hint: str | Hint = "", **facts: str) -> None:
        if here.is_own:
            self.diagnostics.append(code.at(span, hint=hint, related=(), more="", fixes=(), **facts))


def _reached(host: Host) -> str:
    return f"{host.user}@{host.address.text}" if host.user else host.address.text


def _is_for(values: LinkedValues, component: LinkedComponent) -> bool:
    """Whether values of another component are as good for this one: it has the same document of parameters, or they
    name no component."""
    document = values.parameters.document if values.parameters else None
    is_shared = document is not None and document is component.parameters.document
    return is_shared or not any(layer.document.component for layer in values.layers())


def _span_of(target: Target) -> Span:
    if isinstance(target, LinkedInstance):
        return target.entry.span
    return target.storm.span if isinstance(target, LinkedStorm) else target.group.span


def _instance(entry: Entry, number: int) -> Entry:
    """The entry's texts as its instance has them; ports are as written."""
    return _filled(entry, str(number))


def _filled(part: _Part, number: str) -> _Part:
    filled: object = part
    if isinstance(part, str):
        filled = part.replace(INDEX, number)
    elif isinstance(part, tuple):
        filled = tuple(_filled(item, number) for item in part)
    elif isinstance(part, Node):
        filled = _tree(part, number)
    elif isinstance(part, msgspec.Struct) and not isinstance(part, Span):
        filled = replace(part, **{name: _filled(getattr(part, name), number) for name in part.__struct_fields__})
    return filled  # type: ignore[return-value]


def _tree(node: Node, number: str) -> Node:
    """In values `{i}` without quotes, which YAML reads as a mapping, is the number itself."""
    if isinstance(node, MappingNode):
        if node.data == {"i": None} and node.is_flow:
            counted = text_at(node.span, number)
            counted.data = int(number)
            return counted
        entries = {}
        for name, value in node.items():
            key = name.lexeme.replace(INDEX, number)
            entries[key] = text_at(name.span, key), _tree(value, number)
        return mapping_at(node.span, entries)
    if isinstance(node, Sequence):
        return sequence_at(node.span, [_tree(item, number) for item in node.items])
    assert isinstance(node, Scalar)
    return text_at(node.span, node.lexeme.replace(INDEX, number)) if INDEX in node.lexeme else node
