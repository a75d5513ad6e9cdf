"""Which components of a deployment a host could run, and what it lacks for each: asked before anything is moved there.

Two questions are asked, as `deploy probe` and `deploy push --dry-run` ask them: whether programs, libraries and modules
are there, and which files differ from those here.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.api.deploying import Deployment
from robocomp_yaml.api.refusals import require
from robocomp_yaml.deploy.here import is_here
from robocomp_yaml.deploy.probe import ProbedProgram
from robocomp_yaml.deploy.push import pushing
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.listing import some
from robocomp_yaml.grouping import grouped
from robocomp_yaml.network import files
from robocomp_yaml.network.network import Network, Process

_SHOWN = 3  # files in a message


class AvailableProcess(msgspec.Struct, frozen=True):
    """A process of a deployment as a host could run it. `is_assigned` says whether it is to run there, `missing` what
    the host lacks for it."""

    name: str
    component: str
    is_assigned: bool
    missing: tuple[str, ...] = ()

    @property
    def is_present(self) -> bool:
        return not self.missing


def available(deployment: Deployment, host: str) -> list[AvailableProcess]:
    """The processes of a deployment, and what a host lacks for each. A host that does not answer is in the diagnostics
    of the deployment, and the list is empty. Raises Refused if the host is unknown."""
    network = deployment.network
    require("host", host, network.hosts, network.name)
    found = deployment.probe(host).get(host)
    if found is None:
        return []
    lacking, sent = _files(deployment, network, host)
    return [
        AvailableProcess(
            one.name, one.component, one.host == host, (*_programs(one, found, sent), *lacking.get(one.name, ()))
        )
        for one in network.enabled()
    ]  # fmt: skip


def _programs(process: Process, found: Sequence[ProbedProgram], sent: Collection[str]) -> list[str]:
    """What a host lacks to run a program. A program that a push brings is one of the files."""
    own = [one for one in found if process.name in one.used_by]
    lost = [one.program for one in own if not one.path and one.program not in sent]
    return [*(f"the program {program}" for program in lost), *(text for one in own for text in one.missing)]


def _files(deployment: Deployment, network: Network, host: str) -> tuple[dict[str, list[str]], set[str]]:
    """What a push would have to bring for each process, or what prevents it, as texts; and the files here."""
    if is_here(network.hosts[host]):
        return {}, set()
    there = replace(network, processes={name: replace(one, host=host) for name, one in network.processes.items()})
    pushes, diagnostics = pushing.compared(there, [network.hosts[host]], ())
    needed, sent = files.on_host(there, host), [here for push in pushes for here in push.send.values()]
    lacking = grouped((name, network.hosts[host].there(here)) for here in sent for name in needed[here])
    found = {name: [_in_words(paths)] for name, paths in lacking.items()}
    for one in diagnostics:
        facts = dict(one.facts)
        if one.code == codes.CANNOT.id:
            found.setdefault(str(facts["name"]), []).append(str(facts["reason"]))
        else:
            deployment.add([one])
    return found, {here for push in pushes for here in push.send.values()}


def _in_words(paths: Sequence[str]) -> str:
    return f"{len(paths)} file{'s' * (len(paths) != 1)} to push: {some(sorted(paths), _SHOWN)}"
