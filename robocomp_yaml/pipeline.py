"""The pipeline: from paths to a linked program and its diagnostics.

Each pass uses the results of the passes before it. No result is changed later.

    discover   paths → which documents                                    source.discover
    read       each document once: bytes → tree → shape → model           link.documents (source, schemas, model)
    link       imports, names, parameters, values, deployments → program  link.linker
    complete   values documents → effective values, at their first use    program.effective (parameters.layers)
    derive     deployments → networks                                     network.networks
    check      what a schema cannot say, of documents and of networks     check
    report     suppressed diagnostics and severities of `lint:` applied, fixes spelled, secrets hidden

`check` is this pipeline, and no more. `compile` continues with its program.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.check import check_documents, checks_of_plugins
from robocomp_yaml.check.allowed import Allowances, AllowanceVerdict, commented_in
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.link import undeployed
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import NamedDocuments, Program
from robocomp_yaml.link.undeployed import Undeployed
from robocomp_yaml.link.workspace import ImportSearch, Workspaces
from robocomp_yaml.memory import Memory
from robocomp_yaml.network.networks import DerivedNetworks, networks_of
from robocomp_yaml.secrets import KINDS
from robocomp_yaml.source.discover import WORKSPACE_FILE, DiscoveredDocuments, discover, reads_again
from robocomp_yaml.source.disk import Disk, DiskRecord, Files
from robocomp_yaml.source.file_names import is_deployment
from robocomp_yaml.source.spelled import DocumentTexts, spelled

if TYPE_CHECKING:
    from robocomp_yaml.link.deployments import LinkedDeployment
    from robocomp_yaml.network.network import Network
    from robocomp_yaml.source.allowances import Allowance


class Analysis(msgspec.Struct, frozen=True):
    """A linked program with its sorted diagnostics, the documents by real path, the disk and the texts that they come
    from, its networks and the addresses of its components. `used` are the comments that suppress a diagnostic."""

    program: Program
    documents: Mapping[str, Document]
    workspaces: Workspaces
    search: ImportSearch
    discovered: DiscoveredDocuments
    disk: Disk
    derived: DerivedNetworks
    addresses: Addresses
    undeployed: Undeployed
    texts: DocumentTexts
    allowed: Allowances
    diagnostics: tuple[Diagnostic, ...] = ()
    used: frozenset[Allowance] = frozenset()

    @property
    def networks(self) -> Mapping[str, Network]:
        """The network of each deployment, by the real path of its document."""
        return self.derived.networks

    def with_more(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """All diagnostics, with more from another pass, as users see them."""
        return in_order([*self.diagnostics, *self.for_users(self.without_suppressed(diagnostics).reported)])

    def complete(self, diagnostics: Iterable[Diagnostic], *, environment: bool = False) -> list[Diagnostic]:
        """The same, if no pass follows. Without errors, which hide other diagnostics, it is then also known which
        comments suppress nothing, and these are reported for the requested documents."""
        more, read = self.without_suppressed(diagnostics), self.documents
        shown = in_order([*self.diagnostics, *self.for_users(more.reported)])
        if any(one.severity == ERROR for one in shown):
            return shown
        requested = [read[real].path for real in self.program.requested if real in read]
        files = {*requested, *(path for path in self.allowed.by_file if os.path.basename(path) == WORKSPACE_FILE)}
        unused = self.allowed.unused(sorted(files), self.used | more.used, environment=environment)
        return in_order([*shown, *self.for_users(self.without_suppressed(unused).reported)])

    def without_suppressed(self, diagnostics: Iterable[Diagnostic]) -> AllowanceVerdict:
        """The diagnostics that no comment suppresses."""
        return self.allowed.judge(diagnostics, lambda file: self.workspaces.of(file).lint)

    def for_users(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics as users see them: with the severities that their workspaces set, with fixes that say which text
        to write, and without secrets."""
        return self.redacted(spelled(_with_lint(diagnostics, self.workspaces), self.texts))

    def redacted(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics without the secrets that the documents contain."""
        shown = list(diagnostics)
        hidden = self.hidden({span.file for one in shown for span in (one.span, *(r.span for r in one.related))})
        return [hidden.veiled(one) for one in shown]

    def hidden(self, files: set[str] | None = None) -> Hidden:
        """The secrets that these documents contain, by default all documents."""
        documents = self.documents.values()
        files = {document.path for document in documents} if files is None else files
        if not files:
            return Hidden()
        from robocomp_yaml.check import secrets  # most runs of interfaces alone show no document

        return secrets.hidden(self.program, documents, files)


def search_folders(include: Iterable[str]) -> tuple[str, ...]:
    """The folders of `-I`, then those of RCYAML_PATH."""
    return (*include, *(folder for folder in os.environ.get("RCYAML_PATH", "").split(os.pathsep) if folder))


def analyse(
    paths: Iterable[str],
    include: Iterable[str] = (),
    on_read: Callable[[str], None] | None = None,
    overlay: Mapping[str, bytes] | None = None,
    memory: Memory | None = None,
    files: Files | None = None,
) -> Analysis:
    """The analysis of the documents at these paths. `include` are folders to search for imports; `on_read` is called
    with the path of each document that is read. `overlay` has contents by path that replace those on the disk. `memory`
    has what earlier analyses computed; the result is the same without it. `files` are the files of the disk."""
    disk = Disk(overlay, files)
    memory = memory if memory is not None else Memory(once=True)
    discovered = discover(list(paths), disk)
    workspaces, search = Workspaces(disk), ImportSearch(search_folders(include), disk)

    def linker_of(known: Mapping[str, Document]) -> Linker:
        read = Documents(disk, on_read or (lambda path: None), workspaces.plugins_of, memory, known)
        return Linker(read, search, workspaces)

    linker = linker_of({})
    rest = _link_undeployed(linker, linker.follow(discovered.documents), discovered)
    documents = linker.documents.read
    addresses = Addresses(linker.linked(), workspaces, lambda paths: linker_of(documents).link(paths))
    derived = _derive(linker, rest, addresses, discovered) if linker.deployments else DerivedNetworks()
    program = linker.linked()
    diagnostics = [*discovered.diagnostics, *linker.documents.diagnostics, *workspaces.diagnostics, *linker.diagnostics]
    for check in checks_of_plugins(program, [one.plugins for one in workspaces.declared]):
        diagnostics += check(program)
    diagnostics += addresses.faults()
    if any(document.kind in KINDS for document in documents.values()):
        from robocomp_yaml.check import secrets  # components alone have none

        others = [document for real, document in documents.items() if real not in rest.documents]
        part = "secrets", discovered.documents

        def find() -> tuple[list[secrets.Held], DiskRecord]:
            before = disk.record()
            return list(secrets.held(program, rest.documents.values())), disk.record(since=before)

        held, record = memory.result(part, (rest,), find, lambda kept: reads_again(kept[1], disk))
        disk.recall(record)
        diagnostics += secrets.check(program, [*held, *secrets.held(program, others)])
    texts = DocumentTexts(disk.contents, {document.path: document.tree for document in documents.values()})
    part = "commented", discovered.documents
    commented = memory.result(part, (rest,), lambda: commented_in(rest.record.contents))
    more = commented_in({path: raw for path, raw in disk.contents.items() if path not in rest.record.contents})
    allowed = Allowances.of(texts, [*commented, *more], program.plugins_of)
    analysis = Analysis(
        program, documents, workspaces, search, discovered, disk, derived, addresses, rest, texts, allowed
    )
    judged = analysis.without_suppressed([*diagnostics, *analysis.allowed.faults])
    return replace(analysis, diagnostics=tuple(in_order(analysis.for_users(judged.reported))), used=judged.used)


def alone(path: str, overlay: Mapping[str, bytes], memory: Memory, files: Files) -> list[Diagnostic]:
    """The diagnostics of a document's syntax and shape, without anything that it refers to."""
    disk = Disk(overlay, files)
    workspaces = Workspaces(disk)
    read = Documents(disk, plugins_of=workspaces.plugins_of, memory=memory)
    document = read.get(path)
    texts = DocumentTexts(disk.contents, {path: document.tree})
    allowed = Allowances.of(texts, commented_in(disk.contents), workspaces.plugins_of)
    judged = allowed.judge(read.diagnostics, lambda file: workspaces.of(file).lint)
    shown = list(spelled(_with_lint(judged.reported, workspaces), texts))
    if not shown:
        return []
    from robocomp_yaml.check import secrets

    hidden = secrets.hidden(Program(disk=disk), [document], {path})
    return in_order(hidden.veiled(one) for one in shown)


def _link_undeployed(linker: Linker, named: NamedDocuments, discovered: DiscoveredDocuments) -> Undeployed:
    """Links and checks everything but the deployments, or recalls it from the last analysis of the same documents."""
    memory, is_new = linker.documents.memory, False

    def make() -> Undeployed:
        nonlocal is_new
        is_new = True
        return undeployed.linked(linker, named, check_documents)

    if not any(map(is_deployment, discovered.documents)):  # an edit of another document changes all of this
        return make()
    part = "undeployed", discovered.documents, tuple(linker.deployments)
    disk = linker.documents.disk
    causes = undeployed.causes(linker, named)
    known = memory.result(part, causes, make, lambda kept: reads_again(kept.record, disk))
    if not is_new:
        undeployed.recall(linker, known)
    return known


class _Derived(msgspec.Struct, frozen=True):
    """Linked deployments, their networks and all diagnostics, with what was requested of the disk for them and what was
    computed. `is_lasting`: no plug-in checked them, whose checks may depend on anything."""

    deployments: Mapping[str, LinkedDeployment]
    networks: DerivedNetworks
    diagnostics: list[Diagnostic]
    record: DiskRecord
    kept: undeployed.Kept
    is_lasting: bool


def _derive(linker: Linker, rest: Undeployed, addresses: Addresses, discovered: DiscoveredDocuments) -> DerivedNetworks:
    """Links the deployments, and derives and checks their networks, or recalls them from the last analysis of the same
    deployments and components."""
    from robocomp_yaml.check.networks import check_networks  # most runs have no deployment

    disk, memory, is_new = linker.documents.disk, linker.documents.memory, False

    def make() -> _Derived:
        nonlocal is_new
        is_new, begin = True, len(linker.diagnostics)
        linker.link_deployments()
        program = linker.linked()
        networks = networks_of(program, addresses)
        linker.diagnostics += check_networks(networks, program)
        documents = {linker.documents.read[real].path for real in linker.deployments}
        return _Derived(
            program.deployments, networks, linker.diagnostics[begin:], disk.record(documents, rest.record),
            undeployed.kept_of(linker),
            not any(linker.workspaces.plugins_of(model.path).active for model in models.values()),
        )  # fmt: skip

    part, models = ("networks", discovered.documents), linker.deployments
    causes = rest, disk.version, *models, *models.values()
    made = memory.result(part, causes, make, lambda kept: kept.is_lasting and reads_again(kept.record, disk))
    if not is_new:
        linker.tables.deployments.update(made.deployments)
        linker.diagnostics += made.diagnostics
        disk.recall(made.record)
        undeployed.recall_kept(linker, made.kept)
    return made.networks


def _with_lint(diagnostics: Iterable[Diagnostic], workspaces: Workspaces) -> Iterator[Diagnostic]:
    """Diagnostics with the severities that the `lint:` of their workspaces sets. `off` drops one."""
    for diagnostic in diagnostics:
        severity = workspaces.of(diagnostic.span.file).lint.get(diagnostic.code, diagnostic.severity)
        if severity != "off":
            yield diagnostic if severity == diagnostic.severity else diagnostic.as_severity(severity)
