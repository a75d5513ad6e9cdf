"""Which files are documents: by their names, below the paths that a user gives."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.source.disk import NOTHING, Disk

KINDS = ("idsl", "cdsl", "pdsl", "ddsl", "config")
_MODELINE = re.compile(
    rb"(?:\xef\xbb\xbf)?(?:[ \t]*(?:#[^\r\n]*|%[^\r\n]*|---[ \t]*)?\r?\n)*"
    rb"[ \t]*#[ \t]*yaml-language-server:[ \t]*\$schema=\S*(?:\.rcyaml/schemas|generated)/config\.schema\.json"
    rb"[ \t]*(?:\r?\n|\Z)"
)
WORKSPACE_FILE = "rcyaml.yaml"
MANIFEST = ".rcyaml/manifest.json"
_SKIPPED = frozenset(("node_modules", "__pycache__", "build", "generated"))


def kind_of(path: str, disk: Disk | None = None) -> str | None:
    """`idsl` for `NAME.idsl.yaml` and for `idsl.yaml`; None for what is no document of ours."""
    name = os.path.basename(path)
    for kind in KINDS:
        if name == f"{kind}.yaml" or name.endswith(f".{kind}.yaml"):
            return kind if name != "config.yaml" or _is_ours(path, disk or Disk()) else None
    return None


def _is_ours(path: str, disk: Disk) -> bool:
    """Many programs have a `config.yaml`: ours stands in `etc/` beside a component, or names our schema in a comment
    above its content, where editors look for it."""
    folder = os.path.dirname(path)
    if os.path.basename(os.path.abspath(folder)) == "etc":
        names = disk.documents(os.path.join(folder, os.pardir))
        if any(name == "cdsl.yaml" or name.endswith(".cdsl.yaml") for name in names):
            return True
    return _MODELINE.match(disk.peek(path, 1 << 12)) is not None


class Found(msgspec.Struct, frozen=True):
    """Documents in the order of their paths; `folders` are those that were asked for, `roots` the folders below them
    into which something was compiled."""

    documents: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    roots: tuple[str, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def discover(paths: list[str] | tuple[str, ...], disk: Disk | None = None) -> Found:
    """The documents named, and all below the folders named; hidden and generated folders are passed over."""
    disk = disk or Disk()
    documents: dict[str, None] = {}
    folders: list[str] = []
    roots: list[str] = []
    said: list[Diagnostic] = []
    for path in paths:
        if disk.has_folder(path):
            folders.append(path)
            closed: list[OSError] = []
            below = list(documents_below(path, roots, closed.append, disk))
            said += [
                codes.UNREADABLE.at(
                    Span(os.path.normpath(error.filename)), reason=(error.strerror or str(error)).lower()
                )
                for error in closed
            ]
            if not below and not closed:
                said.append(
                    codes.NOTHING_FOUND.at(
                        Span(path),
                        hint="`rcyaml new interface NAME` writes a first one, "
                        f"`{typed('rcyaml', 'migrate', path)}` carries over what you have",
                    )
                )
        elif kind_of(path, disk) is None and disk.state(path) != NOTHING:
            expected = " or ".join(f".{kind}.yaml" for kind in KINDS)
            migrate = f"`{typed('rcyaml', 'migrate', path)}` carries legacy files over"
            hint = migrate if not path.endswith(".yaml") else ""
            said.append(codes.UNKNOWN_KIND.at(Span(path), name=os.path.basename(path), kinds=expected, hint=hint))
            continue
        else:
            below = [os.path.normpath(path)]
        documents.update(dict.fromkeys(below))
    return Found(tuple(documents), tuple(folders), tuple(roots), tuple(said))


def of_kind(folder: str, kind: str, disk: Disk | None = None) -> list[str]:
    """The documents of a kind below a folder, in the order of `documents_below`; '' is the working folder."""
    disk = disk or Disk()
    return [path for path in documents_below(folder or ".", disk=disk) if kind_of(path, disk) == kind]


def documents_below(
    folder: str,
    roots: list[str] | None = None,
    on_error: Callable[[OSError], None] | None = None,
    disk: Disk | None = None,
) -> Iterator[str]:
    """Every document below a folder, sorted within each folder; a link to a folder is not followed. The folders that
    have a manifest are added to `roots`, and `on_error` is told of those that cannot be read."""
    disk = disk or Disk()
    found: list[str] = []
    for where, folders, names in disk.walk(folder, on_error):
        if roots is not None and ".rcyaml" in folders and os.path.isfile(os.path.join(where, MANIFEST)):
            roots.append(os.path.normpath(where))
        folders[:] = [name for name in folders if name not in _SKIPPED and not name.startswith(".")]
        for name in names:
            if name.endswith(".yaml") and kind_of(path := os.path.normpath(os.path.join(where, name)), disk):
                found.append(path)
                yield path
    disk.walked[folder] = found
