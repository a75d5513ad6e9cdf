"""The files and lines for editors in a workspace: schemas, the modeline of documents, and VS Code's settings."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress

import msgspec

from robocomp_yaml.link.workspace import above
from robocomp_yaml.link.workspace_names import names_below
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.json_comments import Unreadable, with_members
from robocomp_yaml.source.regular import content, regular
from robocomp_yaml.source.schema_names import OfferedNames, schema_with
from robocomp_yaml.source.schema_text import MARKED
from robocomp_yaml.transactions import stamp, whole_file

FOLDER = ".rcyaml/schemas"
SETTINGS = ".vscode/settings.json"
_STATE = f"{stamp.FOLDER}/schemas"
GLOBS = {
    "idsl": ["*.idsl.yaml", "idsl.yaml"],
    "cdsl": ["*.cdsl.yaml", "cdsl.yaml"],
    "pdsl": ["*.pdsl.yaml", "pdsl.yaml"],
    "ddsl": ["*.ddsl.yaml", "ddsl.yaml"],
    "config": ["*.config.yaml", "etc/config.yaml"],
    "workspace": ["rcyaml.yaml"],
    "mock": ["*.mock.yaml"],
}
"""The file names of each kind, as patterns for VS Code's `yaml.schemas`."""


def schema_path(kind: str) -> str:
    """The path of the schema of a kind, relative to the workspace."""
    return f"{FOLDER}/{kind}.schema.json"


def schema_of(kind: str, plugins: Plugins, names: OfferedNames = ()) -> str:
    """The text of the schema of a kind, as the editors of a workspace with these names use it."""
    return schema_with(names, kind, plugins.languages if kind in MARKED else ())


def modeline(kind: str, document: str, workspace: str) -> str:
    """The first line of a document, without its line end: it names the schema for editors."""
    path = os.path.relpath(os.path.join(workspace, schema_path(kind)), os.path.dirname(document) or ".")
    return f"# yaml-language-server: $schema={path}"


class Installed(msgspec.Struct, frozen=True):
    """The editor's files of a workspace: the paths of those that changed, and the digests of the schemas by path. A
    schema may be missing, with a plug-in."""

    changed: Sequence[str]
    schemas: Mapping[str, str]


def install(folder: str, plugins: Plugins | None = None, names: OfferedNames | None = None) -> Installed:
    """Brings the editor's files of a workspace up to date. `plugins` and `names` are the workspace's, if they are known
    already. If a plug-in cannot be loaded, schemas that depend on plug-ins are not changed.

    The user's own VS Code settings and comments are not changed; `settings_problem` returns why the schemas could not
    be added. Raises OSError if the folder cannot be written, or a link leads out of the workspace.
    """
    schemas = {kind: os.path.normpath(os.path.join(folder, schema_path(kind))) for kind in GLOBS}
    for kind, path in schemas.items():
        if not stays_inside(folder, schema_path(kind)):
            raise OSError(errno.ELOOP, "a link leads out of the workspace", path)
    plugins = above(folder)[0].plugins if plugins is None else plugins
    names = names_below(folder) if names is None else names
    settings = os.path.normpath(os.path.join(folder, SETTINGS))
    digests = _digests(schemas.values())
    if not plugins.named and content(os.path.join(folder, _STATE)) == _state(names, digests, settings):
        return Installed((), digests)
    changed = [
        path
        for kind, path in schemas.items()
        if (plugins.whole or kind not in MARKED) and _write(path, schema_of(kind, plugins, names))
    ]
    digests = _digests(schemas.values()) if changed else digests
    try:
        text = _settings_text(folder)
    except Unreadable:
        return Installed(changed, digests)
    if _write(settings, text):
        changed.append(settings)
    if not plugins.named:
        _keep(folder, _state(names, digests, settings))
    return Installed(changed, digests)


def _digests(paths: Iterable[str]) -> dict[str, str]:
    return {path: digest(data) for path in paths if (data := content(path)) is not None}


def _state(names: OfferedNames, schemas: Mapping[str, str], settings: str) -> bytes:
    """What the editor's files are made of, and their contents. To make them again takes ten times as long."""
    parts = [stamp.own_tool(), repr(names), *schemas.values(), digest(content(settings) or b"")]
    return digest("\n".join(parts).encode(errors="surrogateescape")).encode()


def _keep(folder: str, state: bytes) -> None:
    """Keeps the state of the editor's files. If that fails, the next run makes them again."""
    if stays_inside(folder, _STATE):
        path = os.path.join(folder, _STATE)
        with suppress(OSError):
            os.makedirs(os.path.dirname(path), exist_ok=True)
            whole_file.ignore_all(os.path.dirname(path))
            whole_file.put(path, state)


def settings_problem(folder: str) -> str:
    """Why `install` does not change VS Code's settings, or ''."""
    try:
        _settings_text(folder)
    except Unreadable as error:
        return f"{SETTINGS} is not changed, because {error}; documents with a modeline are checked nevertheless"
    return ""


def _settings_text(folder: str) -> str:
    """The text of VS Code's settings with the schemas in `yaml.schemas`. Raises Unreadable if they cannot be added."""
    settings = os.path.join(folder, SETTINGS)
    if os.path.islink(settings):
        raise Unreadable("it is a link")
    if not stays_inside(folder, SETTINGS):
        raise Unreadable("a link leads out of the workspace")
    try:
        with open(settings, encoding="utf-8", opener=regular) as file:
            text = file.read()
    except FileNotFoundError:
        text = ""
    except ValueError:
        raise Unreadable("it is not UTF-8 text") from None
    schemas = {schema_path(kind): globs for kind, globs in GLOBS.items()}
    return with_members(text if text.strip() else "{}\n", "yaml.schemas", schemas)


def _write(path: str, text: str) -> bool:
    """Writes a file atomically, if its content changes. Returns whether it does."""
    data = text.encode("utf-8")
    try:
        with open(path, "rb", opener=regular) as file:
            if file.read() == data:
                return False
    except FileNotFoundError:
        os.makedirs(os.path.dirname(path), exist_ok=True)
    whole_file.replace(path, data)
    return True
