"""What becomes of the user's own files where a component changes: the diagnostics about them, and their merges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.emit.specific import entries, reading, sources
from robocomp_yaml.emit.specific.own import Own
from robocomp_yaml.emit.specific.reading import is_code
from robocomp_yaml.transactions.manifest import BASE
from robocomp_yaml.transactions.places import Root
from robocomp_yaml.transactions.plan import ONCE, Merge, Merges, RootPlan


class Review(msgspec.Struct, frozen=True):
    """`contents` and `absent` are what it read and looked for in vain, `names` what it saw in folders."""

    diagnostics: tuple[Diagnostic, ...] = ()
    merges: Merges = Merges()
    contents: Mapping[str, bytes] = {}
    absent: Set[str] = frozenset()
    names: Mapping[str, list[str]] = {}


def review(plans: Iterable[RootPlan], *, merge: bool = False) -> Review:
    """Looks at the files that are there; only where one of them is not as it would be written is it understood."""
    diagnostics: list[Diagnostic] = []
    merges: dict[tuple[str, str], Merge] = {}
    refused: set[str] = set()
    seen = _Seen()
    for plan in plans:
        root = Root(plan.root)
        files = list(_own(plan, root, merge, seen))
        if merge:
            alone = [file for file in files if reading.unmerged(file.plan.path)]
            files = [file for file in files if file not in alone]
            diagnostics += _not_merged(alone, root)
        if all(file.is_settled for file in files):
            continue
        from robocomp_yaml.emit.specific import merging, telling  # with the parsers of the languages

        if merge:
            merged, refusals = merging.merge_files(root, files)
            if refusals:
                refused.add(root.real)
                diagnostics += refusals
                continue
            merges.update({(root.real, path): one for path, one in merged.items()})
            files = [_after(file, merged.get(file.plan.path)) for file in files]
        _remember_code(seen, root, files)
        diagnostics += telling.tell(root, files, root.shown(plan.owner))
    return Review(tuple(diagnostics), Merges(merges, refused), seen.contents, seen.absent, seen.names)


class _Seen(msgspec.Struct):
    contents: dict[str, bytes] = {}
    absent: set[str] = set()
    names: dict[str, list[str]] = {}


def _remember_code(seen: _Seen, root: Root, files: Iterable[Own]) -> None:
    """Parts of the class that it is about may stand in any file beside it."""
    for folder in {file.plan.path.rpartition("/")[0] for file in files if is_code(file.plan.path)}:
        seen.names[root.shown(folder)] = sources.names(root, folder)
        seen.contents.update((root.shown(path), data) for path, data in sources.code_in(root, folder))


def _not_merged(files: Iterable[Own], root: Root) -> Iterator[Diagnostic]:
    """What would be merged, in languages that are not."""
    for file in files:
        language = reading.unmerged(file.plan.path)
        if language and not file.is_settled and file.base != file.plan.text:
            path = root.shown(file.plan.path)
            yield codes.NOT_MERGED.at(
                Span(path),
                path=path,
                language=language.title,
                hint="put in by hand what its build names; an empty folder to compile into (-o) shows a new skeleton",
            )


def _own(plan: RootPlan, root: Root, every: bool, seen: _Seen) -> Iterator[Own]:
    """The user's files that there are skeletons for; unless `every`, only those that are looked into."""
    for file in plan.files:
        is_read = file.path.startswith(f"{SOURCES}/") or entries.is_entries(file.path)
        if file.policy != ONCE or not (is_read or every):
            continue
        found, path = root.look(file.path), root.shown(file.path)
        seen.contents[path] = found.data if found.data is not None else file.text.encode()
        if found.problem or found.data is None:
            continue
        own = Own(file, found.data, _text(found.data), is_link=not found.mode)
        if not own.is_settled:
            base, where = root.look(f"{BASE}/{file.path}"), root.shown(f"{BASE}/{file.path}")
            if base.data is None:
                seen.absent.add(where)
            else:
                seen.contents[where] = base.data
                own = replace(own, base=_text(base.data))
        yield own


def _after(file: Own, merge: Merge | None) -> Own:
    return file if merge is None else Own(file.plan, merge.text, _text(merge.text), _text(merge.base))


def _text(data: bytes | None) -> str | None:
    try:
        return None if data is None else data.decode()
    except UnicodeDecodeError:
        return None
