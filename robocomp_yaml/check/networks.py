"""Checks of networks: those of `ddsl/`, and those that depend on this machine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml.check import checks_of, plugin_checks, reported_by
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.network.networks import DerivedNetworks

_FAMILY = "RC4"


def check_networks(derived: DerivedNetworks, program: Program) -> Iterator[Diagnostic]:
    """The diagnostics of deriving the networks, and of the checks."""
    checks = checks_of("ddsl")
    found = [fault for real in derived.judged for check in checks for fault in check(derived.networks[real])]
    for real in derived.judged:
        for plugin in program.plugins_of(program.deployments[real].deployment.path).active:
            for name, check in plugin_checks(plugin, {"ddsl": True}):
                found += reported_by(plugin, name, check, derived.networks[real])
    return one_per_cause([*derived.diagnostics, *found])


def check_environment(derived: DerivedNetworks, *, environment: bool) -> Iterator[Diagnostic]:
    """Diagnostics that depend on this machine: missing executables and, with `environment`, programs and addresses."""
    from robocomp_yaml.check.ddsl import files, hosts

    found: list[Diagnostic] = []
    for real in derived.judged:
        found += files.missing(derived.networks[real], environment=environment)
        if environment:
            found += hosts.unresolved(derived.networks[real])
    return one_per_cause(found)


def one_per_cause(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Removes repetitions: an error in a document is reported once, even if it affects many instances or includes."""
    seen = set()
    for fault in diagnostics:
        cause: object = fault
        if fault.code.startswith(_FAMILY):
            cause = fault.code, fault.span, tuple(related.span for related in fault.related)
        if cause not in seen:
            seen.add(cause)
            yield fault
