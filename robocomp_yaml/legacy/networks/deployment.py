"""A legacy network as a DDSL document: hosts, services, and what runs."""

from __future__ import annotations

import re
from collections.abc import Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.digraph import reached
from robocomp_yaml.legacy.document import List, Map, Notes, Raw
from robocomp_yaml.legacy.networks.command import LOCAL, LOOPBACK, is_config
from robocomp_yaml.legacy.networks.components import Known, match
from robocomp_yaml.legacy.networks.entries import COMMON, Site, component_entry, program_entry
from robocomp_yaml.legacy.networks.node import NetworkDraft, Node, safe_name
from robocomp_yaml.source.text import OF_NO_LINE

_IP = re.compile(r"[\d.:]+")


def build(
    name: str, network: NetworkDraft, known: Sequence[Known], site: Site, key: str
) -> tuple[Map, list[Diagnostic]]:
    """The document of the network of that name, which starts some of the components known. What only an exporter needs
    stands under `key`."""
    builder = _Builder(name, network, known, site, key)
    return builder.document(), builder.said


class _Builder(msgspec.Struct, eq=False):
    name: str
    network: NetworkDraft
    known: Sequence[Known]
    site: Site
    key: str
    said: list[Diagnostic] = []
    by_alias: dict[str, Node] = {}
    owners: dict[str, Node] = {}
    """By the name of a node, the node whose process it is too."""
    waits: dict[str, set[str]] = {}
    """By the name of a process's first node, those that it waits for."""

    def document(self) -> Map:
        nodes = self.network.nodes
        self.by_alias = {node.alias: node for node in nodes}
        spelled = _spellings(self.known)
        for node in nodes:
            node.interface = spelled.get(node.interface.lower(), node.interface)
        running = [node for node in nodes if self.is_started(node)]
        self.find_owners(running)
        self.find_waits()
        hosts = self.hosts(running)
        notes = self.network.notes
        document, services, components = Map(block=True), Map(block=True), Map(block=True)
        document.put("deployment", self.name, Notes(notes.head, notes.tail))
        document.put_some("hosts", self.hosts_map(hosts))
        kept = Map(block=True)
        for node in nodes:
            self.judge(node)
            if node not in running:
                self.keep(kept, node)
            elif node.endpoint is not None and node.endpoint.is_storm:
                services.put(node.name, self.service(node, hosts), node.notes)
                self.keep(kept, node)
            else:
                components.put(node.name, self.entry(node, hosts), node.notes)
        document.put_some("services", services)
        document.put("components", components)
        self.network.extra.put_some("nodes", kept)
        document.put_some(self.key, self.network.extra)
        document.entries[-1].notes.foot += notes.foot
        return document

    def is_started(self, node: Node) -> bool:
        if node.command is None:
            reason = "it has no command that names a program"
        elif any(map(OF_NO_LINE.search, (node.command.folder, node.command.words[0], node.command.config))):
            reason = "a line break or another control character stands in its program, folder or configuration"
        else:
            return True
        self.said.append(codes.NOT_STARTED.at(node.span, name=node.alias, reason=reason))
        return False

    def find_owners(self, running: Sequence[Node]) -> None:
        first: dict[tuple[object, ...], Node] = {}
        for node in running:
            if node.command is None or (node.endpoint is not None and node.endpoint.is_storm):
                continue
            owner = first.setdefault(node.command.key, node)
            if owner is not node:
                self.owners[node.name] = owner
                owner.is_shared = node.is_shared = True
                self.said.append(codes.SAME_PROCESS.at(node.span, name=node.alias, other=owner.alias))

    def find_waits(self) -> None:
        for node in self.network.nodes:
            owner = self.owners.get(node.name, node).name
            targets = [self.by_alias[alias] for alias, _, _ in node.after if alias in self.by_alias]
            names = {self.owners.get(target.name, target).name for target in targets} - {owner}
            self.waits.setdefault(owner, set()).update(names)

    def hosts(self, running: Sequence[Node]) -> dict[str, str]:
        """The name of each host by its address; none where everything runs here."""
        addresses = dict.fromkeys(_address(node) for node in running)
        if set(addresses) <= {LOCAL}:
            return {}
        names: dict[str, str] = {}
        for address in addresses:
            wanted = f"host{len(names) + 1}" if _IP.fullmatch(address) else address.partition(".")[0]
            names[address] = safe_name(wanted, names.values())
        return names

    def hosts_map(self, hosts: dict[str, str]) -> Map:
        made = Map(block=True)
        for address, name in hosts.items():
            host = Map()
            host.put("address", address)
            if address in self.network.users:
                host.put("user", self.network.users[address])
            made.put(name, host)
        return made

    def judge(self, node: Node) -> None:
        """What is odd about a node, though the document can say it."""
        command, endpoint = node.command, node.endpoint
        if command is not None and command.in_shell:
            self.said.append(codes.NEEDS_SHELL.at(node.span, name=node.alias))
        elif command is not None and len(command.words) == 1 and not command.config and is_config(command.words[0]):
            self.said.append(codes.NO_PROGRAM.at(node.span, name=node.alias, word=command.words[0]))
        if endpoint is None:
            if node.endpoint_span.file:
                problem = (
                    f"the endpoint of '{node.alias}' is no address with a port, or no interface can have its name, so "
                    "nothing says where it answers"
                )
                self.said.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))
            return
        host = LOCAL if endpoint.host in LOOPBACK else endpoint.host
        if command is not None and host and host != _address(node):
            problem = f"'{node.alias}' is started on {_address(node)}, but its endpoint is on {endpoint.host}"
            self.said.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))

    def service(self, node: Node, hosts: dict[str, str]) -> Map:
        storm, made = Map(), Map()
        if hosts:
            storm.put("host", hosts[_address(node)])
        assert node.endpoint is not None
        storm.put("port", Raw(str(node.endpoint.port)))
        made.put("icestorm", storm)
        return made

    def keep(self, kept: Map, node: Node) -> None:
        """All that is said of a node which is no entry of `components:`."""
        if node.after:
            self.keep_dependences(node)
            for _, _, notes in node.after:
                node.extra.entries[-1].notes.add(notes)
        kept.put(node.name, node.extra, Notes() if node.command is not None else node.notes)

    def entry(self, node: Node, hosts: dict[str, str]) -> Map:
        owner = self.owners.get(node.name)
        if owner is not None:
            if node.after:
                self.keep_dependences(node)
            return program_entry(node, "", List(), self.key, process=owner.name)
        assert node.command is not None
        after = self.after(node)
        host = hosts.get(_address(node), "")
        component = None if node.command.in_shell else match(node.command, self.known)
        if component is None:
            return program_entry(node, host, after, self.key)
        depends = [self.by_alias[alias] for alias, _, _ in node.after if alias in self.by_alias]
        made, problem = component_entry(node, component, host, after, self.key, self.site, depends)
        if problem:
            self.said.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))
        return made

    def after(self, node: Node) -> List:
        """The entries that a process waits for: those of all its names, but for itself."""
        listed, is_plain = List(), True
        second = [other for other in self.network.nodes if self.owners.get(other.name) is node]
        for at in (node, *second):
            for alias, span, notes in at.after:
                target = self.by_alias.get(alias)
                if target is None:
                    self.said.append(codes.DANGLING.at(span, name=at.alias, other=alias))
                if target is None or target.command is None or self.owners.get(target.name, target) is node:
                    is_plain = is_plain and at is not node
                    node.notes.add(notes)
                    continue
                is_plain = is_plain and at is node and target.name == alias and target.name not in self.owners
                if all(item.value != target.name for item in listed.items):
                    listed.put(target.name, notes)
        if not is_plain or self.is_in_circle(node):
            self.keep_dependences(node)
        return listed

    def is_in_circle(self, node: Node) -> bool:
        """Whether it waits, by way of others, for itself: a deployment passes over one of these dependences."""
        waits = self.waits
        return node.name in reached(waits.get(node.name, ()), lambda name: waits.get(name, ()))

    def keep_dependences(self, node: Node) -> None:
        """The dependences as the file has them, where `after:` does not say the same."""
        node.extra.put("dependence", List.of(alias for alias, _, _ in node.after))


def _spellings(known: Sequence[Known]) -> dict[str, str]:
    """Interfaces as components spell them, by their identities."""
    names = [COMMON, *(name for item in known for name in (*item.implements, *item.requires.values()))]
    return {name.lower(): name for name in names}


def _address(node: Node) -> str:
    host = node.command.host if node.command is not None else LOCAL
    return LOCAL if host in LOOPBACK else host
