"""The files that several plans have below one output root: one text for each path, with its owners."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.transactions.manifest import ManifestEntry
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import FilePlan, RootPlan


class DesiredFile(msgspec.Struct, frozen=True):
    plan: FilePlan
    owners: tuple[str, ...]


class DesiredRoot(msgspec.Struct, frozen=True):
    """All plans of one root. `owners` maps each owner to whether its plan is partial. `contested` are the paths for
    which two owners have different contents."""

    root: Root
    files: Mapping[str, DesiredFile] = {}
    owners: Mapping[str, bool] = {}
    contested: Mapping[tuple[str, str], Sequence[str]] = {}

    def diagnostics(self) -> Iterator[Diagnostic]:
        """One diagnostic for each document, and all others that have different contents for the same files."""
        for first, others in self._rivals().items():
            documents = [self.root.shown(owner) for owner in others]
            paths = [
                *dict.fromkeys(path for pair in self.contested if pair[1] in others for path in self.contested[pair])
            ]
            more = f" and {len(paths) - 1} more" if len(paths) > 1 else ""
            yield codes.CONTESTED.at(
                Span(documents[0]),
                path=f"'{self.root.shown(paths[0])}'{more}",
                one=self.root.shown(first),
                other=some(documents),
                related=[Related("the other document", Span(self.root.shown(first)))],
                hint=codes.APART,
            )

    def _rivals(self) -> dict[str, list[str]]:
        """The documents that contest a file of an earlier one, by the earliest of those."""
        rivals: dict[str, list[str]] = {}
        told: set[str] = set()
        for first, second in self.contested:
            if second not in told:
                told.add(second)
                rivals.setdefault(first, []).append(second)
        return rivals

    def holders(self, path: str, entry: ManifestEntry | None) -> tuple[str, ...]:
        """The owners of a file: the documents that plan it now, and its earlier owners that still exist and were not
        planned, or only in part."""
        desired = self.files.get(path)
        holders = set(desired.owners) if desired else set()
        for owner in entry.owners if entry else ():
            partial = self.owners.get(owner)
            if partial or (partial is None and self._exists(owner)):
                holders.add(owner)
        return tuple(sorted(holders))

    def _exists(self, owner: str) -> bool:
        # A root that is a link has two parents: that of the target and that of the link.
        for root in (os.path.abspath(self.root.path), self.root.real):
            try:
                os.lstat(os.path.normpath(os.path.join(root, owner)))
            except (FileNotFoundError, NotADirectoryError):
                continue
            except OSError:
                pass  # if the folder cannot be searched, the document in it may still exist
            return True
        return False


def by_root(plans: Iterable[RootPlan], others: Iterable[str] = ()) -> list[DesiredRoot]:
    """The plans of each root, sorted by path; `others` are further roots, for which nothing is planned."""
    roots: dict[str, tuple[Root, list[RootPlan]]] = {}
    reals = RealPaths()
    root_at = functools.cache(lambda path: Root(path, reals))
    for path in others:
        roots.setdefault(root_at(path).real, (root_at(path), []))
    for plan in plans:
        root = root_at(plan.root)
        roots.setdefault(root.real, (root, []))[1].append(plan)
    return [_joined(*roots[real]) for real in sorted(roots)]


def _joined(root: Root, plans: Iterable[RootPlan]) -> DesiredRoot:
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
            # Several documents may have the same file.
            sources = tuple(dict.fromkeys((*first.plan.sources, *file.sources)))
            joined = first.plan if sources == first.plan.sources else replace(first.plan, sources=sources)
            holders = first.owners
            if joined != replace(file, sources=sources):
                contested.setdefault((first.owners[0], plan.owner), []).append(file.path)
            elif plan.owner not in holders:
                holders = (*holders, plan.owner)
            files[file.path] = DesiredFile(joined, holders)
    return DesiredRoot(root, files, owners, contested)
