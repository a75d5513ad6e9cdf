"""The pipeline: paths to a linked program and everything that is wrong with it.

Each pass takes what the one before it gave, and nothing is changed once it is given:

    discover   paths → which documents                                    source.discover
    read       each document once: bytes → tree → shape → model           link.documents (source, schemas, model)
    link       imports, names, parameters, values, deployments → program  link.linker
    complete   values documents → effective values, when first asked for  program.effective (parameters.layers)
    derive     deployments → networks                                     network.networks
    check      what no schema can say, of documents and of networks       check
    tell       what comments allow and `lint:` asks for, fixes spelled, secrets hidden

`check` is this and no more; `compile` goes on from the program that it gives.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.check import checks, secrets
from robocomp_yaml.check.allowed import Allowed, Judged
from robocomp_yaml.check.networks import of_networks
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.link.documents import Documents
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.workspace import Search
from robocomp_yaml.network.networks import Derived, networks_of
from robocomp_yaml.source.allowances import Allowance
from robocomp_yaml.source.discover import WORKSPACE_FILE, DiscoveredDocuments, discover
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentTexts, spelled

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network


class Analysis(msgspec.Struct, frozen=True):
    """A program with its diagnostics, sorted, the disk that they were read from, its texts as they were read, and its
    networks; `used` are the comments that allow some of what was found."""

    program: Program
    linker: Linker
    found: DiscoveredDocuments
    disk: Disk
    derived: Derived
    texts: DocumentTexts
    allowed: Allowed
    diagnostics: tuple[Diagnostic, ...] = ()
    used: frozenset[Allowance] = frozenset()

    @property
    def networks(self) -> Mapping[str, Network]:
        """What the deployments come to, by real path."""
        return self.derived.networks

    def with_more(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """All diagnostics with some that were found elsewhere, as users get them."""
        return in_order([*self.diagnostics, *self.shown(self.judged(diagnostics).told)])

    def whole(self, diagnostics: Iterable[Diagnostic], *, environment: bool = False) -> list[Diagnostic]:
        """The same, where these are all that there is: then it is known, too, which comments allow what nobody said, of
        the documents asked for."""
        more, read = self.judged(diagnostics), self.linker.documents.read
        asked = [read[real].path for real in self.program.asked if real in read]
        files = {*asked, *(path for path in self.allowed.by_file if os.path.basename(path) == WORKSPACE_FILE)}
        vain = self.judged(self.allowed.in_vain(sorted(files), self.used | more.used, environment=environment))
        return in_order([*self.diagnostics, *self.shown((*more.told, *vain.told))])

    def judged(self, diagnostics: Iterable[Diagnostic]) -> Judged:
        """Diagnostics without those that comments allow."""
        return self.allowed.judge(diagnostics, lambda file: self.linker.workspace_of(file).lint)

    def shown(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics as users get them: at the severities that the workspaces ask for, with fixes that say what to
        write, and without secrets."""
        return self.veiled(spelled(_with_lint(diagnostics, self.linker), self.texts))

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
    found = discover(list(paths), disk)
    linker = Linker(Documents(disk, on_read), Search(search_folders(extra), disk))
    program = linker.link(found.documents)
    derived = networks_of(program)
    said = [*found.diagnostics, *linker.documents.diagnostics, *linker.diagnostics]
    for check in checks(program, [one.plugins for one in linker.workspaces.values()]):
        said += check(program)
    said += of_networks(derived, program)
    said += secrets.check(program, linker.documents.read.values())
    texts = DocumentTexts(disk.contents, linker.documents.trees())
    allowed = Allowed.of(texts, program.plugins_of)
    analysis = Analysis(program, linker, found, disk, derived, texts, allowed)
    judged = analysis.judged([*said, *analysis.allowed.said])
    return replace(analysis, diagnostics=tuple(in_order(analysis.shown(judged.told))), used=judged.used)


def _with_lint(diagnostics: Iterable[Diagnostic], linker: Linker) -> Iterator[Diagnostic]:
    """The severities that each document's workspace asks for."""
    for diagnostic in diagnostics:
        wanted = linker.workspace_of(diagnostic.span.file).lint.get(diagnostic.code, diagnostic.severity)
        if wanted != "off":
            yield diagnostic if wanted == diagnostic.severity else diagnostic.as_severity(wanted)
