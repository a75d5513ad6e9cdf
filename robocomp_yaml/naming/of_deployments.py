"""The names of deployment documents: hosts, entries, services, groups, and the ports that they connect."""

from __future__ import annotations

from collections.abc import Iterable

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm, Target, offers
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.model.deployment import COMPONENT, Host
from robocomp_yaml.model.located import Text
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Key, Names
from robocomp_yaml.naming.of_components import port_key
from robocomp_yaml.naming.of_interfaces import key_of, method_key
from robocomp_yaml.naming.of_parameters import ParameterTree, identity
from robocomp_yaml.network.connections import is_proxy


def collect(names: Names, program: Program) -> None:
    for linked in program.deployments.values():
        _define(names, linked)
    for linked in program.deployments.values():
        _Uses(names, linked).collect()


def _define(names: Names, linked: LinkedDeployment) -> None:
    deployment = linked.deployment
    path = deployment.path
    own = kinds.DEPLOYMENT, path
    names.define(DefinedName(own, deployment.name, deployment.span, "deployment", deployment.doc))
    for host in deployment.hosts:
        says = f"host {host.name}: {host.address.text}"
        names.define(DefinedName((kinds.HOST, path, host.name), host.name, host.span, says, host.doc))
    for storm in deployment.services:
        key = kinds.SERVICE, path, storm.name
        names.define(DefinedName(key, storm.name, storm.span, "service", storm.doc))
    for group in deployment.groups:
        names.define(DefinedName((kinds.GROUP, path, group.name), group.name, group.span, "group", group.doc))
    for entry in deployment.entries:
        says = f"{entry.kind} {entry.target.text}"
        names.define(DefinedName((kinds.ENTRY, path, entry.name), entry.name, entry.span, says, entry.doc))


class _Uses:
    def __init__(self, names: Names, linked: LinkedDeployment) -> None:
        self.names, self.linked = names, linked
        self._entries: dict[Span, str] = {one.span: one.name for one in linked.deployment.entries}

    def collect(self) -> None:
        deployment = self.linked.deployment
        for one in deployment.groups:
            if one.host is not None:
                self._host(one.host, self.linked.hosts.get(one.host.text))
        for storm in self.linked.storms.values():
            if storm.document is deployment and storm.storm.host is not None:
                self._host(storm.storm.host, storm.host)
        seen: set[Span] = set()
        for instance in self.linked.instances.values():
            if instance.document is deployment:
                self._instance(instance, is_first=instance.entry.span not in seen)
                seen.add(instance.entry.span)
            elif instance.entry.host is not None and not instance.document.hosts:  # the hosts are this document's
                self._host(instance.entry.host, instance.host)
        for group in self.linked.groups.values():
            if group.document is deployment:
                self._group(group)

    def _host(self, text: Text, host: Host | None) -> None:
        if host is not None:
            self.names.use((kinds.HOST, host.span.file, host.name), text.span.inside(text.text, 0, len(text.text)))

    def _instance(self, instance: LinkedInstance, *, is_first: bool) -> None:
        entry, component = instance.entry, instance.component
        for pair in entry.connect:
            self._name(pair.text, pair.span)
        for text in entry.after:
            self._name(text.text, text.span)
        if entry.kind == "process":
            self._name(entry.target.text, entry.target.span)
        if not is_first:
            return
        if entry.host is not None:
            self._host(entry.host, instance.host)
        if component is None:
            return
        if entry.kind == COMPONENT:
            self.names.use((kinds.COMPONENT, component.component.path), entry.target.span, is_path=True)
        served = (*component.implements, *component.subscribes)
        topics = (*component.publishes, *component.subscribes)
        for ports, keys in (
            (component.requires, entry.connect), (topics, entry.topics), (served, entry.ports),
            (served, entry.endpoints),
        ):  # fmt: skip
            for key in keys:
                self._port(component, ports, key.name, key.name_span)
        for port in component.requires:
            for pair in entry.connect:
                if pair.name == port.name and is_proxy(pair.text):
                    identity(self.names, port, pair.text, pair.span)
        document = component.parameters.document
        if document is not None:
            ParameterTree(self.names, document).values(entry.settings)

    def _port(self, component: LinkedComponent, ports: Iterable[Port], name: str, span: Span) -> None:
        for port in ports:
            if port.name == name:
                self.names.use(port_key(component, port), span.inside(name, 0, len(name)))
                return

    def _group(self, group: LinkedGroup) -> None:
        for member in group.group.members:
            self._name(member.text, member.span)
        if group.facade is not None and group.group.facade is not None:
            key = kinds.COMPONENT, group.facade.component.path
            self.names.use(key, group.group.facade.span, is_path=True)
        for exposed in group.group.exposed:
            self._name(exposed.member.text, exposed.member.span)
            served = next((one for one in group.serves if one.name == exposed.name), None)
            if served is None or served.port is None:
                continue
            port, component = served.port, served.instance.component
            facade = next(
                (one for one in (group.facade.implements if group.facade else ()) if one.name == exposed.name), None
            )
            if facade is not None and group.facade is not None:
                self.names.use(port_key(group.facade, facade), exposed.span.inside(exposed.name, 0, len(exposed.name)))
            elif exposed.name == port.name and component is not None and "." not in exposed.member.text:
                self.names.use(port_key(component, port), exposed.span.inside(exposed.name, 0, len(exposed.name)))
            for allowed in exposed.allow or ():
                method = method_key(key_of(port.scope, port.interface), allowed.text)
                self.names.use(method, allowed.span.inside(allowed.text, 0, len(allowed.text)))

    def _name(self, text: str, span: Span) -> None:
        """A text such as `speech`, `arm.elbow.Motor`: a name, perhaps in included groups, perhaps with an interface."""
        targets, behind = self.linked.find(text, "")
        if not targets:
            return
        end = len(text) - len(behind) - (1 if behind else 0)
        name = text[:end]
        first = name.rpartition(".")[0]
        self.names.use(self._key(targets[0]), span.inside(text, len(first) + 1 if first else 0, end))
        while first:  # the groups in which it is
            groups, rest = self.linked.find(first, "")
            if not groups or rest:
                break
            outer = first.rpartition(".")[0]
            self.names.use(self._key(groups[0]), span.inside(text, len(outer) + 1 if outer else 0, len(first)))
            first = outer
        if behind and (key := self._served(targets[0], behind)) is not None:
            self.names.use(key, span.inside(text, len(text) - len(behind), len(text)))

    def _served(self, target: Target, name: str) -> Key | None:
        if isinstance(target, LinkedInstance):
            every = offers(target)
        elif isinstance(target, LinkedGroup):
            every = target.offers()
        else:
            return None
        for one in every:
            component = one.instance.component
            if one.name == name and one.port is not None and component is not None:
                return port_key(component, one.port)
        return None

    def _key(self, target: Target) -> Key:
        match target:
            case LinkedStorm():
                return kinds.SERVICE, target.document.path, target.storm.name
            case LinkedGroup():
                return kinds.GROUP, target.document.path, target.group.name
        written = self._entries.get(target.entry.span) or _as_written(target)
        return kinds.ENTRY, target.document.path, written


def _as_written(instance: LinkedInstance) -> str:
    """The name of an entry in its document, before its instances get their numbers."""
    span = instance.entry.span
    return next((one.name for one in instance.document.entries if one.span == span), instance.entry.name)
