"""Expands a deployment: instances, included documents, and the host of each.

The errors of a document are reported when that document itself is expanded, not again for each document that includes
it. Only errors that the two documents make together are reported for the including one.
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
    """A document in its scope, with its instances and groups. `chain` are the real paths of the documents that include
    it, the outermost first; `span` is the location of the include. `hosts` are its own hosts or, if it has none, those
    of the including document; `only` is the host of entries that name none. `is_whole` holds if no error hides a name
    of the scope, `is_homeless` if it is reported that the entries have no host.
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
        """Whether this is the document of the deployment itself, not an included one."""
        return not self.chain


class Expansion(msgspec.Struct):
    """Expands one deployment. `deployments` are all usable documents by real path; `documents` are those of which this
    deployment consists, and `included` are the instances that each group has from its `include:`."""

    root: LinkedDeployment
    tables: Tables
    deployments: Mapping[str, Deployment]
    disk: Disk
    documents: list[ExpandedDocument] = []
    included: dict[LinkedGroup, list[LinkedInstance]] = {}
    diagnostics: list[Diagnostic] = []
    _in_order: list[LinkedInstance] = []
    _hosts: dict[str, Host] = {}
    _storms: dict[str, LinkedStorm] = {}
    _groups: dict[str, LinkedGroup] = {}
    _names: dict[str, dict[str, tuple[Target, ...]]] = {}

    def run(self) -> None:
        self._expand(ExpandedDocument(self.root.deployment))
        tie(
            self.root,
            hosts=self._hosts,
            instances={one.name: one for one in self._in_order},
            storms=self._storms,
            groups=self._groups,
            names=self._names,
            documents=tuple(expanded.document for expanded in self.documents),
        )

    def _expand(self, expanded: ExpandedDocument) -> None:
        document = expanded.document
        self.documents.append(expanded)
        self._names.setdefault(expanded.scope, {})
        for host in document.hosts:
            self._merge_host(host, expanded)
        if document.hosts:
            expanded.hosts = {host.name: host for host in document.hosts}
        if expanded.only is None and len(expanded.hosts) == 1:
            expanded.only = next(iter(expanded.hosts.values()))
        for storm in document.services:
            linked = LinkedStorm(expanded.scope + storm.name, storm, document, expanded.scope)
            storm_host, is_unknown = self._host(expanded, storm.host, storm.name, storm.span)
            tie(linked, host=storm_host, broken=is_unknown)
            if self._define(expanded, storm.name, linked, storm.span):
                self._storms[linked.name] = linked
        for entry in document.entries:
            self._expand_entry(expanded, entry)
        for group in document.groups:
            self._expand_group(expanded, LinkedGroup(expanded.scope + group.name, group, document, expanded.scope))
        seen: set[str] = set()
        for include in document.includes:
            real = self._expand_include(expanded, include, expanded.scope, expanded.only, seen)
            seen.add(real)

    def _expand_entry(self, expanded: ExpandedDocument, entry: Entry) -> None:
        if (INDEX in entry.name) != (entry.instances is not None):
            if entry.instances is None:
                self._report(expanded, codes.STRAY_INDEX, entry.span, name=entry.name, hint="add `instances:`")
            else:
                hint = f"rename it to '{entry.name}{INDEX}'"
                self._report(expanded, codes.NO_INDEX, entry.instances_span, name=entry.name, hint=hint)
            tie(self.root, broken=True)
            expanded.is_whole = False  # the names of its instances are unknown
            return
        every: list[Target] = []
        for number in (None,) if entry.instances is None else range(entry.instances):
            one = entry if number is None else _instance(entry, number)
            linked = LinkedInstance(expanded.scope + one.name, one, expanded.document, expanded.scope, number)
            if self._define(expanded, one.name, linked, entry.span):
                every.append(linked)
                self._in_order.append(linked)
                expanded.instances.append(linked)
                if entry.kind != PROCESS:
                    host, is_unknown = self._host(expanded, one.host, one.name, one.span)
                    tie(linked, host=host, broken=is_unknown)
                self._link(expanded, linked)
        if entry.instances is not None:
            self._names[expanded.scope][entry.name] = tuple(every)

    def _link(self, expanded: ExpandedDocument, linked: LinkedInstance) -> None:
        """Links the instance's component and configuration. `DeploymentDocuments` has reported missing ones."""
        entry, component = linked.entry, ""
        if entry.kind == COMPONENT:
            components = paths.component_paths(expanded.document, entry.target.text, self.disk)
            if len(components) == 1:
                component = components[0]
                tie(linked, component=self.tables.components.get(os.path.realpath(component)))
            tie(linked, broken=linked.broken or linked.component is None)
        tie(linked, folder=paths.entry_folder(expanded.document, entry, component))
        config = self._config(expanded.document, linked)
        if config and linked.component is not None and paths.is_values(config):
            self._link_values(expanded, linked, linked.component, config)
        elif config:
            tie(linked, flat=config)

    def _config(self, document: Deployment, linked: LinkedInstance) -> str:
        if linked.entry.config is None:
            default = paths.joined(linked.folder, os.path.join("etc", "config.yaml"))
            return default if linked.component is not None and os.path.realpath(default) in self.tables.values else ""
        candidates = paths.config_paths(document, linked.folder, linked.entry.config.text)
        config = next((path for path in candidates if self.disk.has_file(path)), "")
        tie(linked, broken=linked.broken or not config)
        return config

    def _link_values(
        self, expanded: ExpandedDocument, linked: LinkedInstance, component: LinkedComponent, path: str
    ) -> None:
        values = self.tables.values.get(os.path.realpath(path))
        tie(linked, values=values)
        if values is None:
            tie(linked, broken=True)
            return
        if linked.entry.settings is not None:
            tie(values, is_extended=True)  # `set:` has the missing values
        if values.parameters is None:  # values without a component belong to the component that uses them
            tie(values, parameters=component.parameters)
        elif values.parameters is component.parameters:
            pass
        elif _is_for(values, component):
            own = LinkedValues(values.document, values.extends, component.parameters, values.is_extended, values.broken)
            tie(linked, values=own)
        else:
            config, other = linked.entry.config, values.parameters.component
            self._report(
                expanded,
                codes.OTHER_VALUES,
                config.span if config else linked.entry.span,
                other=other.component.name if other else "another component",
                component=component.component.name,
                hint="a component cannot use the values of another one: see `component:` in that document",
            )
            tie(linked, values=None, broken=True)

    def _expand_group(self, expanded: ExpandedDocument, linked: LinkedGroup) -> None:
        group = linked.group
        if not self._define(expanded, group.name, linked, group.span):
            return
        self._groups[linked.name] = linked
        expanded.groups.append(linked)
        host, is_unknown = expanded.only, False
        if group.host is not None:
            host, is_unknown = self._host(expanded, group.host, group.name, group.span)
            tie(linked, broken=is_unknown)
        if group.facade is not None:
            facades = paths.component_paths(expanded.document, group.facade.text, self.disk)
            facade = self.tables.components.get(os.path.realpath(facades[0])) if len(facades) == 1 else None
            tie(linked, facade=facade, broken=linked.broken or facade is None)
        if group.include is not None:
            whole, before = expanded.is_whole, len(self._in_order)
            is_usable = self._expand_include(
                expanded, group.include, f"{linked.name}.", host, set(), is_homeless=is_unknown
            )
            tie(linked, broken=linked.broken or not is_usable)
            expanded.is_whole = whole
            self.included[linked] = self._in_order[before:]

    def _expand_include(
        self,
        expanded: ExpandedDocument,
        include: Text,
        scope: str,
        host: Host | None,
        seen: set[str],
        *,
        is_homeless: bool = False,
    ) -> str:
        """Expands an included deployment in a scope. Returns its real path, or '' if it cannot be used."""
        path = paths.include_path(expanded.document, include.text, self.disk)
        real = os.path.realpath(path) if path else ""
        target = self.deployments.get(real)
        chain = (*expanded.chain, os.path.realpath(expanded.document.path))
        if target is not None and real in chain:
            if real == chain[0] == min(chain):  # each cycle is reported once
                cycle = " → ".join(os.path.basename(one) for one in (*chain, real))
                self.diagnostics.append(
                    codes.INCLUDE_CYCLE.at(
                        include.span, path=include.text, cycle=cycle, hint="remove one of these includes"
                    )
                )
            target = None
        if target is None:
            tie(self.root, broken=True)
            expanded.is_whole = False
            return ""
        if real in seen:
            self._report(expanded, codes.INCLUDED_TWICE, include.span, path=include.text)
            return real
        inner = ExpandedDocument(target, scope, chain, include.span, expanded.hosts, host, is_homeless=is_homeless)
        self._expand(inner)
        expanded.is_whole &= inner.is_whole
        return real if inner.is_whole else ""

    def _define(self, expanded: ExpandedDocument, name: str, target: Target, span: Span) -> bool:
        """Defines a name in the scope. Returns whether the name was free."""
        known = self._names[expanded.scope].get(name)
        if known is None:
            self._names[expanded.scope][name] = (target,)
            return True
        if expanded.is_own or any(other.document is not expanded.document for other in known):
            related = [Related("the first definition", _span_of(other)) for other in known[:1]]
            self.diagnostics.append(codes.DUPLICATE_NAME.at(span, name=name, related=related))
        return False

    def _merge_host(self, host: Host, expanded: ExpandedDocument) -> None:
        known = self._hosts.setdefault(host.name, host)
        if (known.address.text, known.user) != (host.address.text, host.user) and expanded.span is not None:
            self.diagnostics.append(
                codes.HOST_DIFFERS.at(
                    host.address.span,
                    name=host.name,
                    address=_ssh_address(host),
                    other=_ssh_address(known),
                    document=os.path.basename(host.address.span.file),
                    hint="rename one of the two hosts",
                    related=[
                        Related("the other host", known.address.span),
                        Related("the include", expanded.span),
                    ],
                )
            )

    def _host(self, expanded: ExpandedDocument, named: Text | None, name: str, span: Span) -> tuple[Host | None, bool]:
        """The host of an entry or service, and whether it is unknown."""
        if named is None:
            if expanded.only is None and expanded.hosts and (expanded.is_own or not expanded.document.hosts):
                self._no_host(expanded, name, span)
            return expanded.only, expanded.only is None and bool(expanded.hosts)
        hosts = expanded.hosts if expanded.document.hosts else {}
        if named.text not in hosts:
            hint = did_you_mean(
                named.text,
                hosts,
                otherwise=f"the hosts are {', '.join(hosts)}"
                if hosts
                else "`hosts:` defines hosts; without it, all processes run on this machine",
            )
            self._report(expanded, codes.UNKNOWN_HOST, named.span, name=named.text, hint=hint)
        return hosts.get(named.text), named.text not in hosts

    def _no_host(self, expanded: ExpandedDocument, name: str, span: Span) -> None:
        """Reports an entry without a host; for an included document only once, for all of its entries."""
        host = next(iter(expanded.hosts))
        if expanded.span is None:
            self.diagnostics.append(codes.NO_HOST.at(span, name=name, hint=f"add `host: {host}`, or another host"))
        elif not expanded.is_homeless:
            expanded.is_homeless = True
            path = os.path.basename(expanded.document.path)
            group = expanded.scope.rstrip(".").rpartition(".")[2] or path.partition(".")[0]
            self.diagnostics.append(
                codes.NO_HOST.at(
                    expanded.span,
                    name=expanded.scope.rstrip(".") or path,
                    hint=f"write `groups: {{{group}: {{include: {path}, host: {host}}}}}`, or `hosts:` in {path}",
                )
            )

    def _report(
        self, expanded: ExpandedDocument, code: Code, span: Span, *, hint: str | Hint = "", **facts: str
    ) -> None:
        if expanded.is_own:
            self.diagnostics.append(code.at(span, hint=hint, related=(), more="", fixes=(), **facts))


