"""What a workspace holds for editors: the schemas, each document's modeline, and VS Code's settings."""

from __future__ import annotations

import errno
import os

from robocomp_yaml.link.workspace import above
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.json_comments import Unreadable, with_members
from robocomp_yaml.source.regular import regular
from robocomp_yaml.source.schema_text import MARKED, schema_text
from robocomp_yaml.transactions import whole_file

FOLDER = ".rcyaml/schemas"
SETTINGS = ".vscode/settings.json"
GLOBS = {
    "idsl": ["*.idsl.yaml", "idsl.yaml"],
    "cdsl": ["*.cdsl.yaml", "cdsl.yaml"],
    "pdsl": ["*.pdsl.yaml", "pdsl.yaml"],
    "ddsl": ["*.ddsl.yaml", "ddsl.yaml"],
    "config": ["*.config.yaml", "etc/config.yaml"],
    "workspace": ["rcyaml.yaml"],
    "mock": ["*.mock.yaml"],
}
"""The file names of each kind, as VS Code's `yaml.schemas` takes them."""


def schema_path(kind: str) -> str:
    """Where the schema of a kind stands in a workspace."""
    return f"{FOLDER}/{kind}.schema.json"


def schema_of(kind: str, plugins: Plugins) -> str:
    """The text of the schema of a kind in a workspace with these plug-ins."""
    return schema_text(kind, plugins.languages if kind in MARKED else ())


def modeline(kind: str, document: str, workspace: str) -> str:
    """The first line of a document, without its line end: it tells editors which schema to use."""
    path = os.path.relpath(os.path.join(workspace, schema_path(kind)), os.path.dirname(document) or ".")
    return f"# yaml-language-server: $schema={path}"


def install(folder: str, plugins: Plugins | None = None) -> list[str]:
    """Brings the editor's files of a workspace up to date; gives those that changed. `plugins` are the workspace's,
    where they are known already; while one of them cannot be had, what depends on them stays as it is.

    What the user has in VS Code's settings stays as it is, comments included; `settings_problem` says why nothing
    could be added. Raises OSError where the folder cannot be written, or a link leads out of it.
    """
    schemas = {kind: os.path.normpath(os.path.join(folder, schema_path(kind))) for kind in GLOBS}
    for kind, path in schemas.items():
        if not stays_inside(folder, schema_path(kind)):
            raise OSError(errno.ELOOP, "a link leads out of the workspace", path)
    plugins = above(folder)[0].plugins if plugins is None else plugins
    changed = [
        path
        for kind, path in schemas.items()
        if (plugins.whole or kind not in MARKED) and _write(path, schema_of(kind, plugins))
    ]
    try:
        wired = _wired(folder)
    except Unreadable:
        return changed
    settings = os.path.normpath(os.path.join(folder, SETTINGS))
    return [*changed, settings] if _write(settings, wired) else changed


def settings_problem(folder: str) -> str:
    """Why `install` leaves VS Code's settings as they are, or ''."""
    try:
        _wired(folder)
    except Unreadable as error:
        return f"{SETTINGS} is left as it is, since {error}: documents with a modeline are checked all the same"
    return ""


def _wired(folder: str) -> str:
    """The text of VS Code's settings with our schemas in `yaml.schemas`."""
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
    ours = {schema_path(kind): globs for kind, globs in GLOBS.items()}
    return with_members(text if text.strip() else "{}\n", "yaml.schemas", ours)


def _write(path: str, text: str) -> bool:
    """Writes a file whole or not at all, and only if that changes it."""
    data = text.encode("utf-8")
    try:
        with open(path, "rb", opener=regular) as file:
            if file.read() == data:
                return False
    except FileNotFoundError:
        os.makedirs(os.path.dirname(path), exist_ok=True)
    whole_file.replace(path, data)
    return True
