"""The networks of a program: each deployment's, derived."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network


class Derived(msgspec.Struct, frozen=True):
    """Every deployment's network by its real path, and what is wrong with each. `judged` are those to be checked: a
    document that another one includes is judged as part of that one."""

    networks: Mapping[str, Network] = {}
    diagnostics: tuple[Diagnostic, ...] = ()
    judged: tuple[str, ...] = ()


def networks_of(program: Program) -> Derived:
    if not program.deployments:  # most programs have none
        return Derived()
    from robocomp_yaml.network.derive import derive

    networks: dict[str, Network] = {}
    said: list[Diagnostic] = []
    judged: list[str] = []
    for real, linked in sorted(program.deployments.items(), key=lambda item: item[1].deployment.path):
        networks[real], found = derive(linked, program)
        if not linked.is_included:
            said += found
            judged.append(real)
    return Derived(networks, tuple(said), tuple(judged))
