"""How large deployments become, before any is expanded: a few lines of includes can ask for billions of processes."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.digraph import inner_first
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
    included = {real: list(_includes(model, disk)) for real, model in deployments.items()}
    for real in inner_first(deployments, lambda real: [other for other in included[real] if other in included]):
        model, inner = deployments[real], [other for other in included[real] if other in sizes]
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
