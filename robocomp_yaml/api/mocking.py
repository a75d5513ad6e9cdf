"""Stand-ins for interfaces and topics of a workspace, so that a component can be tried without the others."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from robocomp_yaml.api import mock_scripts
from robocomp_yaml.api.expected import Expectations
from robocomp_yaml.api.refusals import require, without_ice
from robocomp_yaml.deploy import ice_ping
from robocomp_yaml.deploy.alone import local_ports
from robocomp_yaml.deploy.beside import beside
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.network import icestorm
from robocomp_yaml.network.draft import MANAGER, STORM_INSTANCE
from robocomp_yaml.network.network import LOOPBACK as LOCALHOST
from robocomp_yaml.network.network import RUNS, Network, NetworkHost
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.tree import text_at
from robocomp_yaml.wire.addresses import Address, Topic

if TYPE_CHECKING:
    from robocomp_yaml.wire.script import Script, Served
    from robocomp_yaml.wire.stand_ins import Call, Serving

LOOPBACK = "127.0.0.1"
_WITHIN = 1.0  # seconds for an IceStorm to answer


class Mock:
    """What stand-ins come to: interfaces by name, and a script. `diagnostics` are what is wrong with either.

    Raises Refused where Ice for Python is missing, or where nothing is named.
    """

    def __init__(self, names: Sequence[str], script: str = "", include: Iterable[str] = ()) -> None:
        if not names and not script:
            raise Refused("name the interfaces to stand in for, or a script: rcyaml mock Mouth")
        without_ice()
        self._root = root_above("") or "."
        self._analysis: Analysis = analyse([self._root], include)
        self._expectations = Expectations(self._analysis)
        reader = mock_scripts.reader(self._analysis)
        found = reader.of_names(text_at(Span(""), name) for name in names)
        self._refuse(one for one in found.diagnostics if not one.span.file)
        self._diagnostics: list[Diagnostic] = list(found.diagnostics)
        self._script: Script = found
        if script:
            root, misfits = mock_scripts.read(script, self._analysis.disk)
            self._diagnostics += misfits
            from_document = reader.of_document(root) if root is not None else None
            if from_document is not None:
                self._add(from_document)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        return self._analysis.redacted(self._diagnostics)

    def addresses(self, given: Mapping[str, str] | None = None) -> dict[str, list[Address]]:
        """Where each interface is served, by its type id: as `given` by its name, else as the script says, else
        wherever components of this workspace and its deployments expect it on this machine. Raises Refused if `given`
        names an interface that is not served."""
        served = [(one.interface.scope.module.name, one.interface.interface.name) for one in self._script.served]
        known = [name for _, name in served] + [f"{module}.{name}" for module, name in served]
        for name in given or ():
            require("interface", name, known, "this mock")
        return {one.interface.id: self._addresses(one, given or {}) for one in self._script.served}

    def topics(self, storm: str = "") -> dict[str, list[Topic]]:
        """To which topics each interface is published, by its type id: through the IceStorm `storm`, else the one of
        the script, else that of each component that subscribes."""
        manager = storm or self._script.storm
        return {
            one.interface.id: [Topic(manager, one.interface.interface.name)]
            if manager
            else self._expectations.topics(one.interface.scope.module.name, one.interface.interface.name)
            for one in self._script.published
        }

    @contextmanager
    def running(
        self, *, endpoints: Mapping[str, str] | None = None, storm: str = "",
        on_call: Callable[[Call], None] = lambda call: None,
    ) -> Iterator[list[Serving]]:  # fmt: skip
        """Serves and publishes while the context lasts; yields what is served. `on_call` is called in threads of Ice.
        If no IceStorm answers where one is expected on this machine, one is started, and stopped at the end. Raises
        Faulty where `diagnostics` has errors, Refused where an endpoint cannot be used."""
        from robocomp_yaml.wire.stand_ins import Serving, running

        if has_errors(self._diagnostics):
            raise Faulty(self.diagnostics, self._analysis.program.documents)
        addresses, topics = self.addresses(endpoints), self.topics(storm)
        with ExitStack() as started:
            storms = [] if storm or self._script.storm else self._missing_storms(topics)
            for port in storms:
                started.enter_context(beside(self._storm(port)))
            with running(self._script, addresses, topics, on_call) as served:
                made = [Serving(f"{STORM_INSTANCE}/{MANAGER}:tcp -h {LOOPBACK} -p {port}") for port in storms]
                yield [*served, *made]

    @staticmethod
    def _missing_storms(topics: Mapping[str, Sequence[Topic]]) -> list[int]:
        """The ports of this machine at which an IceStorm is expected, and does not answer."""
        managers = dict.fromkeys(topic.manager for each in topics.values() for topic in each)
        absent = [one for one in managers if not asyncio.run(ice_ping.answers(one, _WITHIN))]
        return list(dict.fromkeys(port for one in absent for port in local_ports(one)[:1]))

    def _storm(self, port: int) -> Network:
        """The network of an IceStorm, with a folder of the workspace."""
        root = os.path.abspath(self._root)
        folder = f"{root}/{RUNS}/storm-{port}"
        made = {"storm": icestorm.on_this_machine("storm", port, folder, Span(""))}
        return Network(f"storm-{port}", root, folder, {LOCALHOST: NetworkHost(LOCALHOST)}, made, order=(("storm",),))

    def _add(self, more: Script) -> None:
        """Joins what a script says to what was named: the script's answers win."""
        served = {one.interface.id for one in more.served}
        published = {one.interface.id for one in more.published}
        more.served[:0] = [one for one in self._script.served if one.interface.id not in served]
        more.published[:0] = [one for one in self._script.published if one.interface.id not in published]
        self._script = more
        self._diagnostics += more.diagnostics

    @staticmethod
    def _refuse(found: Iterable[Diagnostic]) -> None:
        """Names on the command line have no place in a document."""
        for one in found:
            raise Refused(one.message + (f"; {one.hint}" if one.hint else ""))

    def _addresses(self, served: Served, given: Mapping[str, str]) -> list[Address]:
        interface, module = served.interface.interface, served.interface.scope.module.name
        for name in (f"{module}.{interface.name}", interface.name):
            if name in given:
                return [Address(given[name], interface.name.lower())]
        if served.endpoint:
            return [Address(served.endpoint, interface.name.lower())]
        return self._expectations.servers(served.interface)
