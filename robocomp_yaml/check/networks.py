"""The networks of a program's deployments, derived and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from robocomp_yaml.check import modules_of, plugged, said_by
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.network.derive import derive
from robocomp_yaml.network.network import Network

_FAMILY = "RC4"


def networks_of(program: Program) -> tuple[dict[str, Network], list[Diagnostic]]:
    """Every deployment's network by its real path, and what is wrong with them. A document that another one includes
    is judged as part of that one."""
    networks: dict[str, Network] = {}
    diagnostics: list[Diagnostic] = []
    checks: list[Callable[[Network], Iterator[Diagnostic]]] = [module.check for module in modules_of("ddsl")]
    for real, linked in sorted(program.deployments.items(), key=lambda item: item[1].deployment.path):
        networks[real], found = derive(linked, program.disk)
        if not linked.is_included:
            diagnostics += found
            for check in checks:
                diagnostics += check(networks[real])
            for plugin in program.plugins_of(linked.deployment.path).active:
                for name, check in plugged(plugin, {"ddsl": True}):
                    diagnostics += said_by(plugin, name, check, networks[real])
    return networks, list(one_per_cause(diagnostics))


def of_environment(
    networks: dict[str, Network], program: Program, *, environment: bool
) -> Iterator[Diagnostic]:
    """What depends on this machine: warnings about executables that are not there, and, where `environment` is asked
    for, about programs and addresses."""
    from robocomp_yaml.check.ddsl import files, hosts

    def every(network: Network) -> Iterator[Diagnostic]:
        yield from files.missing(network, environment=environment)
        if environment:
            yield from hosts.unresolved(network)

    found = [every(networks[real]) for real, linked in program.deployments.items() if not linked.is_included]
    return one_per_cause(fault for faults in found for fault in faults)


def one_per_cause(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What a document says once is reported once, however many instances it gives or includes it is part of."""
    seen = set()
    for fault in diagnostics:
        cause: object = fault
        if fault.code.startswith(_FAMILY):
            cause = fault.code, fault.span, tuple(related.span for related in fault.related)
        if cause not in seen:
            seen.add(cause)
            yield fault
