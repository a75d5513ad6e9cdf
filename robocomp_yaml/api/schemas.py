"""Which schema applies to a document, and how editors find it."""

from __future__ import annotations

import os
import re
from functools import lru_cache

import msgspec

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused, reason_of
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.link.workspace_files import GLOBS, modeline, schema_of, schema_path
from robocomp_yaml.link.workspace_names import names_below
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.discover import WORKSPACE_FILE, kind_of
from robocomp_yaml.source.regular import regular, whole
from robocomp_yaml.source.schema_names import offered_in

_MODELINE = re.compile(r"^#\s*yaml-language-server\s*:.*?\$schema\s*=\s*(\S+)", re.MULTILINE)
_HEAD = 10_000  # characters that editors search


class Schema(msgspec.Struct, frozen=True):
    """The schema of a document's kind in its workspace, whose folder is `root`. `named` is the schema that the first
    lines of the document name, `path` the file of the schema; both are '' if there is none. `modeline` is what the
    first line should be."""

    kind: str
    root: str
    named: str
    path: str
    modeline: str

    @property
    def is_missing(self) -> bool:
        return bool(self.path) and not os.path.isfile(self.path)

    def is_outdated(self, plugins: Plugins) -> bool:
        """Whether the file differs from the schema of this version, with the plug-ins and names of the workspace."""
        if not self.path:
            return False
        return whole(self.path)[0] != schema_of(self.kind, plugins, names_below(self.root)).encode("utf-8")


def installed(root: str) -> dict[str, str]:
    """The path of the schema of each kind in a workspace; '' if it is missing."""
    paths = {kind: os.path.normpath(os.path.join(root, schema_path(kind))) for kind in GLOBS}
    return {kind: path if os.path.isfile(path) else "" for kind, path in paths.items()}


def schema_for(document: str) -> Schema:
    """The schema of a document. Raises Refused if there is no such document, or it cannot be read."""
    kind = _kind_of(document)
    folder = os.path.dirname(document) or "."
    root = root_above(folder) or folder
    named = _named(document)
    path = os.path.normpath(os.path.join(folder, named)) if "://" not in named else ""
    return Schema(kind, root, named, path if named else installed(root)[kind], modeline(kind, document, root))


def names_offered(document: str) -> frozenset[str]:
    """The names that the schema of a document's workspace offers to editors, so that no other server has to; none if
    the schema is missing or older. The document need not exist."""
    kind, root = kind_of(document), root_above(os.path.dirname(document) or ".")
    if kind is None or root is None:
        return frozenset()
    path = os.path.join(root, schema_path(kind))
    try:
        status = os.stat(path)
    except OSError:
        return frozenset()
    return _offered(path, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=16)
def _offered(path: str, time: int, size: int) -> frozenset[str]:
    try:
        return offered_in(msgspec.json.decode(whole(path)[0]))
    except (OSError, msgspec.DecodeError):
        return frozenset()


def _kind_of(document: str) -> str:
    kind = "workspace" if os.path.basename(document) == WORKSPACE_FILE else kind_of(document)
    if kind is None:
        hint = meant(document, GLOBS, f"the kinds are {', '.join(GLOBS)}")
        raise Refused(f"'{document}' is neither a kind of document nor a document{hint}")
    if not os.path.isfile(document):
        raise Refused(f"'{document}' does not exist")
    return kind


def _named(document: str) -> str:
    """The schema that the modeline of a document names, or ''."""
    try:
        with open(document, encoding="utf-8", errors="replace", opener=regular) as file:
            head = file.read(_HEAD)
    except OSError as error:
        raise Refused(f"cannot read {document}: {reason_of(error)}") from error
    match = _MODELINE.search(head)
    return match[1] if match else ""
