"""Expands a deployment: instances, included documents, and the host of each.

The errors of a document are reported when that document itself is part, not again for each document that includes
it. Only errors that the two documents make together are reported for the including one.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TypeVar

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link import deployment_paths as paths
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm, Target
from robocomp_yaml.link.flat_configs import flat_config
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Tables
from robocomp_yaml.model.deployment import COMPONENT, INDEX, PROCESS, Deployment, Entry, Host
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar, Sequence, mapping_at, sequence_at, text_at

_Part = TypeVar("_Part")
_HOST_KEYS = {"paths": "path", **{key: key for key in ("ssh", "env", "python", "limits", "systemd")}}
_NO_HOSTS = "`hosts:` defines hosts; without it, all processes run on this machine"


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
            documents=tuple(part.document for part in self.documents),
        )

    def _expand(self, part: ExpandedDocument) -> None:
        document = part.document
        self.documents.append(part)
        self._names.setdefault(part.scope, {})
        for host in document.hosts:
            self._merge_host(host, part)
        if document.hosts:
            part.hosts = {host.name: host for host in document.hosts}
        if part.only is None and len(part.hosts) == 1:
            part.only = next(iter(part.hosts.values()))
        for storm in document.services:
            linked = LinkedStorm(part.scope + storm.name, storm, document, part.scope)
            storm_host, is_unknown = self._host(part, storm.host, storm.name, storm.span)
            tie(linked, host=storm_host, broken=is_unknown)
            if self._define(part, storm.name, linked, storm.span):
                self._storms[linked.name] = linked
        for entry in document.entries:
            self._expand_entry(part, entry)
        for group in document.groups:
            self._expand_group(part, LinkedGroup(part.scope + group.name, group, document, part.scope))
        seen: set[str] = set()
        for include in document.includes:
            real = self._expand_include(part, include, part.scope, part.only, seen, no_host=False)
            seen.add(real)

    def _expand_entry(self, part: ExpandedDocument, entry: Entry) -> None:
        if (INDEX in entry.name) != (entry.instances is not None):
            if entry.instances is None:
                self._report(part, codes.STRAY_INDEX.at(entry.span, name=entry.name, hint="add `instances:`"))
            else:
                hint = f"rename it to '{entry.name}{INDEX}'"
                self._report(part, codes.NO_INDEX.at(entry.instances_span, name=entry.name, hint=hint))
            tie(self.root, broken=True)
            part.is_whole = False  # the names of its instances are unknown
            return
        every: list[Target] = []
        for number in (None,) if entry.instances is None else range(entry.instances):
            one = entry if number is None else _replaced(entry, str(number))
            linked = LinkedInstance(part.scope + one.name, one, part.document, part.scope, number)
            if self._define(part, one.name, linked, entry.span):
                every.append(linked)
                self._in_order.append(linked)
                part.instances.append(linked)
                if entry.kind != PROCESS:
                    host, is_unknown = self._host(part, one.host, one.name, one.span)
                    tie(linked, host=host, broken=is_unknown)
                self._link(part, linked)
        if entry.instances is not None:
            self._names[part.scope][entry.name] = tuple(every)

    def _link(self, part: ExpandedDocument, linked: LinkedInstance) -> None:
        """Links the instance's component and configuration. `DeploymentDocuments` has reported missing ones."""
        entry, component = linked.entry, ""
        if entry.kind == COMPONENT:
            components = paths.component_paths(part.document, entry.target.text, self.disk)
            if len(components) == 1:
                component = components[0]
                tie(linked, component=self.tables.components.get(self.disk.real(component)))
            tie(linked, broken=linked.broken or linked.component is None)
        tie(linked, folder=paths.entry_folder(part.document, entry, component))
        config = self._config(part.document, linked)
        if not config and entry.config is None and linked.component is not None:
            flat = flat_config(linked.folder, self.disk)
            tie(linked, flat=flat.path if flat is not None else "")
        if config and linked.component is not None and paths.is_values(config):
            self._link_values(part, linked, linked.component, config)
        elif config:
            tie(linked, flat=config)

    def _config(self, document: Deployment, linked: LinkedInstance) -> str:
        if linked.entry.config is None:
            default = paths.default_config(linked.folder)
            return default if linked.component is not None and self.disk.real(default) in self.tables.values else ""
        candidates = paths.config_paths(document, linked.folder, linked.entry.config.text)
        config = next((path for path in candidates if self.disk.has_file(path)), "")
        tie(linked, broken=linked.broken or not config)
        return config

    def _link_values(
        self, part: ExpandedDocument, linked: LinkedInstance, component: LinkedComponent, path: str
    ) -> None:
        values = self.tables.values.get(self.disk.real(path))
        tie(linked, values=values)
        if values is None:
            tie(linked, broken=True)
            return
        if values.parameters is None or values.parameters is component.parameters:
            pass
        elif _is_for(values, component):
            own = LinkedValues(values.document, values.extends, component.parameters, values.is_extended, values.broken)
            tie(linked, values=own)
        else:
            config, other = linked.entry.config, values.parameters.component
            fault = codes.OTHER_VALUES.at(
                config.span if config else linked.entry.span,
                other=other.component.name if other else "another component",
                component=component.component.name,
                hint="a component cannot use the values of another one: see `component:` in that document",
            )
            self._report(part, fault)
            tie(linked, values=None, broken=True)

    def _expand_group(self, part: ExpandedDocument, linked: LinkedGroup) -> None:
        group = linked.group
        if not self._define(part, group.name, linked, group.span):
            return
        self._groups[linked.name] = linked
        part.groups.append(linked)
        host, is_unknown = part.only, False
        if group.host is not None:
            host, is_unknown = self._host(part, group.host, group.name, group.span)
            tie(linked, broken=is_unknown)
        if group.facade is not None:
            facades = paths.component_paths(part.document, group.facade.text, self.disk)
            facade = self.tables.components.get(self.disk.real(facades[0])) if len(facades) == 1 else None
            tie(linked, facade=facade, broken=linked.broken or facade is None)
        if group.include is not None:
            whole, before = part.is_whole, len(self._in_order)
            is_usable = self._expand_include(part, group.include, f"{linked.name}.", host, set(), is_unknown)
            tie(linked, broken=linked.broken or not is_usable)
            part.is_whole = whole
            self.included[linked] = self._in_order[before:]

    def _expand_include(
        self, part: ExpandedDocument, include: Text, scope: str, host: Host | None, seen: set[str], no_host: bool
    ) -> str:
        """Expands an included deployment in a scope. Returns its real path, or '' if it cannot be used."""
        path = paths.include_path(part.document, include.text, self.disk)
        real = self.disk.real(path) if path else ""
        target = self.deployments.get(real)
        chain = (*part.chain, self.disk.real(part.document.path))
        if target is not None and real in chain:
            if real == chain[0] == min(chain):  # each cycle is reported once
                cycle = " → ".join(os.path.basename(one) for one in (*chain, real))
                hint = "remove one of these includes"
                self.diagnostics.append(codes.INCLUDE_CYCLE.at(include.span, path=include.text, cycle=cycle, hint=hint))
            target = None
        if target is None:
            tie(self.root, broken=True)
            part.is_whole = False
            return ""
        if real in seen:
            self._report(part, codes.INCLUDED_TWICE.at(include.span, path=include.text))
            return real
        inner = ExpandedDocument(target, scope, chain, include.span, part.hosts, host, is_homeless=no_host)
        self._expand(inner)
        part.is_whole &= inner.is_whole
        return real if inner.is_whole else ""

    def _define(self, part: ExpandedDocument, name: str, target: Target, span: Span) -> bool:
        """Defines a name in the scope. Returns whether the name was free."""
        known = self._names[part.scope].get(name)
        if known is None:
            self._names[part.scope][name] = (target,)
            return True
        if part.is_own or any(other.document is not part.document for other in known):
            related = [Related("the first definition", _span_of(other)) for other in known[:1]]
            self.diagnostics.append(codes.DUPLICATE_NAME.at(span, name=name, related=related))
        return False

    def _merge_host(self, host: Host, part: ExpandedDocument) -> None:
        known = self._hosts.setdefault(host.name, host)
        if host.user and host.ssh.user:
            self._report(part, codes.TWO_USERS.at(host.ssh.span, name=host.name, hint="remove one of the two"))
        if part.span is None:
            return
        related = [Related("the other host", known.address.span), Related("the include", part.span)]
        if _ssh_address(known) != _ssh_address(host):
            fault = codes.HOST_DIFFERS.at(
                host.address.span,
                name=host.name,
                address=_ssh_address(host),
                other=_ssh_address(known),
                document=os.path.basename(host.address.span.file),
                hint="rename one of the two hosts",
                related=related,
            )
            self.diagnostics.append(fault)
        elif key := next((key for key in _HOST_KEYS if getattr(known, key) != getattr(host, key)), ""):
            hint = "write it in the including document only, or the same in both"
            fault = codes.HOST_KEY_DIFFERS.at(
                host.span,
                name=host.name,
                key=_HOST_KEYS[key],
                document=os.path.basename(host.address.span.file),
                hint=hint,
                related=related,
            )
            self.diagnostics.append(fault)

    def _host(self, part: ExpandedDocument, named: Text | None, name: str, span: Span) -> tuple[Host | None, bool]:
        """The host of an entry or service, and whether it is unknown."""
        if named is None:
            if part.only is None and part.hosts and (part.is_own or not part.document.hosts):
                self._no_host(part, name, span)
            return part.only, part.only is None and bool(part.hosts)
        hosts = part.hosts if part.document.hosts else {}
        if named.text not in hosts:
            otherwise = f"the hosts are {', '.join(hosts)}" if hosts else _NO_HOSTS
            hint = did_you_mean(named.text, hosts, otherwise=otherwise)
            self._report(part, codes.UNKNOWN_HOST.at(named.span, name=named.text, hint=hint))
        return hosts.get(named.text), named.text not in hosts

    def _no_host(self, part: ExpandedDocument, name: str, span: Span) -> None:
        """Reports an entry without a host; for an included document only once, for all of its entries."""
        host = next(iter(part.hosts))
        if part.span is None:
            self.diagnostics.append(codes.NO_HOST.at(span, name=name, hint=f"add `host: {host}`, or another host"))
        elif not part.is_homeless:
            part.is_homeless = True
            path = os.path.basename(part.document.path)
            group = part.scope.rstrip(".").rpartition(".")[2] or path.partition(".")[0]
            hint = f"write `groups: {{{group}: {{include: {path}, host: {host}}}}}`, or `hosts:` in {path}"
            self.diagnostics.append(codes.NO_HOST.at(part.span, name=part.scope.rstrip(".") or path, hint=hint))

    def _report(self, part: ExpandedDocument, fault: Diagnostic) -> None:
        if part.is_own:
            self.diagnostics.append(fault)


def _ssh_address(host: Host) -> str:
    user = host.user or host.ssh.user
    return f"{user}@{host.address.text}" if user else host.address.text


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


def _replaced(part: _Part, number: str) -> _Part:
    """The part of an entry with `{i}` replaced by the number in every text."""
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
