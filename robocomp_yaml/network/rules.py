"""Rates and access rules of groups, which ask for a proxy between a group and those outside of it."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.deployments import LinkedDeployment


def rule_faults(linked: LinkedDeployment) -> Iterator[Diagnostic]:
    """Such a proxy cannot be made yet: a rule that would not hold is refused."""
    for group in linked.groups.values():
        for served in group.serves:
            if served.rule is not None:
                yield codes.NO_RULES.at(
                    served.rule.span, group=group.name, name=served.name,
                    hint="leave `rate` and `allow` out: then the group's member is connected directly",
                )
