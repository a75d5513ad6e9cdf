"""Which folders a compile may write to: those that the user named, and the workspaces that these are in.

A document may name another one that is anywhere; only the user says that something is written there.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.build import Build
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.source.inside import stays_inside


class AllowedFolders:
    def __init__(self, paths: Sequence[str], output: str | None) -> None:
        self.folders = [output] if output is not None else list(dict.fromkeys(_around(paths)))

    def hold(self, folder: str) -> bool:
        """Whether a folder is inside."""
        return any(stays_inside(fence, os.path.realpath(folder)) for fence in self.folders)

    def keep_inside(self, built: Build) -> None:
        """Takes the plans away that lead out, and says so at their documents."""
        for plan in [plan for plan in built.plans if not self.hold(plan.root)]:
            built.plans.remove(plan)
            document = os.path.normpath(os.path.join(plan.root, plan.owner))
            built.left_out.add(os.path.realpath(document))
            built.diagnostics.append(_told(document, plan.root, self.folders))


def _told(document: str, root: str, folders: Sequence[str]) -> Diagnostic:
    named = " and ".join(os.path.realpath(folder) for folder in folders)
    return codes.OUTSIDE.at(
        Span(document),
        path=os.path.normpath(root),
        reason=f"{os.path.realpath(root)} is not below {named}",
        hint=f"if that is meant: `rcyaml compile {document}`, or -o DIR",
    )


def _around(paths: Sequence[str]) -> Iterator[str]:
    for path in paths:
        folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
        root = root_above(folder)
        yield root if root is not None else folder
        if not os.path.isdir(path):  # it may be named from where all of it is in sight
            if root is None:
                yield "."
        elif root is not None:
            yield folder
