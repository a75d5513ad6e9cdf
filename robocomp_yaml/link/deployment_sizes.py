"""How large deployments become, before any is expanded: a few lines of includes can ask for billions of processes."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link import deployment_paths as paths
from robocomp_yaml.model.deployment import Deployment
from robocomp_yaml.source.disk import Disk

MOST = 10_000  # instances of one deployment, all together
DEEPEST = 50  # includes inside of each other


def too_large(deployments: Mapping[str, Deployment], disk: Disk) -> dict[str, Diagnostic | None]:
    """The deployments, by real path, that cannot be expanded, with what is wrong with each: nothing more where it only
    includes such a one."""
    sizes: dict[str, tuple[int, int]] = {}
    found: dict[str, Diagnostic | None] = {}
    for real in _inner_first(deployments, disk):
        model = deployments[real]
        inner = [other for other in _includes(model, disk) if other in sizes]
        size = sum(entry.instances or 1 for entry in model.entries) + sum(sizes[other][0] for other in inner)
        depth = 1 + max((sizes[other][1] for other in inner), default=0)
        sizes[real] = size, depth
        if any(other in found for other in inner):
            found[real] = None
        elif size > MOST:
            found[real] = codes.TOO_LARGE.at(model.span, problem=f"comes to {size} processes, and {MOST} are the most")
        elif depth > DEEPEST:
            problem = f"has includes inside of each other {depth} deep, and {DEEPEST} are the most"
            found[real] = codes.TOO_LARGE.at(model.span, problem=problem)
    return found


def _includes(model: Deployment, disk: Disk) -> Iterator[str]:
    """The real paths of what a document includes, as often as it does."""
    for include in (*model.includes, *(group.include for group in model.groups if group.include)):
        path = paths.include_at(model, include.text, disk)
        if path is not None:
            yield os.path.realpath(path)


def _inner_first(deployments: Mapping[str, Deployment], disk: Disk) -> Iterator[str]:
    """Each document behind those that it includes; an include that leads back is left out."""
    entered: set[str] = set()
    todo = [(real, False) for real in reversed(list(deployments))]
    while todo:  # without recursion: a chain of includes may be long
        real, left = todo.pop()
        if left:
            yield real
        elif real not in entered and real in deployments:
            entered.add(real)
            todo.append((real, True))
            todo += [(other, False) for other in dict.fromkeys(_includes(deployments[real], disk))]
