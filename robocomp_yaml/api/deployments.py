"""Which deployment is meant: the one that is named, else the only one that there is."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.pipeline import Analysis


def document(path: str, include: tuple[str, ...]) -> str:
    """The deployment's document that a path means. Raises Refused where a folder has none, or
    several."""
    if not os.path.isdir(path):
        return path
    found = deployments_of(path, include)
    if not found:
        raise Refused(
            f"'{path}' is to have a deployment document; it has none: `rcyaml new deployment NAME` writes one"
        )
    return one_of(found)


def one_of(found: list[str]) -> str:
    if len(found) > 1:
        names = ", ".join(sorted(found))
        raise Refused(f"there are several deployments here, of which one is to be named: {names}")
    return found[0]


def deployments_of(folder: str, include: tuple[str, ...] = (), analysis: Analysis | None = None) -> list[str]:
    """The deployments of a folder, else those below it; those that others include are parts of these. `analysis` is of
    the folder, where there is one."""
    all_of_them, here = of_kind(folder, "ddsl"), os.path.normpath(folder)
    found = [path for path in all_of_them if (os.path.dirname(path) or ".") == here] or all_of_them
    if len(found) < 2:
        return found
    if analysis is None:
        from robocomp_yaml.pipeline import analyse

        analysis = analyse(found, include)
    parts = {real for real, linked in analysis.program.deployments.items() if linked.is_included}
    return [path for path in found if os.path.realpath(path) not in parts] or found
