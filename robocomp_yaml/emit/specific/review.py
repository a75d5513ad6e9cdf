"""Reviews the user's files after a component changed: diagnostics about them, and merges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.codes.specific import OBSOLETE, OUTDATED
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.transactions.manifest import BASE
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import ONCE, Merge, Merges, RootPlan

if TYPE_CHECKING:
    from robocomp_yaml.emit.build import Build
    from robocomp_yaml.emit.specific.user_file import UserFile
    from robocomp_yaml.link.program import LinkedComponent
    from robocomp_yaml.source.disk import Disk


class Review(msgspec.Struct):
    """`contents` are the files that were read, `absent` the paths that do not exist, `names` those in folders."""

    diagnostics: list[Diagnostic] = []
    merges: Merges = msgspec.field(default_factory=Merges)
    contents: dict[str, bytes] = {}
    absent: set[str] = set()
    names: dict[str, list[str]] = {}

    def add_usage(self, linked: LinkedComponent, root: Root, disk: Disk, merged: Mapping[str, bytes]) -> None:
        """Adds the diagnostics about the use that the code makes of the worker; `merged` are new contents of files."""
        from robocomp_yaml.emit.usage import check  # only for code that somebody wrote

        suffixes = linked.component.language.target.suffixes
        found = check.sources(root, suffixes, disk, merged)
        if found is not None:
            self.names.update(found.names)
            known = {one.span for one in self.diagnostics if one.code in (OBSOLETE.id, OUTDATED.id)}
            self.diagnostics += (one for one in check.check(linked, root, found) if one.span not in known)


def review(
    built: Build, disk: Disk, *, merge: bool = False, unsaved: Mapping[str, bytes] | None = None
) -> Review:  # fmt: skip
    """Reviews the user's files of all plans. Only components with a file that is not up to date are parsed. `disk`
    records what is read to see how they use the worker. `unsaved` has the texts of an editor, by real path."""
    result = Review()
    if not any(file.policy == ONCE for plan in built.plans for file in plan.files):
        return result
    reals = RealPaths()
    for plan in built.plans:
        root = Root(plan.root, reals, unsaved)
        files = list(_user_files(plan, root, merge, result))
        if not files:
            continue
        from robocomp_yaml.emit.specific import reading  # only for files that somebody wrote

        if merge:
            unmerged = [file for file in files if reading.unmerged(file.path)]
            files = [file for file in files if file not in unmerged]
            result.diagnostics += _not_merged(unmerged, root)
        if all(file.is_up_to_date for file in files):
            continue
        from robocomp_yaml.emit.specific import reporting  # most runs need neither of them
        from robocomp_yaml.emit.specific.merge import merge_files

        if merge:
            merged, refusals = merge_files(root, files)
            if refusals:
                result.merges.refused.add(root.real)
                result.diagnostics += refusals
                continue
            result.merges.files.update({(root.real, path): one for path, one in merged.items()})
            files = [_after(file, merged.get(file.path)) for file in files]
        # Any file beside it may contain parts of the class.
        for folder in {file.path.rpartition("/")[0] for file in files if reading.is_code(file.path)}:
            result.names[root.shown(folder)] = reading.names(root, folder)
            result.contents.update((root.shown(path), data) for path, data in reading.code_in(root, folder))
        linked = built.components.get((plan.root, plan.owner))
        result.diagnostics += reporting.report(root, files, root.shown(plan.owner), linked)
        if linked is not None and linked.component.language.target.has_usage:
            merged_files = {file.path: file.data for file in files} if merge else {}
            result.add_usage(linked, root, disk, merged_files)
    return result


def _not_merged(files: Iterable[UserFile], root: Root) -> Iterator[Diagnostic]:
    """Warnings about files in languages without merging."""
    from robocomp_yaml.emit.specific import reading

    for file in files:
        language = reading.unmerged(file.path)
        if language and not file.is_up_to_date and file.base != file.new:
            path = root.shown(file.path)
            hint = (
                "edit it by hand, as the errors of its build require; "
                "a compile into an empty folder (-o) shows the new skeleton"
            )
            yield codes.NOT_MERGED.at(Span(path), path=path, language=language.title, hint=hint)


def _user_files(plan: RootPlan, root: Root, every: bool, seen: Review) -> Iterator[UserFile]:
    """The user's files with skeletons; unless `every`, only code and `etc/config`."""
    from robocomp_yaml.emit.specific import config_merge
    from robocomp_yaml.emit.specific.user_file import UserFile

    for file in plan.files:
        is_read = file.path.startswith(f"{SOURCES}/") or config_merge.is_config(file.path)
        if file.policy != ONCE or not (is_read or every):
            continue
        status, path = root.status(file.path), root.shown(file.path)
        seen.contents[path] = status.data if status.data is not None else file.text.encode()
        if status.problem or status.data is None:
            continue
        yours = _text(status.data)
        user_file = UserFile(
            file.path, file.text, status.data, yours or "", accepted=file.accepted,
            is_text=yours is not None, is_link=not status.mode,
        )  # fmt: skip
        if not user_file.is_up_to_date:
            base, where = root.status(f"{BASE}/{file.path}"), root.shown(f"{BASE}/{file.path}")
            if base.data is None:
                seen.absent.add(where)
            else:
                seen.contents[where] = base.data
                user_file = replace(user_file, base=_text(base.data))
        yield user_file


def _after(file: UserFile, merge: Merge | None) -> UserFile:
    return replace(file, data=merge.text, yours=merge.text.decode(), base=merge.base.decode()) if merge else file


def _text(data: bytes) -> str | None:
    try:
        return data.decode()
    except UnicodeDecodeError:
        return None