def _ssh_address(host: Host) -> str:
    return f"{host.user}@{host.address.text}" if host.user else host.address.text


def _is_for(values: LinkedValues, component: LinkedComponent) -> bool:
    """Whether a component can use the values of another one: both have the same parameter document, or the values name
    no component."""
    document = values.parameters.document if values.parameters else None
    is_shared = document is not None and document is component.parameters.document
    return is_shared or not any(layer.document.component for layer in values.layers())


def _span_of(target: Target) -> Span:
    if isinstance(target, LinkedInstance):
        return target.entry.span
    return target.storm.span if isinstance(target, LinkedStorm) else target.group.span


def _instance(entry: Entry, number: int) -> Entry:
    """The entry with `{i}` replaced by the number in every text."""
    return _replaced(entry, str(number))


def _replaced(part: _Part, number: str) -> _Part:
    replaced: object = part
    if isinstance(part, str):
        replaced = part.replace(INDEX, number)
    elif isinstance(part, tuple):
        replaced = tuple(_replaced(item, number) for item in part)
    elif isinstance(part, Node):
        replaced = _tree(part, number)
    elif isinstance(part, msgspec.Struct) and not isinstance(part, Span):
        replaced = replace(part, **{name: _replaced(getattr(part, name), number) for name in part.__struct_fields__})
    return replaced  # type: ignore[return-value]


def _tree(node: Node, number: str) -> Node:
    """A tree with `{i}` replaced. `{i}` without quotes, which YAML parses as a mapping, becomes the number itself."""
    if isinstance(node, MappingNode):
        if node.data == {"i": None} and node.is_flow:
            scalar = text_at(node.span, number)
            scalar.data = int(number)
            return scalar
        entries = {}
        for name, value in node.items():
            key = name.lexeme.replace(INDEX, number)
            entries[key] = text_at(name.span, key), _tree(value, number)
        return mapping_at(node.span, entries)
    if isinstance(node, Sequence):
        return sequence_at(node.span, [_tree(item, number) for item in node.items])
    assert isinstance(node, Scalar)
    return text_at(node.span, node.lexeme.replace(INDEX, number)) if INDEX in node.lexeme else node
