"""Discovers documents by their names, in and below the requested paths."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.codes.values import MISNAMED
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.source.disk import NOTHING, Disk, DiskRecord
from robocomp_yaml.source.file_names import WORKSPACE_FILE as WORKSPACE_FILE

SCRIPT = ".mock.yaml"
KINDS = ("idsl", "cdsl", "pdsl", "ddsl", "config")
_MODELINE = re.compile(
    rb"(?:\xef\xbb\xbf)?(?:[ \t]*(?:#[^\r\n]*|%[^\r\n]*|---[ \t]*)?\r?\n)*"
    rb"[ \t]*#[ \t]*yaml-language-server:[ \t]*\$schema=\S*(?:\.rcyaml/schemas|generated)/config\.schema\.json"
    rb"[ \t]*(?:\r?\n|\Z)"
)
_HEAD = 4096  # bytes of a document, in which its first keys are
_KEY = re.compile(r"^([a-z]+)[ \t]*:", re.MULTILINE)
_SHOWN_BY = {"idsl": {"module"}, "ddsl": {"deployment"}, "cdsl": {"component", "language"}}
MANIFEST = ".rcyaml/manifest.json"
_SKIPPED = frozenset(("node_modules", "__pycache__", "build", "generated"))


def kind_of(path: str, disk: Disk | None = None) -> str | None:
    """The kind of a document, `idsl` for `NAME.idsl.yaml` and `idsl.yaml`; None if the file is not a document."""
    if not path.endswith(".yaml"):
        return None
    name = os.path.basename(path)
    for kind in KINDS:
        if name == f"{kind}.yaml" or name.endswith(f".{kind}.yaml"):
            return kind if name != "config.yaml" or _is_values_document(path, disk or Disk()) else None
    return None


def is_script(path: str) -> bool:
    """Whether a file is a mock script, by its name."""
    return path.endswith(SCRIPT)


def _is_values_document(path: str, disk: Disk) -> bool:
    """Many programs have a `config.yaml`. A values document is in `etc/` beside a component, or names the schema in a
    comment above its content, where editors read it."""
    folder = os.path.dirname(path)
    if name_of_folder(folder) == "etc":
        names = disk.documents(os.path.join(folder, os.pardir))
        if any(name == "cdsl.yaml" or name.endswith(".cdsl.yaml") for name in names):
            return True
    return _MODELINE.match(disk.peek(path, 1 << 12)) is not None


def name_of_folder(folder: str) -> str:
    """The name of a folder, also of the working folder and of those above it."""
    name = os.path.basename(folder)
    return os.path.basename(os.path.abspath(folder)) if name in ("", os.curdir, os.pardir) else name


class DiscoveredDocuments(msgspec.Struct, frozen=True):
    """Documents in the order of their paths; `folders` are the requested folders, `roots` the folders below them that
    have a manifest. `scripts` are mock scripts, which only `check` and `mock` read."""

    documents: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    roots: tuple[str, ...] = ()
    scripts: tuple[str, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def discover(paths: list[str] | tuple[str, ...], disk: Disk | None = None) -> DiscoveredDocuments:
    """The documents among the paths, and all below the folders among them; hidden and generated folders are skipped."""
    disk = disk or Disk()
    documents: dict[str, None] = {}
    folders: list[str] = []
    roots: list[str] = []
    scripts: list[str] = []
    diagnostics: list[Diagnostic] = []
    for path in paths:
        if disk.has_folder(path):
            folders.append(path)
            unreadable: list[OSError] = []
            before = len(scripts)
            misnamed: list[str] = []
            below = list(documents_below(path, roots, unreadable.append, disk, scripts, misnamed))
            diagnostics += (_misnamed(name) for name in misnamed)
            diagnostics += [
                codes.UNREADABLE.at(Span(os.path.normpath(error.filename)), reason=reason_of(error))
                for error in unreadable
            ]
            if not below and not unreadable and len(scripts) == before:
                hint = "`rcyaml new interface NAME` writes a first document"
                hint += f", `{typed('rcyaml', 'migrate', path)}` converts legacy files"
                diagnostics.append(codes.NOTHING_FOUND.at(Span(path), hint=hint))
        elif is_script(path) and disk.state(path) != NOTHING:
            scripts.append(os.path.normpath(path))
            continue
        elif kind_of(path, disk) is None and disk.state(path) != NOTHING:
            suffixes = [f".{kind}.yaml" for kind in KINDS]
            expected = f"{', '.join(suffixes[:-1])} or {suffixes[-1]}"
            name, hint = os.path.basename(path), ""
            if name == "rcyaml.yaml":
                hint = f"`{typed('rcyaml', 'check', os.path.dirname(path) or '.')}` reads it with the documents"
            elif not name.endswith(".yaml"):
                hint = f"if it is a legacy file, `{typed('rcyaml', 'migrate', path)}` converts it"
            elif kind := _kind_in(disk.peek(path, _HEAD)):
                named = f"{path.removesuffix('.yaml')}.{kind}.yaml"
                hint = f"its content is that of {kind.upper()}: rename it, `{typed('mv', path, named)}`"
            diagnostics.append(codes.UNKNOWN_KIND.at(Span(path), name=name, kinds=expected, hint=hint))
            continue
        else:
            below = [os.path.normpath(path)]
        documents.update(dict.fromkeys(below))
    return DiscoveredDocuments(
        tuple(documents), tuple(folders), tuple(roots), tuple(dict.fromkeys(scripts)), tuple(diagnostics)
    )


def _kind_in(head: bytes) -> str:
    """The kind that the first keys of a document show, or ''."""
    keys = set(_KEY.findall(head.decode("utf-8", "replace")))
    return next((kind for kind, needed in _SHOWN_BY.items() if needed <= keys), "")


def _renamed(path: str) -> str:
    return f"{path.removesuffix('.yml')}.yaml"


def _misnamed(path: str) -> Diagnostic:
    """A warning about a document whose name ends with `.yml`."""
    return MISNAMED.at(Span(path), path=path, hint=f"rename it: `{typed('mv', path, _renamed(path))}`")


def is_skipped(path: str) -> bool:
    """Whether a relative path is in a folder in which no documents are searched."""
    return any(part in _SKIPPED or part.startswith(".") for part in path.split(os.sep))


def of_kind(folder: str, kind: str, disk: Disk | None = None) -> list[str]:
    """The documents of a kind below a folder, in the order of `documents_below`; '' is the working folder."""
    disk = disk or Disk()
    known = disk.walked.get(folder or ".")
    below = documents_below(folder or ".", disk=disk) if known is None else known
    return [path for path in below if kind_of(path, disk) == kind]


def finds_again(walked: Mapping[str, list[str]], disk: Disk | None = None) -> bool:
    """Whether the documents below these folders are still the same. A Disk searches each folder once."""
    known = disk.walked if disk is not None else {}
    return all(
        (known[folder] if folder in known else list(documents_below(folder, disk=disk))) == found
        for folder, found in walked.items()
    )


def reads_again(record: DiskRecord, disk: Disk) -> bool:
    """Whether files have the recorded contents, and the same documents are found below the recorded folders. All else
    that is recorded is the same as long as the version of the disk is."""
    return disk.has_contents(record) and finds_again(record.walked, disk)


def documents_below(
    folder: str,
    roots: list[str] | None = None,
    on_error: Callable[[OSError], None] | None = None,
    disk: Disk | None = None,
    scripts: list[str] | None = None,
    misnamed: list[str] | None = None,
) -> Iterator[str]:
    """Every document below a folder, sorted within each folder; links to folders are not followed, and hidden files are
    skipped. Folders that have a manifest are appended to `roots`, mock scripts to `scripts`, documents with the suffix
    `.yml` to `misnamed`; `on_error` is called for folders that cannot be read."""
    disk = disk or Disk()
    documents: list[str] = []
    for where, folders, names in disk.walk(folder, on_error):
        if roots is not None and ".rcyaml" in folders and os.path.isfile(os.path.join(where, MANIFEST)):
            roots.append(os.path.normpath(where))
        folders[:] = [name for name in folders if not is_skipped(name)]
        for name in names:
            if name.startswith("."):
                continue  # see `documents_in`
            if name.endswith(".yaml") and kind_of(path := os.path.normpath(os.path.join(where, name)), disk):
                documents.append(path)
                yield path
            elif scripts is not None and is_script(name):
                scripts.append(os.path.normpath(os.path.join(where, name)))
            elif misnamed is not None and name.endswith(".yml"):
                path = os.path.normpath(os.path.join(where, name))
                kind = kind_of(_renamed(path), disk)
                if kind is not None and (kind != "config" or name == "config.yml") and _renamed(name) not in names:
                    misnamed.append(path)
    disk.walked[folder] = documents
