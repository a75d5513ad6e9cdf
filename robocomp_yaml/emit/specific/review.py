"""What becomes of the user's own files where a component changes: the diagnostics about them, and their merges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import languages as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.manifest import BASE
from robocomp_yaml.emit.places import Root
from robocomp_yaml.emit.plan import ONCE, SOURCES, Merge, Merges, RootPlan
from robocomp_yaml.emit.specific import entries, reading
from robocomp_yaml.emit.specific.own import Own


class Review(msgspec.Struct):
    """`contents` and `absent` are what it read and looked for in vain."""

    diagnostics: list[Diagnostic] = []
    merges: Merges = msgspec.field(default_factory=Merges)
    contents: dict[str, bytes] = {}
    absent: set[str] = set()


def review(plans: Iterable[RootPlan], *, merge: bool = False) -> Review:
    """Looks at the files that are there; only where one of them is not as it would be written is it understood."""
    result = Review()
    for plan in plans:
        root = Root(plan.root)
        files = list(_own(plan, root, merge, result))
        if merge:
            alone = [file for file in files if reading.unmerged(file.plan.path)]
            files = [file for file in files if file not in alone]
            result.diagnostics += _not_merged(alone, root)
        if all(file.is_settled for file in files):
            continue
        from robocomp_yaml.emit.specific import merging, telling  # with the parsers of the languages

        if merge:
            merged, refusals = merging.merge_files(root, files)
            if refusals:
                result.merges.refused.add(root.real)
                result.diagnostics += refusals
                continue
            result.merges.files.update({(root.real, path): one for path, one in merged.items()})
            files = [_after(file, merged.get(file.plan.path)) for file in files]
        result.diagnostics += telling.tell(root, files, root.shown(plan.owner))
    return result


def _not_merged(files: Iterable[Own], root: Root) -> Iterator[Diagnostic]:
    """What would be merged, in languages that are not."""
    for file in files:
        language = reading.unmerged(file.plan.path)
        if language and not file.is_settled and file.base != file.plan.text:
            path = root.shown(file.plan.path)
            yield codes.NOT_MERGED.at(
                Span(path), path=path, language=language.title,
                hint="put in by hand what its build names; an empty folder to compile into (-o) shows a new skeleton",
            )


def _own(plan: RootPlan, root: Root, every: bool, result: Review) -> Iterator[Own]:
    """The user's files that there are skeletons for; unless `every`, only those that are looked into."""
    for file in plan.files:
        is_read = file.path.startswith(f"{SOURCES}/") or entries.is_entries(file.path)
        if file.policy != ONCE or not (is_read or every):
            continue
        found, path = root.look(file.path), root.shown(file.path)
        result.contents[path] = found.data if found.data is not None else file.text.encode()
        if found.problem or found.data is None:
            continue
        own = Own(file, found.data, _text(found.data), is_link=not found.mode)
        if not own.is_settled:
            base, where = root.look(f"{BASE}/{file.path}"), root.shown(f"{BASE}/{file.path}")
            if base.data is None:
                result.absent.add(where)
            else:
                result.contents[where] = base.data
                own = replace(own, base=_text(base.data))
        yield own


def _after(file: Own, merge: Merge | None) -> Own:
    return file if merge is None else Own(file.plan, merge.text, _text(merge.text), _text(merge.base))


def _text(data: bytes | None) -> str | None:
    try:
        return None if data is None else data.decode()
    except UnicodeDecodeError:
        return None
