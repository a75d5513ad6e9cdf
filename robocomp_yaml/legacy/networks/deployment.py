"""Convert a legacy network to a DDSL document: hosts, services and components."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.document import List, Map, Notes, Raw
from robocomp_yaml.legacy.draft import DeploymentDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.networks.components import KnownComponent, match, of_folder, of_run
from robocomp_yaml.legacy.networks.conflicts import Processes, host_of, without_circles
from robocomp_yaml.legacy.networks.entries import COMMON, Destination, component_entry, program_entry
from robocomp_yaml.legacy.networks.kept import Derivable, inherit, share
from robocomp_yaml.legacy.networks.node import NetworkDraft, NetworkNode, safe_name
from robocomp_yaml.legacy.networks.served import ConfigAddresses, addresses, is_missing
from robocomp_yaml.legacy.workspaces import Workspaces
from robocomp_yaml.source.rcremote import LOCAL, LOOPBACK, is_config
from robocomp_yaml.source.text import OF_NO_LINE

_IP = re.compile(r"[\d.:]+")


def build_deployments(
    accepted: Sequence[LedgerEntry], targets: Mapping[str, str], workspaces: Workspaces
) -> tuple[dict[str, Map], dict[str, str]]:
    """Return the document of each network among the accepted files, by the file's path; and the document of each
    component that a network configures, by the real path of the config."""
    by_file: dict[str, Map] = {}
    owners: dict[str, str] = {}
    networks = [(entry, entry.file.draft) for entry in accepted if isinstance(entry.file.draft, DeploymentDraft)]
    if not networks:
        return by_file, owners
    migrated = of_run((entry.file for entry in accepted), targets)
    by_real_path = {os.path.realpath(path): document for path, document in targets.items()}
    existing: dict[str, list[KnownComponent]] = {}
    for entry, draft in networks:
        rules = entry.file.rules
        assert rules is not None
        document = targets[entry.file.path]
        home = workspaces.of(document).root
        if home not in existing:
            existing[home] = of_folder(home, [known.path for known in migrated])
        name = safe_name(os.path.basename(document).removesuffix(rules.document))
        known = [*migrated, *existing[home]]
        site = Destination(document, by_real_path, f"x-{rules.name}", entry.legacy.start, owners)
        builder = _DeploymentBuilder(name, draft.network, known, site)
        by_file[entry.file.path] = builder.document()
        entry.diagnostics += builder.diagnostics
    return by_file, owners


class _DeploymentBuilder(msgspec.Struct, eq=False):
    """Builds the document of a network, which starts some of the known components. What only an exporter needs is
    written under the key of its destination."""

    name: str
    network: NetworkDraft
    known: Sequence[KnownComponent]
    site: Destination
    diagnostics: list[Diagnostic] = []
    by_alias: dict[str, NetworkNode] = {}
    owners: dict[str, NetworkNode] = {}
    """By the name of a node, the first node of the same process."""
    waits: dict[str, list[str]] = {}
    """By the name of a process's first node, the names of those that it waits for, without circles."""
    unconfigured: dict[str, KnownComponent] = {}
    """By the name of a node, the component whose configuration is missing."""
    derived: dict[str, Derivable] = {}
    """By the name of a node, what an exporter derives for it."""
    processes: Processes = msgspec.field(default_factory=lambda: Processes((), {}, {}, {}))

    def document(self) -> Map:
        nodes = self.network.nodes
        self.by_alias = {node.alias: node for node in reversed(nodes)}  # a dependence means the first one of its name
        spelled = _spellings(self.known)
        for node in nodes:
            node.interface = spelled.get(node.interface.lower(), node.interface)
        running = [node for node in nodes if self.is_started(node)]
        self.find_owners(running)
        self.find_processes(running)
        self.find_waits()
        hosts = self.hosts(running)
        notes = self.network.notes
        document, listed, services, components, kept = (Map(block=True) for _ in range(5))
        document.put("deployment", self.name, Notes(notes.head, notes.tail))
        users = self.network.users
        for address, name in hosts.items():
            user = {"user": users[address]} if address in users else {}
            reached = address if address != LOCAL else self.here(running)
            listed.put(name, Map.of({"address": reached, **user}))
        document.put_some("hosts", listed)
        for node in nodes:
            self.report_problems(node)
            if node not in running:
                self.keep_data(kept, node)
            elif node.endpoint is not None and node.endpoint.is_storm:
                services.put(node.name, self.service(node, hosts), node.notes)
                self.keep_data(kept, node)
            else:
                components.put(node.name, self.entry(node, hosts), node.notes)
        document.put_some("services", services)
        document.put("components", components)
        self.network.extra.put_some("nodes", kept)
        self.network.extra.put_some("each", share(nodes, self.derived))
        for node in nodes:
            if node.name in self.owners:
                inherit(node, self.owners[node.name])
        document.put_some(self.site.key, self.network.extra)
        document.entries[-1].notes.foot += notes.foot
        return document

    def is_started(self, node: NetworkNode) -> bool:
        if node.command is None:
            reason = "it has no command with a program"
        elif any(map(OF_NO_LINE.search, (node.command.folder, node.command.words[0], node.command.config))):
            reason = "its program, folder or configuration contains a line break or another control character"
        else:
            return True
        self.diagnostics.append(codes.NOT_STARTED.at(node.span, name=node.alias, reason=reason))
        return False

    def find_owners(self, running: Sequence[NetworkNode]) -> None:
        first: dict[tuple[object, ...], NetworkNode] = {}
        for node in running:
            if node.command is None or (node.endpoint is not None and node.endpoint.is_storm):
                continue
            owner = first.setdefault(node.command.key, node)
            if owner is not node:
                self.owners[node.name] = owner
                owner.is_shared = node.is_shared = True
                self.diagnostics.append(codes.SAME_PROCESS.at(node.span, name=node.alias, other=owner.alias))

    def find_processes(self, running: Sequence[NetworkNode]) -> None:
        """Find the components that are started, and which endpoints are only pinged."""
        components: dict[str, KnownComponent] = {}
        configured: dict[str, ConfigAddresses] = {}
        for node in running:
            command = node.command
            if node.name in self.owners or command is None or command.in_shell or _is_storm(node):
                continue
            component = match(command, self.known)
            if component is not None and is_missing(command, component, self.site.sources):
                missing = codes.MISSING_CONFIG.at(
                    node.span, name=node.alias, config=command.config, component=component.name
                )
                self.diagnostics.append(missing)
                self.unconfigured[node.name] = component
            elif component is not None:
                components[node.name] = component
                configured[node.name] = addresses(command, component, self.site.sources)
        self.processes = Processes(running, self.owners, components, configured)
        self.diagnostics += self.processes.find_pinged()

    def find_waits(self) -> None:
        waits: dict[str, list[str]] = {}
        for node in self.network.nodes:
            owner = self.owners.get(node.name, node).name
            targets = [self.by_alias[alias] for alias, _, _ in node.after if alias in self.by_alias]
            names = [self.owners.get(target.name, target).name for target in targets]
            waits.setdefault(owner, []).extend(name for name in names if name != owner)
        self.waits, dropped = without_circles({name: list(dict.fromkeys(targets)) for name, targets in waits.items()})
        by_name = {node.name: node for node in self.network.nodes}
        for name, target in dropped:
            node = by_name[name]
            self.diagnostics.append(codes.CIRCLE.at(node.span, name=node.alias, other=by_name[target].alias))

    def hosts(self, running: Sequence[NetworkNode]) -> dict[str, str]:
        """Return the name of each host by its address; none where all processes run on this host."""
        addresses = dict.fromkeys(host_of(node) for node in running)
        if set(addresses) <= {LOCAL}:
            return {}
        names: dict[str, str] = {}
        for address in addresses:
            name = f"host{len(names) + 1}" if _IP.fullmatch(address) else address.partition(".")[0]
            names[address] = safe_name(name, names.values())
        return names

    def here(self, running: Sequence[NetworkNode]) -> str:
        """Return the address by which other hosts reach the one that the file calls localhost: that in a proxy to one
        of its nodes, else the name of this machine. It is kept for the exporter."""
        local = [node for node in running if host_of(node) == LOCAL]
        address = self.processes.address_of(local) or socket.gethostname()
        self.diagnostics.append(codes.LOCAL_ADDRESS.at(local[0].span, address=address))
        self.network.extra.put(LOCAL, address)
        return address

    def report_problems(self, node: NetworkNode) -> None:
        """Report the problems of a node that do not prevent its conversion."""
        command, endpoint = node.command, node.endpoint
        if command is not None and command.in_shell:
            self.diagnostics.append(codes.NEEDS_SHELL.at(node.span, name=node.alias))
        elif command is not None and len(command.words) == 1 and not command.config and is_config(command.words[0]):
            self.diagnostics.append(codes.NO_PROGRAM.at(node.span, name=node.alias, word=command.words[0]))
        if endpoint is None:
            if node.endpoint_span.file:
                problem = (
                    f"the endpoint of '{node.alias}' has no address with a port, or its name cannot be an interface, "
                    "so that its address is unknown"
                )
                self.diagnostics.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))
            return
        host = LOCAL if endpoint.host in LOOPBACK else endpoint.host
        if command is not None and host and host != host_of(node):
            problem = f"'{node.alias}' is started on {host_of(node)}, but its endpoint is on {endpoint.host}"
            self.diagnostics.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))

    def service(self, node: NetworkNode, hosts: dict[str, str]) -> Map:
        storm, result = Map(), Map()
        if hosts:
            storm.put("host", hosts[host_of(node)])
        assert node.endpoint is not None
        storm.put("port", Raw(str(node.endpoint.port)))
        result.put("icestorm", storm)
        return result

    def keep_data(self, kept: Map, node: NetworkNode) -> None:
        """Keep the data of a node that is not an entry of `components:`."""
        if node.after:
            self.keep_dependences(node)
            for _, _, notes in node.after:
                node.extra.entries[-1].notes.add(notes)
        kept.put(node.name, node.extra, Notes() if node.command is not None else node.notes)

    def entry(self, node: NetworkNode, hosts: dict[str, str]) -> Map:
        owner = self.owners.get(node.name)
        if owner is not None:
            if node.after:
                self.keep_dependences(node)
            return program_entry(node, "", List(), self.site, process=owner.name, derivable=self.derivable(node, owner))
        assert node.command is not None
        after = self.after(node)
        host = hosts.get(host_of(node), "")
        component = self.processes.components.get(node.name)
        if component is None:
            home, derivable = self.home(node), self.derivable(node, node)
            return program_entry(node, host, after, self.site, home=home, derivable=derivable)
        depends = [self.by_alias[alias] for alias, _, _ in node.after if alias in self.by_alias]
        connect, guesses = self.processes.connections(node, depends)
        self.diagnostics += guesses
        result, problem = component_entry(
            node, component, host, after, self.site, connect, self.processes.configured[node.name].ports,
            self.derivable(node, node),
        )  # fmt: skip
        if problem:
            self.diagnostics.append(codes.ODD_ENDPOINT.at(node.endpoint_span, problem=problem))
        return result

    def derivable(self, node: NetworkNode, owner: NetworkNode) -> Derivable:
        """Return what an exporter derives for a node of the process of another one, or of its own."""
        component = self.processes.components.get(owner.name)
        serves = None if component is None else (*component.implements, COMMON)[:1]
        is_elsewhere = component is not None or bool(self.home(owner))
        names = [owner, *(one for one in self.network.nodes if self.owners.get(one.name) is owner)]
        is_one_each = not any(one.endpoint is None or one.is_only_pinged for one in names)
        is_one_each = len(names) == 1 or (is_one_each and component is None)
        result = self.derived[node.name] = Derivable(owner.command, is_elsewhere, serves, is_one_each)
        return result

    def home(self, node: NetworkNode) -> str:
        """Return the folder of the component that a program on this host is, if that is its working folder; or ''."""
        component = self.unconfigured.get(node.name)
        if component is None or node.command is None or host_of(node) != LOCAL:
            return ""
        home = os.path.dirname(component.path) or "."
        return home if os.path.basename(os.path.abspath(home)) == os.path.basename(node.command.folder) else ""

    def after(self, node: NetworkNode) -> List:
        """Return the entries that a process waits for: those of all its nodes, except itself."""
        listed, is_plain = List(), True
        others = [other for other in self.network.nodes if self.owners.get(other.name) is node]
        for at in (node, *others):
            for alias, span, notes in at.after:
                target = self.by_alias.get(alias)
                if target is None:
                    self.diagnostics.append(codes.DANGLING.at(span, name=at.alias, other=alias))
                if target is None or target.command is None or self.owners.get(target.name, target) is node:
                    is_plain = is_plain and at is not node
                    node.notes.add(notes)
                    continue
                is_plain = is_plain and at is node
                if self.owners.get(target.name, target).name not in self.waits.get(node.name, ()):
                    is_plain = False  # it would close a circle
                    continue
                if all(item.value != target.name for item in listed.items):
                    listed.put(target.name, notes)
        if not is_plain:
            self.keep_dependences(node)
        return listed

    def keep_dependences(self, node: NetworkNode) -> None:
        """Keep the dependences of the file where `after:` is not equivalent."""
        node.extra.put("dependence", List.of(alias for alias, _, _ in node.after))


def _spellings(known: Sequence[KnownComponent]) -> dict[str, str]:
    """Return the spelling of interfaces in components, by their identity in lower case."""
    names = [COMMON, *(name for item in known for name in (*item.implements, *item.requires.values()))]
    return {name.lower(): name for name in names}


def _is_storm(node: NetworkNode) -> bool:
    return node.endpoint is not None and node.endpoint.is_storm
