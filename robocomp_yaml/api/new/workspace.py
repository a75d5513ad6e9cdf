"""The files of a workspace besides its documents, and adding new documents to it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence

from robocomp_yaml import languages, resources
from robocomp_yaml.api.new.documents import NewDocument, component_document, interface_document
from robocomp_yaml.emit.render import render
from robocomp_yaml.link import workspace_files
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.source.discover import WORKSPACE_FILE, documents_below
from robocomp_yaml.transactions import whole_file

EXAMPLE = "Hello"
WROTE, KEPT, NOTE = "wrote", "kept", "note"
Report = Callable[[str, str], None]
"""Called with each file when it is done: WROTE or KEPT with its path, or NOTE with a text."""


def init(folder: str, report: Report, *, bare: bool = False) -> None:
    """Makes a folder a workspace that checks. A folder without documents gets an example interface and component,
    unless `bare`. Existing files are kept. Raises OSError if a file cannot be written."""
    is_empty = not os.path.isdir(folder) or not list(documents_below(folder))
    _make(folder, report)
    if is_empty and not bare:
        _write(interface_document(folder, EXAMPLE), report)
        example = {"implements": [EXAMPLE]}
        _write(component_document(folder, f"{EXAMPLE}Comp", languages.DEFAULT, example), report)
        workspace_files.install(folder)


def create(make: Callable[[str], Sequence[NewDocument]], report: Report) -> list[str]:
    """Writes documents into the workspace of this folder, or into a new one. Returns their paths. `make` gets the
    folder of the workspace; if it raises Refused, nothing is written. Raises OSError if a file cannot be written."""
    root = root_above(".")
    if root is None:
        root = "."
        make(root)
        _make(root, report)
    documents = make(root)
    for document in documents:
        _write(document, report)
    workspace_files.install(root)
    return [document.path for document in documents]


def _make(folder: str, report: Report) -> None:
    for path, text in _files(folder):
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        try:
            whole_file.create(path, text)
            report(WROTE, path)
        except FileExistsError:
            report(KEPT, path)
    for name in ("interfaces", "components"):
        os.makedirs(os.path.join(folder, name), exist_ok=True)
    changed = workspace_files.install(folder).changed
    schemas = [path for path in changed if os.path.basename(os.path.dirname(path)) == "schemas"]
    if schemas:
        report(WROTE, f"{os.path.dirname(schemas[0])}/ ({len(schemas)} file{'s' * (len(schemas) > 1)})")
    for path in changed:
        if path not in schemas:
            report(WROTE, path)
    if problem := workspace_files.settings_problem(folder):
        report(NOTE, problem)


def _write(document: NewDocument, report: Report) -> None:
    """Writes a document that does not exist yet."""
    os.makedirs(os.path.dirname(document.path) or ".", exist_ok=True)
    whole_file.create(document.path, document.text)
    report(WROTE, document.path)


def _files(folder: str) -> Iterator[tuple[str, str]]:
    path = os.path.normpath(os.path.join(folder, WORKSPACE_FILE))
    yield path, render("new/workspace.yaml.j2", modeline=workspace_files.modeline("workspace", path, folder))
    yield os.path.normpath(os.path.join(folder, ".gitignore")), resources.text("templates/new/gitignore")
