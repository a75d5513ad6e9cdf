"""rcyaml as a library.

    from robocomp_yaml import api

    workspace = api.load("robot")
    for diagnostic in workspace.check():
        print(diagnostic)
    plan = workspace.compile()
    if not plan.has_errors:
        plan.apply()

The names in `__all__`, and their public attributes, keep their names and their meaning within a major version; see
docs/api.md. Everything else in `robocomp_yaml` may change at any time. The command line is built on this library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

from robocomp_yaml.diag.diagnostic import ERROR, NOTE, WARNING, Diagnostic, Related
from robocomp_yaml.diag.errors import Faulty, NotRenamed, Refused
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.registry import lazy_attributes

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.api.compiling import Compilation
    from robocomp_yaml.api.deploying import Deployment
    from robocomp_yaml.api.editing.changes import DocumentChange
    from robocomp_yaml.api.editing.editor import DocumentEditor, EditConflict, Revision
    from robocomp_yaml.api.fixing import Fixing
    from robocomp_yaml.api.living import LivingWorkspace
    from robocomp_yaml.api.migrating import Migration
    from robocomp_yaml.api.outcome import File, Outcome
    from robocomp_yaml.api.values import Change, Values
    from robocomp_yaml.api.workspace import Workspace
    from robocomp_yaml.deploy.attached import Attached
    from robocomp_yaml.deploy.engine import Line
    from robocomp_yaml.deploy.operations import Result, Status
    from robocomp_yaml.deploy.plan import Plan
    from robocomp_yaml.network.network import Network
    from robocomp_yaml.parameters.editing.show import Value

__all__ = [
    "ERROR", "NOTE", "WARNING", "Attached", "Built", "Change", "Compilation", "Deployment", "Diagnostic",
    "DocumentEditor", "EditConflict", "Faulty", "File", "Fix", "Fixing", "Line", "LivingWorkspace", "Migration",
    "Network", "NotRenamed", "Outcome", "Plan", "Refused", "Related", "Result", "Revision", "Span", "Status", "Value",
    "Values", "Workspace", "change", "edit", "follow", "load", "migrate",
]  # fmt: skip

_HOMES = {
    "api.building": "Built", "api.compiling": "Compilation", "api.deploying": "Deployment", "api.fixing": "Fixing",
    "api.editing.editor": "DocumentEditor EditConflict Revision", "api.living": "LivingWorkspace",
    "api.migrating": "Migration",
    "api.outcome": "File Outcome", "api.values": "Change Values",
    "api.workspace": "Workspace", "deploy.attached": "Attached", "deploy.engine": "Line",
    "deploy.operations": "Result Status", "deploy.plan": "Plan", "network.network": "Network",
    "parameters.editing.show": "Value",
}  # fmt: skip


def load(
    *paths: str, include: Iterable[str] = (), overlay: Mapping[str, bytes | str] | None = None,
    on_read: Callable[[str], None] | None = None,
) -> Workspace:  # fmt: skip
    """Reads the documents at these paths, with all that they refer to. A folder means all documents below it; the
    default is the working folder. `include` are folders to search for imports (`-I`). `overlay` has the texts of
    unsaved documents by path; they replace the files on the disk, or add to them. `on_read` is called with the path of
    each document that is read.

    Returns a workspace whatever the documents contain: `Workspace.check` reports what is wrong with them.
    """
    from robocomp_yaml.api.refusals import include_folders, require_paths
    from robocomp_yaml.api.workspace import Workspace
    from robocomp_yaml.source.disk import Disk
    from robocomp_yaml.source.text import encoded

    require_paths(*paths, *(overlay or {}))
    texts = {path: encoded(text) if isinstance(text, str) else text for path, text in (overlay or {}).items()}
    return Workspace(paths or (".",), include_folders(include, Disk(texts)), texts, on_read)


def follow(*paths: str, include: Iterable[str] = ()) -> LivingWorkspace:
    """The same documents, for programs that analyse them again and again while they change, such as editors: each
    analysis redoes only what depends on a change."""
    from robocomp_yaml.api.living import LivingWorkspace
    from robocomp_yaml.api.refusals import include_folders

    return LivingWorkspace(paths or (".",), include_folders(include))


def edit(*paths: str, include: Iterable[str] = ()) -> DocumentEditor:
    """Changes the documents at these paths, in small steps that keep comments and layout; see docs/edit.md."""
    from robocomp_yaml.api.editing.editor import DocumentEditor

    return DocumentEditor(follow(*paths, include=include))


def change(data: Mapping[str, object]) -> DocumentChange:
    """The change that data describes, such as `{"change": "move", "entry": "speech", "host": "head"}`. Raises Refused
    if there is no such change."""
    from robocomp_yaml.api.editing.changes import from_json

    try:
        return from_json(data)
    except ValueError as error:
        raise Refused(str(error)) from None


def migrate(
    *paths: str, output: str | None = None, include: Iterable[str] = (), force: bool = False, exact: bool = False
) -> Migration:
    """Converts legacy files to documents: the files at these paths, or all below a folder. Returns the migration;
    nothing is written before `Migration.apply`. `output` is a folder to write below; by default, documents are written
    beside their sources. `force` overwrites documents that were edited since, `exact` keeps blanks around the
    separators of lists."""
    from robocomp_yaml.api.migrating import Migration
    from robocomp_yaml.api.refusals import include_folders, require_paths

    require_paths(*paths, *([output] if output is not None else []))
    return Migration(paths, output, include_folders(include), force=force, exact=exact)


if not TYPE_CHECKING:  # mypy would accept any name
    __getattr__ = lazy_attributes(__name__, _HOMES)
