"""What several plans want below one output root, taken together: one text for each path, with its owners."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.transactions.manifest import ManifestEntry
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import FilePlan, RootPlan


class DesiredFile(msgspec.Struct, frozen=True):
    plan: FilePlan
    owners: tuple[str, ...]


class DesiredRoot(msgspec.Struct, frozen=True):
    """All plans for one root. `owners` says of each owner whether its plan was partial; `contested` are the paths that
    two of them want with different contents."""

    root: Root
    files: Mapping[str, DesiredFile] = {}
    owners: Mapping[str, bool] = {}
    contested: Mapping[tuple[str, str], Sequence[str]] = {}

    def diagnostics(self) -> Iterator[Diagnostic]:
        """One for each two documents that want the same files with different contents, whatever the number."""
        for (first, second), paths in self.contested.items():
            documents = [self.root.shown(owner) for owner in (first, second)]
            more = f" and {len(paths) - 1} more" if len(paths) > 1 else ""
            yield codes.CONTESTED.at(
                Span(documents[1]),
                path=f"'{self.root.shown(paths[0])}'{more}",
                one=documents[0],
                other=documents[1],
                related=[Related("the other document", Span(documents[0]))],
                hint=codes.APART,
            )

    def holders(self, path: str, entry: ManifestEntry | None) -> tuple[str, ...]:
        """The documents that hold on to a file: those that want it now, and of its earlier owners those that were not
        asked (not planned, or only in part) and still exist."""
        wanted = self.files.get(path)
        holders = set(wanted.owners) if wanted else set()
        for owner in entry.owners if entry else ():
            partial = self.owners.get(owner)
            if partial or (partial is None and self._exists(owner)):
                holders.add(owner)
        return tuple(sorted(holders))

    def _exists(self, owner: str) -> bool:
        # A root that is a link has two parents: its own and that of the link.
        for root in (os.path.abspath(self.root.path), self.root.real):
            try:
                os.lstat(os.path.normpath(os.path.join(root, owner)))
            except (FileNotFoundError, NotADirectoryError):
                continue
            except OSError:
                pass  # a folder that nobody may look into is no sign that a document in it is gone
            return True
        return False


def by_root(plans: Iterable[RootPlan], others: Iterable[str] = ()) -> list[DesiredRoot]:
    """One for each root, sorted; `others` are roots to look at though nothing is planned there."""
    roots: dict[str, tuple[Root, list[RootPlan]]] = {}
    root_at = functools.cache(Root)
    for path in others:
        roots.setdefault(root_at(path).real, (root_at(path), []))
    for plan in plans:
        root = root_at(plan.root)
        roots.setdefault(root.real, (root, []))[1].append(plan)
    return [_together(*roots[real]) for real in sorted(roots)]


def _together(root: Root, plans: Iterable[RootPlan]) -> DesiredRoot:
    files: dict[str, DesiredFile] = {}
    owners: dict[str, bool] = {}
    contested: dict[tuple[str, str], list[str]] = {}
    for plan in plans:
        owners[plan.owner] = plan.partial
        for file in plan.files:
            first = files.get(file.path)
            if first is None:
                files[file.path] = DesiredFile(file, (plan.owner,))
                continue
            # The same text may come from several documents.
            sources = tuple(dict.fromkeys((*first.plan.sources, *file.sources)))
            joined = first.plan if sources == first.plan.sources else replace(first.plan, sources=sources)
            holders = first.owners
            if joined != replace(file, sources=sources):
                contested.setdefault((first.owners[0], plan.owner), []).append(file.path)
            elif plan.owner not in holders:
                holders = (*holders, plan.owner)
            files[file.path] = DesiredFile(joined, holders)
    return DesiredRoot(root, files, owners, contested)
