"""Who can be called from outside of a network, and where: the entries of a deployment, the components of the workspace,
and any HOST:PORT."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.api import which
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.deploy import interfaces, listing
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.component_references import stem
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Interface, Method
from robocomp_yaml.network.network import LOOPBACK, Endpoint, Network, Process, is_loopback
from robocomp_yaml.patterns import pattern
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.wire.behavior import MODULE, common_behavior

_HOST = pattern(r"(?:(tcp|ssl|ws|wss):)?(\[[0-9A-Fa-f:.%\w]+\]|[\w.-]+):(\d{1,5})(?:[./](.*))?\Z")
_MOST = 12  # names in a message


class Door(msgspec.Struct, frozen=True):
    """An interface that somebody serves: `name` is that of the adapter, which is usually the interface's; `proxy` is
    the text of its proxy."""

    name: str
    scope: LinkedModule
    interface: Interface
    proxy: str

    @property
    def where(self) -> str:
        """The endpoints alone."""
        return self.proxy.partition(":")[2]


class Peer(msgspec.Struct, frozen=True, eq=False):
    """A component or program that serves `doors`. `rest` is the text that followed its name. `span` is its entry in a
    deployment, or its document; `not_running` is the hint if it does not answer. `instance` is that of an entry."""

    name: str
    rest: str = ""
    doors: tuple[Door, ...] = ()
    span: Span = Span("")
    not_running: str = ""
    component: LinkedComponent | None = None
    instance: LinkedInstance | None = None


class Addresses:
    """The documents that are around, and who can be called by them. `deployment` is a document or a folder with one; by
    default, it is the only one below the working folder, else of the workspace. `analysis` is that of the workspace, if
    it is there already."""

    def __init__(self, deployment: str = "", include: Sequence[str] = (), analysis: Analysis | None = None) -> None:
        self._include = tuple(include)
        chosen = os.path.normpath(which.deployment(deployment, self._include)) if deployment else ""
        self._root = which.root_around(chosen)
        self.analysis: Analysis = analysis or analyse([self._root, *([chosen] if chosen else [])], include)
        self.program = self.analysis.program
        around = (which.deployments_of(folder, self._include, self.analysis) for folder in (".", self._root))
        found = [chosen] if chosen else next(filter(None, around), [])
        self._deployments = {path: self.program.deployments.get(os.path.realpath(path)) for path in found}
        if chosen and os.path.realpath(chosen) not in self.analysis.networks:
            raise Faulty(self.analysis.diagnostics, self.program.documents)

    @functools.cached_property
    def network(self) -> Network | None:
        """The network of the deployment; None if there is none, or more than one."""
        found = self.analysis.networks.get(os.path.realpath(next(iter(self._deployments)))) if self._is_one else None
        return interfaces.resolved(found) if found else None

    @property
    def linked(self) -> LinkedDeployment | None:
        return next(iter(self._deployments.values())) if self._is_one else None

    @property
    def path(self) -> str:
        """The document of the deployment, '' if there is none, or more than one."""
        return next(iter(self._deployments)) if self._is_one else ""

    @property
    def deployments(self) -> list[str]:
        return list(self._deployments)

    @property
    def _is_one(self) -> bool:
        return len(self._deployments) == 1

    def names(self) -> list[str]:
        """Everybody who has a name: entries first, then closed groups, which are called instead of their gates."""
        network, linked = self.network, self.linked
        closed = [one.name for one in linked.groups.values() if one.is_closed] if network and linked else []
        processes = [one for one in network.processes.values() if one.is_ice] if network else []
        names = [one.name for one in processes if self._of_process(one, "").doors]
        entries = [*(one for one in names if one.removesuffix(".gate") not in closed), *closed]
        return list(dict.fromkeys([*entries, *self._own_names()]))

    def methods(self, name: str) -> list[str]:
        """The full names of all methods of somebody with a name, for completion."""
        peer = self.peer(name)
        return [f"{name}.{door.name}.{one.name}" for door in peer.doors for one in door.interface.methods]

    def peer(self, text: str) -> Peer:
        """Who is meant by `speech`, `speech.Speech.say`, `components/speech` or `localhost:10001.Speech.say`. Raises
        Refused if nobody is, or more than one."""
        if at_port := _HOST.match(text):
            return self._at_port(text[: at_port.end(3)], self._endpoint(at_port), at_port[4] or "")
        peer = self._of_entry(text)
        if peer is None:
            self._refuse_several(text)
        return peer or self._of_component(text) or self._unknown(text)

    def topic_manager(self, text: str) -> str:
        """The proxy of an IceStorm's topic manager, of which the text may also be the HOST:PORT. Raises Refused."""
        found = _HOST.match(text)
        return text if found is None or found[4] is not None else f"IceStorm/TopicManager:{self._endpoint(found)}"

    def _endpoint(self, found: re.Match[str]) -> str:
        """The endpoint of a HOST:PORT; with TLS, if the network that is there has it. Raises Refused."""
        if not 0 < int(found[3]) < 65536:
            raise Refused(f"'{found[3]}' is not a TCP port: they are from 1 to 65535")
        endpoint = IceEndpoint(int(found[3]), found[1] or "tcp").reached_at(found[2].strip("[]"))
        if not found[1] and (network := self.network_at(f"any:{endpoint}")) and network.is_tls:
            return f"ssl{endpoint.removeprefix('tcp')}"
        return endpoint

    def _refuse_several(self, text: str) -> None:
        """Raises Refused for an entry of one of several deployments, and Faulty if one cannot be read, unless it is the
        full name of a component."""
        is_component = bool(self._own_names().keys() & set(_prefixes(text)))
        if not is_component and os.sep not in text:
            self.refuse_unread()  # one of them may have an entry of this name
        for path, linked in self._deployments.items():
            if not (is_component or self._is_one) and linked is not None and linked.find(text, "")[0]:
                name = f"there are several deployments, and {path} has '{text.partition('.')[0]}'"
                raise Refused(f"{name}: name one with --deployment {path}")

    def _own_names(self) -> dict[str, None]:
        return {linked.component.name: None for linked in self.program.components.values()}

    def refuse_unread(self) -> None:
        """Raises Faulty if errors leave a deployment without a network."""
        self._refuse_errors(
            {path for path in self._deployments if os.path.realpath(path) not in self.analysis.networks}
        )

    def _unknown(self, text: str) -> Peer:
        self.refuse_unread()
        known = self.names()
        first = text.partition(".")[0] or text
        otherwise = (
            f"known are {some(known, _MOST)}, and HOST:PORT" if known else "name a HOST:PORT, such as localhost:10001"
        )
        raise Refused(f"{self.path or 'this workspace'} has no component '{first}'{meant(first, known, otherwise)}")

    def _of_entry(self, text: str) -> Peer | None:
        network, linked = self.network, self.linked
        if network is None or linked is None:
            return None
        targets, rest = linked.find(text, "")
        named = text[: len(text) - len(rest) - 1] if rest else text
        if not targets:
            process = next((one for one in _prefixes(text) if network.find(one)), "")
            found = network.find(process) if process else None
            return self._of_process(found, text[len(process) + 1 :]) if found else None
        instances = {one.process or one for one in targets if isinstance(one, LinkedInstance)}
        groups = [one for one in targets if isinstance(one, LinkedGroup)]
        if len(groups) == len(targets) == 1 and groups[0].is_closed:
            return self._of_group(groups[0], rest)
        members = [one.name for group in groups for one in group.members]
        if groups or len(instances) > 1:
            names = ", ".join(members or sorted(one.name for one in instances))
            raise Refused(f"'{named}' means several processes; name one of {names}")
        process_of = network.processes.get(next(iter(instances)).name) if instances else None
        if process_of is None:
            self._refuse_errors({one.document.path for one in instances} | {linked.deployment.path})
            what = "is an IceStorm, which carries topics: `rcyaml topic`" if not instances else "does not run Ice"
            raise Refused(f"'{named}' {what}")
        return self._of_process(process_of, rest)

    def _of_group(self, group: LinkedGroup, rest: str) -> Peer:
        """A group that acts as one component: what it offers, through its gate if there are rules."""
        network = self.network
        assert network is not None
        gate, doors = network.processes.get(f"{group.name}.gate"), list[Door]()
        for served in group.serves:
            owner = network.processes.get((served.instance.process or served.instance).name)
            through = (gate, served.name) if gate and served.rule is not None else (owner, served.adapter)
            for one in self._of_process(through[0], "").doors if through[0] else ():
                if one.name == through[1]:
                    doors.append(msgspec.structs.replace(one, name=served.name))
        up = f"`{typed('rcyaml', 'deploy', 'up', self.path)}` starts it"
        return Peer(group.name, rest, tuple(doors), group.group.span, up)

    def _of_process(self, process: Process, rest: str) -> Peer:
        network, linked = self.network, self.linked
        assert network is not None and linked is not None
        instance = linked.instances.get(process.name)
        component = instance.component if instance else None
        ports = {port.name: port for port in component.implements} if component else {}
        doors = [
            Door(one.interface, *found, _proxy(one, network.address(process)))
            for one in process.endpoints
            if one.identity and (found := self._served(one, ports.get(one.interface)))
        ]
        up = f"`{typed('rcyaml', 'deploy', 'up', self.path)}` starts it" if process.enabled else "it is not enabled"
        span = process.span if process.span.file else Span(self.path)
        return Peer(process.name, rest, tuple(doors), span, up, component, instance)

    def _served(self, endpoint: Endpoint, port: Port | None) -> tuple[LinkedModule, Interface] | None:
        """The interface at an endpoint; None for one that no document defines, and for a topic."""
        if port is not None:
            return port.scope, port.interface
        if endpoint.module == MODULE and endpoint.identity == COMMON_BEHAVIOR.lower():
            return common_behavior(), common_behavior().module.interfaces[0]
        module, _, name = endpoint.interface.rpartition(".")
        named = [
            (scope, interface) for scope in self.program.modules.values() for interface in scope.module.interfaces
            if interface.name.lower() == endpoint.identity
            and (endpoint.module or module) in ("", scope.module.name, scope.module.stem)
        ]  # fmt: skip
        return next((one for one in named if one[1].name == name), named[0] if named else None)

    def _of_component(self, text: str) -> Peer | None:
        known: dict[str, list[LinkedComponent]] = {}
        for linked in self.program.components.values():
            path = os.path.normpath(linked.component.path)
            folder = os.path.dirname(path)
            names = {linked.component.name, stem(path), os.path.basename(folder), os.path.relpath(folder or "."), path}
            for name in names - {"", "."}:
                known.setdefault(name, []).append(linked)
        # ./arm, arm/ and the absolute path are arm, too
        possible = {one: os.path.relpath(one) if os.sep in one else one for one in _prefixes(text)}
        written = next((one for one, name in possible.items() if name in known), "")
        if not written:
            return None
        name = possible[written]
        exact = [linked for linked in known[name] if linked.component.name == name] or known[name]
        if len(exact) > 1:
            folders = sorted(os.path.relpath(os.path.dirname(one.component.path) or ".") for one in exact)
            raise Refused(f"several components have the name '{name}'; name one of the folders {', '.join(folders)}")
        return self._own_address(exact[0], text[len(written) + 1 :])

    def _own_address(self, linked: LinkedComponent, rest: str) -> Peer:
        """A component of the workspace, where its own configuration says."""
        table = self.analysis.addresses.table(linked)
        served = {port.name: (port.scope, port.interface) for port in linked.implements}
        served.setdefault(COMMON_BEHAVIOR, (common_behavior(), common_behavior().module.interfaces[0]))
        doors = [
            Door(name, *found, f"{found[1].name.lower()}:{table.endpoint(linked, name).reached_at(LOOPBACK)}")
            for name, found in served.items()
        ]
        name, path = linked.component.name, os.path.relpath(linked.component.path)
        hint = f"start it with `rcyaml run {os.path.dirname(path) or '.'}`"
        if entries := self._entries_of(linked):
            listed = " or ".join(f"'{one}'" for one in entries)
            hint = f"its own address is meant here, and {self.path} runs it as {listed}: use that name, or {hint}"
        elif gone := listing.hint_without_document(self._root):
            hint = f"{gone}; or {hint}"
        return Peer(name, rest, tuple(doors), Span(path), hint, linked)

    def _entries_of(self, linked: LinkedComponent) -> list[str]:
        """The processes of the deployment that are this component."""
        if self.network is None or self.linked is None:
            return []
        own = os.path.realpath(linked.component.path)
        found = ((name, self.linked.instances.get(name)) for name in self.network.processes)
        return [
            name for name, one in found
            if one is not None and one.component is not None and os.path.realpath(one.component.component.path) == own
        ]  # fmt: skip

    def _at_port(self, name: str, endpoint: str, rest: str) -> Peer:
        """Whatever listens at a port: any interface of the workspace may be there."""
        doors = (
            msgspec.structs.replace(one, proxy=f"{one.interface.name.lower()}:{endpoint}") for one in self.every_door()
        )
        return Peer(name, rest, tuple(doors))

    def network_at(self, proxy: str) -> Network | None:
        """The network that serves something at the address of a proxy; None if there is none in the documents."""
        found = proxy_at(proxy)
        at = {(_machine(one.host), one.port) for one in (found.endpoints if found else ())}
        for network in filter(None, (self.network, *self.analysis.networks.values())):
            for process in network.processes.values():
                served = (parse_endpoint(one.text) for one in process.endpoints if one.port)
                if any((_machine(one.host or network.address(process)), one.port) in at for one in served if one):
                    return network
        return None

    def secured(self, proxy: str) -> dict[str, str]:
        """The Ice properties with which a proxy of a deployment with TLS is called; none for others."""
        found = proxy_at(proxy)
        if not found or not any(one.protocol in ("ssl", "wss") for one in found.endpoints):
            return {}
        from robocomp_yaml.deploy.authority import of_commands

        network = self.network_at(proxy)
        return of_commands(network) if network is not None and network.is_tls else {}

    def every_door(self) -> list[Door]:
        """All interfaces of the documents, and CommonBehavior, without an address."""
        scopes = [*self.program.modules.values(), common_behavior()]
        return [Door(one.name, scope, one, "") for scope in scopes for one in scope.module.interfaces]

    def door(self, peer: Peer, words: Sequence[str]) -> Door:
        """The interface of a peer that is named, by itself or after its module. Raises Refused, and Faulty if its
        documents have errors."""
        name, module = words[-1], ".".join(words[:-1])
        found = [one for one in peer.doors if name in (one.name, one.interface.name)]
        found = [one for one in found if one.name == name] or found
        found = [one for one in found if not module or module in (one.scope.module.name, one.scope.module.stem)]
        if not found:
            if peer.component is not None:
                self._refuse_errors({peer.component.component.path})
            known = [one.name for one in peer.doors]
            verb = "it serves" if peer.span.file else "known are"
            otherwise = f"{verb} {', '.join(known)}" if known else "it serves no interface of these documents"
            what = f"{peer.name} {'does not serve' if peer.doors else 'serves no interface'}"
            what = what if peer.span.file else "these documents have no interface"  # at a port, all of them may be
            raise Refused(f"{what} '{'.'.join(words)}'{meant(name, known, otherwise)}")
        if len({(one.scope.module.path, one.proxy) for one in found}) > 1:
            choices = ", ".join(f"{one.scope.module.name}.{one.name}" for one in found)
            raise Refused(f"several interfaces are called '{name}'; write one of {choices}")
        self._refuse_errors({one.module.path for one in found[0].scope.closure()})
        return found[0]

    def method(self, text: str) -> tuple[Peer, Door, Method]:
        """Who, where and which method: `speech.Speech.say`, or `speech.say` if only one of its interfaces has the
        method. Raises Refused and Faulty."""
        peer = self.peer(text)
        words = [word for word in peer.rest.replace("/", ".").split(".") if word]
        if not words:
            raise Refused(f"name a method of {peer.name}{self._some_of(peer)}")
        name = words[-1]
        if len(words) == 1:
            found = [one for one in peer.doors if any(method.name == name for method in one.interface.methods)]
            if not found and any(name in (one.name, one.interface.name) for one in peer.doors):
                door = self.door(peer, words)
                methods = [f"{peer.name}.{name}.{one.name}" for one in door.interface.methods]
                raise Refused(f"name a method of {name}: {', '.join(methods) or 'it has none'}")
            if not found:
                if peer.component is not None:
                    self._refuse_errors({peer.component.component.path})
                known = [one.name for door in peer.doors for one in door.interface.methods]
                raise Refused(f"{peer.name} has no method '{name}'{meant(name, known, self._some_of(peer)[2:])}")
            if len(found) > 1:
                choices = " or ".join(f"{peer.name}.{one.name}.{name}" for one in found[:_MOST])
                raise Refused(f"several interfaces have a method '{name}'; write {choices}")
            words = [found[0].scope.module.name, found[0].name, name]
        door = self.door(peer, words[:-1])
        for method in door.interface.methods:
            if method.name == name:
                return peer, door, method
        known = [one.name for one in door.interface.methods]
        listed = f"it has {', '.join(known)}" if known else "it has none"
        raise Refused(f"{door.interface.name} has no method '{name}'{meant(name, known, listed)}")

    def _some_of(self, peer: Peer) -> str:
        own = [one for one in peer.doors if one.scope is not common_behavior()] if peer.span.file else []
        names = [f"{peer.name}.{door.name}.{one.name}" for door in own or peer.doors for one in door.interface.methods]
        return f"; known are {some(names, _MOST)}" if names else "; it serves no interface of these documents"

    def _refuse_errors(self, files: set[str]) -> None:
        """Raises Faulty if one of these documents has errors."""
        if errors := [one for one in self.analysis.diagnostics if one.severity == ERROR and one.span.file in files]:
            raise Faulty(errors, self.program.documents)


def _prefixes(text: str) -> Iterator[str]:
    """The text up to each dot, the longest first."""
    while text:
        yield text
        text = text.rpartition(".")[0]


def _machine(address: str) -> str:
    return LOOPBACK if is_loopback(address or LOOPBACK) else address


def _proxy(endpoint: Endpoint, address: str) -> str:
    found = parse_endpoint(endpoint.text) or IceEndpoint(endpoint.port, endpoint.protocol)
    return f"{endpoint.identity}:{found.reached_at(address)}"
