"""The folders to which a compile may write: those named on the command line, and their workspaces.

A document may refer to another one in any folder, but only the user decides that rcyaml writes there.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.build import Build
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.source.file_names import with_document
from robocomp_yaml.source.inside import is_inside
from robocomp_yaml.source.real_paths import RealPaths


class AllowedFolders:
    def __init__(self, paths: Sequence[str], output: str | None) -> None:
        self.folders = [output] if output is not None else list(dict.fromkeys(_folders_of(paths)))
        self._reals = RealPaths()

    def contain(self, folder: str) -> bool:
        """Whether a folder is inside one of them."""
        real = self._reals.of(folder)
        return any(is_inside(self._reals.of(allowed), real) for allowed in self.folders)

    def restrict(self, built: Build) -> None:
        """Removes the plans for other folders, and reports them at their documents."""
        for plan in [plan for plan in built.plans if not self.contain(plan.root)]:
            built.plans.remove(plan)
            document = os.path.normpath(os.path.join(plan.root, plan.owner))
            built.skipped.add(os.path.realpath(document))
            built.diagnostics.append(_outside(document, plan.root, self.folders))


def _outside(document: str, root: str, folders: Sequence[str]) -> Diagnostic:
    reals = [os.path.realpath(folder) for folder in folders]
    named = " and ".join(reals)
    if any(is_inside(real, os.path.realpath(os.path.dirname(document))) for real in reals):
        advice = "remove the link that leads there"  # the document may be compiled already
    else:
        advice = f"to write there, run `{typed('rcyaml', 'compile', with_document(document))}`"
    return codes.OUTSIDE.at(
        Span(document),
        path=os.path.normpath(root),
        reason=f"{os.path.realpath(root)} is not below {named}",
        hint=f"{advice}, or set the output folder with -o DIR",
    )


def _folders_of(paths: Sequence[str]) -> Iterator[str]:
    for path in paths:
        folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
        root = root_above(folder)
        yield root if root is not None else folder
        if not os.path.isdir(path):  # its neighbours are meant, too
            if root is None:
                yield "."
        elif root is not None:
            yield folder
