"""The networks of all deployments of a program."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network


class DerivedNetworks(msgspec.Struct, frozen=True):
    """Every deployment's network by its real path, and the diagnostics of all. `judged` are the deployments to check:
    one that another deployment includes is checked as a part of the other."""

    networks: Mapping[str, Network] = {}
    diagnostics: tuple[Diagnostic, ...] = ()
    judged: tuple[str, ...] = ()


def networks_of(program: Program, addresses: Addresses) -> DerivedNetworks:
    if not program.deployments:  # most programs have none
        return DerivedNetworks()
    from robocomp_yaml.network.derive import derive

    networks: dict[str, Network] = {}
    diagnostics: list[Diagnostic] = []
    judged: list[str] = []
    for real, linked in sorted(program.deployments.items(), key=lambda item: item[1].deployment.path):
        networks[real], reported = derive(linked, program, addresses)
        if not linked.is_included:
            diagnostics += reported
            judged.append(real)
    return DerivedNetworks(networks, tuple(diagnostics), tuple(judged))
