"""Stand-ins for interfaces and topics of a workspace, so that a component can be tried without the others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from robocomp_yaml.api.neighbours import workspace_ports
from robocomp_yaml.api.refusals import without_ice
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.ports import PortTable
from robocomp_yaml.network.port_numbers import default_port
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source import schema, text
from robocomp_yaml.source.ice_endpoint import IceEndpoint
from robocomp_yaml.source.tree import Mapping as Node
from robocomp_yaml.source.tree import parse, text_at

if TYPE_CHECKING:
    from robocomp_yaml.wire.script import Script, Served
    from robocomp_yaml.wire.stand_ins import Call

LOOPBACK = "127.0.0.1"


class Mock:
    """What stand-ins come to: interfaces by name, and a script. `diagnostics` are what is wrong with either.

    Raises Refused where Ice for Python is missing, or where nothing is named.
    """

    def __init__(self, names: Sequence[str], script: str = "", include: Iterable[str] = ()) -> None:
        if not names and not script:
            raise Refused("name the interfaces to stand in for, or a script: rcyaml mock Mouth")
        without_ice()
        from robocomp_yaml.wire.script import Reader

        self._analysis: Analysis = analyse(["."], include)
        errors = (one for one in self._analysis.diagnostics if one.severity == ERROR)
        reader = Reader(self._analysis.program.modules.values(), errors)
        found = reader.of_names(text_at(Span(""), name) for name in names)
        self._refuse(one for one in found.diagnostics if not one.span.file)
        self._diagnostics: list[Diagnostic] = list(found.diagnostics)
        self._script: Script = found
        if script:
            root = self._read(script)
            from_document = reader.of_document(root) if root is not None else None
            if from_document is not None:
                self._add(from_document)
        self._ports: PortTable | None = None

    @property
    def diagnostics(self) -> list[Diagnostic]:
        return self._analysis.redacted(self._diagnostics)

    def endpoints(self, given: Mapping[str, str] | None = None) -> dict[str, str]:
        """Where each interface is served, by its type id: as `given` by its name, else as the script says, else where
        components of this workspace expect it."""
        return {one.interface.id: self._endpoint(one, given or {}) for one in self._script.served}

    @contextmanager
    def running(
        self, *, endpoints: Mapping[str, str] | None = None, storm: str = "",
        on_call: Callable[[Call], None] = lambda call: None,
    ) -> Iterator[list[str]]:  # fmt: skip
        """Serves and publishes while the context lasts; yields what is served, as proxies. `on_call` is called in
        threads of Ice. Raises Faulty where `diagnostics` has errors, Refused where an endpoint cannot be used."""
        from robocomp_yaml.wire.stand_ins import running

        if has_errors(self._diagnostics):
            raise Faulty(self.diagnostics, self._analysis.program.documents)
        with running(self._script, self.endpoints(endpoints), storm, on_call) as proxies:
            yield proxies

    def _add(self, more: Script) -> None:
        """Joins what a script says to what was named: the script's answers win."""
        served = {one.interface.id for one in more.served}
        published = {one.interface.id for one in more.published}
        more.served[:0] = [one for one in self._script.served if one.interface.id not in served]
        more.published[:0] = [one for one in self._script.published if one.interface.id not in published]
        self._script = more
        self._diagnostics += more.diagnostics

    def _read(self, path: str) -> Node | None:
        raw, faults = text.read_bytes(path)
        decoded, more = text.decode(path, raw) if raw is not None else (None, [])
        root, syntax = parse(path, decoded) if decoded is not None else (None, [])
        misfits = schema.validate("mock", root) if root is not None else []
        self._diagnostics += [*faults, *more, *syntax, *misfits]
        return root if isinstance(root, Node) and not has_errors(misfits) else None

    @staticmethod
    def _refuse(found: Iterable[Diagnostic]) -> None:
        """Names on the command line have no place in a document."""
        for one in found:
            raise Refused(one.message + (f"; {one.hint}" if one.hint else ""))

    def _endpoint(self, served: Served, given: Mapping[str, str]) -> str:
        interface = served.interface.interface
        for name in (f"{served.interface.scope.module.name}.{interface.name}", interface.name):
            if name in given:
                return given[name]
        if served.endpoint:
            return served.endpoint
        if self._ports is None:
            self._ports = workspace_ports(self._analysis)
        found = self._ports.implementers.get((served.interface.scope.module.name, interface.name), ())
        for linked, adapter in found:
            endpoint = self._ports.endpoint(linked, adapter)
            return f"{endpoint.protocol} -h {endpoint.host or LOOPBACK} -p {endpoint.port}"
        expected = IceEndpoint(default_port("", interface.name))
        return f"{expected.protocol} -h {LOOPBACK} -p {expected.port}"
