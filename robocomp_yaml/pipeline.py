"""The pipeline: paths to a linked program and everything that is wrong with it.

discover → (read → tree → shape → model, each document once) → link → checks (with networks, where there are
deployments). `check` is this and no more; `compile` goes on from the program that it gives.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.check import checks, secrets
from robocomp_yaml.check.allowed import Allowed
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.link.documents import Documents
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.workspace import Search
from robocomp_yaml.source.discover import WORKSPACE_FILE, Found, discover
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import spelled

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network


class Analysis(msgspec.Struct):
    """A program with its diagnostics, sorted, and the disk that they were read from. `networks` are what the
    deployments come to, by real path."""

    program: Program
    linker: Linker
    found: Found
    diagnostics: list[Diagnostic]
    disk: Disk
    networks: dict[str, Network] = {}
    allowed: Allowed = msgspec.field(default_factory=Allowed)

    def with_more(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """All diagnostics with some that were found elsewhere, at the severities that the workspaces ask for."""
        return in_order([*self.diagnostics, *self.told(diagnostics)])

    def told(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics as users get them: without those that comments allow, and without secrets, at the severities
        that the workspaces ask for, with fixes that say what to write."""
        told = list(self.allowed.told(diagnostics, lambda file: self.linker.workspace_of(file).lint))
        told += self.allowed.of_errors()
        return self.veiled(spelled(_with_lint(told, self.linker), self.disk.contents))

    def allowed_in_vain(self, *, environment: bool = False) -> list[Diagnostic]:
        """What comments allow that nobody said, of the documents asked for; known once all is checked that there is."""
        read = self.linker.documents.read
        asked = [read[real].path for real in self.program.asked if real in read]
        files = {*asked, *(path for path in self.allowed.by_file if os.path.basename(path) == WORKSPACE_FILE)}
        return self.told(self.allowed.in_vain(sorted(files), environment=environment))

    def veiled(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics without the secrets that the documents hold."""
        told = list(diagnostics)
        hidden = self.hidden({span.file for one in told for span in (one.span, *(r.span for r in one.related))})
        return [hidden.veiled(one) for one in told]

    def hidden(self, files: set[str] | None = None) -> Hidden:
        """The secrets that these documents hold, or all."""
        documents = self.linker.documents.read.values()
        files = {document.path for document in documents} if files is None else files
        return secrets.hidden(self.program, documents, files) if files else Hidden()


def search_folders(given: Iterable[str]) -> tuple[str, ...]:
    """The folders of `-I` and, behind them, of RCYAML_PATH."""
    return (*given, *(folder for folder in os.environ.get("RCYAML_PATH", "").split(os.pathsep) if folder))


def analyse(
    paths: Iterable[str],
    extra: Iterable[str] = (),
    on_read: Callable[[str], None] = lambda path: None,
    overlay: Mapping[str, bytes] | None = None,
) -> Analysis:
    """All about the documents at these paths; `extra` are folders to look for imports in, `on_read` is told of each
    document that is read. `overlay` has contents, by path, that count instead of the disk's."""
    disk = Disk(overlay)
    documents = Documents(disk, on_read)
    linker = Linker(documents, Search(search_folders(extra), disk))
    found = discover(list(paths), disk)
    program = linker.link(found.documents)
    said = [*found.diagnostics, *documents.diagnostics, *linker.diagnostics]
    for run in checks(program, [one.plugins for one in linker.workspaces.values()]):
        said += run(program)
    networks: dict[str, Network] = {}
    if program.deployments:
        from robocomp_yaml.check.networks import networks_of  # most programs have none

        networks, more = networks_of(program)
        said += more
    said += secrets.check(program, documents.read.values())
    analysis = Analysis(program, linker, found, [], disk, networks)
    analysis.allowed = Allowed.of(disk.contents, program.plugins_of)
    analysis.diagnostics = in_order(analysis.told([*said, *analysis.allowed.said]))
    return analysis


def _with_lint(diagnostics: Iterable[Diagnostic], linker: Linker) -> Iterator[Diagnostic]:
    """The severities that each document's workspace asks for."""
    for diagnostic in diagnostics:
        wanted = linker.workspace_of(diagnostic.span.file).lint.get(diagnostic.code, diagnostic.severity)
        if wanted != "off":
            yield diagnostic if wanted == diagnostic.severity else diagnostic.as_severity(wanted)
