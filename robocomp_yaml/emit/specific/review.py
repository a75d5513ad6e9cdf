"""What becomes of the user's own files where a component changes: the diagnostics about them, and their merges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import languages as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.emit.specific import entries, reading
from robocomp_yaml.emit.specific.user_file import UserFile
from robocomp_yaml.transactions.manifest import BASE
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import ONCE, Merge, Merges, RootPlan


class Review(msgspec.Struct):
    """`contents` and `absent` are what it read and looked for in vain, `names` what it saw in folders."""

    diagnostics: list[Diagnostic] = []
    merges: Merges = msgspec.field(default_factory=Merges)
    contents: dict[str, bytes] = {}
    absent: set[str] = set()
    names: dict[str, list[str]] = {}


def review(plans: Iterable[RootPlan], *, merge: bool = False) -> Review:
    """Looks at the files that are there; only where one of them is not as it would be written is it understood."""
    result = Review()
    for plan in plans:
        root = Root(plan.root)
        files = list(_own(plan, root, merge, result))
        if merge:
            alone = [file for file in files if reading.unmerged(file.path)]
            files = [file for file in files if file not in alone]
            result.diagnostics += _not_merged(alone, root)
        if all(file.is_settled for file in files):
            continue
        from robocomp_yaml.emit.specific import reporting  # most runs need neither
        from robocomp_yaml.emit.specific.merge import merge_files

        if merge:
            merged, refusals = merge_files(root, files)
            if refusals:
                result.merges.refused.add(root.real)
                result.diagnostics += refusals
                continue
            result.merges.files.update({(root.real, path): one for path, one in merged.items()})
            files = [_after(file, merged.get(file.path)) for file in files]
        # Parts of the class that it is about may stand in any file beside it.
        for folder in {file.path.rpartition("/")[0] for file in files if reading.is_code(file.path)}:
            result.names[root.shown(folder)] = reading.names(root, folder)
            result.contents.update((root.shown(path), data) for path, data in reading.code_in(root, folder))
        result.diagnostics += reporting.report(root, files, root.shown(plan.owner))
    return result


def _not_merged(files: Iterable[UserFile], root: Root) -> Iterator[Diagnostic]:
    """What would be merged, in languages that are not."""
    for file in files:
        language = reading.unmerged(file.path)
        if language and not file.is_settled and file.base != file.new:
            path = root.shown(file.path)
            yield codes.NOT_MERGED.at(
                Span(path),
                path=path,
                language=language.title,
                hint="put in by hand what its build names; an empty folder to compile into (-o) shows a new skeleton",
            )


def _own(plan: RootPlan, root: Root, every: bool, seen: Review) -> Iterator[UserFile]:
    """The user's files that there are skeletons for; unless `every`, only those that are looked into."""
    for file in plan.files:
        is_read = file.path.startswith(f"{SOURCES}/") or entries.is_entries(file.path)
        if file.policy != ONCE or not (is_read or every):
            continue
        found, path = root.status(file.path), root.shown(file.path)
        seen.contents[path] = found.data if found.data is not None else file.text.encode()
        if found.problem or found.data is None:
            continue
        yours = _text(found.data)
        own = UserFile(
            file.path, file.text, found.data, yours or "", is_text=yours is not None, is_link=not found.mode
        )  # fmt: skip
        if not own.is_settled:
            base, where = root.status(f"{BASE}/{file.path}"), root.shown(f"{BASE}/{file.path}")
            if base.data is None:
                seen.absent.add(where)
            else:
                seen.contents[where] = base.data
                own = replace(own, base=_text(base.data))
        yield own


def _after(file: UserFile, merge: Merge | None) -> UserFile:
    return replace(file, data=merge.text, yours=merge.text.decode(), base=merge.base.decode()) if merge else file


def _text(data: bytes) -> str | None:
    try:
        return data.decode()
    except UnicodeDecodeError:
        return None
