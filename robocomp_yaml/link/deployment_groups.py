"""The interfaces that closed groups offer, and the member that serves each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml.diag.codes import ddsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, Served, offers
from robocomp_yaml.link.expand_deployments import ExpandedDocument
from robocomp_yaml.link.knot import grow, tie
from robocomp_yaml.link.program import Port
from robocomp_yaml.model.deployment import Exposed


def resolve(root: LinkedDeployment, documents: Iterable[ExpandedDocument]) -> Iterator[Diagnostic]:
    """Sets `serves` of each group, and reports errors in the groups of the deployment's own document."""
    for part in documents:
        for group in part.groups:
            faults = list(_group(root, group)) if group.is_closed else []
            if part.is_own:
                yield from faults


def _group(root: LinkedDeployment, group: LinkedGroup) -> Iterator[Diagnostic]:
    if any(member.broken or (member.component and member.component.broken) for member in group.members):
        tie(group, broken=True)
    rules = {rule.name: rule for rule in group.group.exposed}
    facade = group.facade
    for port in facade.implements if facade else ():
        if port.name not in rules:
            yield from _by_interface(group, port)
    for rule in rules.values():
        offered = next((p for p in facade.implements if p.name == rule.name), None) if facade else None
        if facade is not None and offered is None and not facade.broken:
            yield codes.UNKNOWN_PORT.at(
                rule.span,
                component=facade.component.name,
                what="interface",
                name=rule.name,
                hint=did_you_mean(rule.name, [p.name for p in facade.implements], rules),
                related=[Related("the group acts as this component", facade.component.span)],
            )
        else:
            yield from _by_rule(root, group, rule, offered)


def _by_interface(group: LinkedGroup, port: Port) -> Iterator[Diagnostic]:
    """Finds the member that serves an interface of the component under `as:`."""
    fitting = [served for member in group.members for served in offers(member) if _fits(served, port)]
    exact = [served for served in fitting if served.adapter == port.name]
    fitting = exact if len(exact) == 1 else fitting
    span = group.group.facade.span if group.group.facade else group.group.span
    if len(fitting) == 1:
        grow(group, "serves", Served(port.name, fitting[0].instance, fitting[0].adapter, fitting[0].port))
    elif fitting:
        names = [_name(group, served.instance) for served in fitting]
        yield codes.SEVERAL_SERVE.at(
            span,
            group=group.group.name,
            name=port.name,
            members=", ".join(names),
            hint=f"add `expose: {{{port.name}: {names[0]}}}`, or another member",
            related=[
                Related(f"the member '{name}'", s.instance.entry.span) for name, s in zip(names, fitting, strict=True)
            ],
        )
    elif not group.broken:
        yield codes.NOT_SERVED.at(
            span,
            group=group.group.name,
            name=port.name,
            hint="add a member that implements it",
            related=[Related("the group offers it", port.use.span)],
        )


def _by_rule(root: LinkedDeployment, group: LinkedGroup, rule: Exposed, port: Port | None) -> Iterator[Diagnostic]:
    """Resolves an entry of `expose:`: a member, or a member and its interface."""
    targets, behind = root.find(rule.member.text, group.scope)
    members = [target for target in targets if isinstance(target, LinkedInstance) and target in group.members]
    if (
        len(members) != 1 and group.group.include is not None
    ):  # an included member may have the name of its own document
        targets, behind = root.find(rule.member.text, f"{group.name}.")
        members = [target for target in targets if isinstance(target, LinkedInstance)]
    if len(members) != 1:
        if not group.broken:
            names = [_name(group, member) for member in group.members]
            yield codes.UNKNOWN_NAME.at(
                rule.member.span,
                where=f"the group '{group.group.name}'",
                name=rule.member.text,
                hint=did_you_mean(rule.member.text, names, otherwise="it is not a member of the group"),
            )
        return
    name = behind or rule.name
    every = list(offers(members[0]))
    fitting = [served for served in every if served.adapter == name]
    fitting = fitting or [served for served in every if served.port and served.port.interface.name == name]
    fitting = [served for served in fitting if port is None or _fits(served, port)]
    if len(fitting) == 1:
        served = fitting[0]
        faults = list(_methods(rule, served))
        limit = None if faults or (rule.rate is None and rule.allow is None) else rule
        grow(group, "serves", Served(rule.name, served.instance, served.adapter, served.port, limit))
        yield from faults
    elif not group.broken:
        adapters = ", ".join(served.adapter for served in every)
        yield codes.NOT_SERVED.at(
            rule.member.span,
            group=group.group.name,
            name=rule.name,
            hint=f"'{rule.member.text}' serves {adapters}" if adapters else f"'{rule.member.text}' serves nothing",
        )


def _methods(rule: Exposed, served: Served) -> Iterator[Diagnostic]:
    if served.port is None:
        return
    interface = served.port.interface
    names = [method.name for method in interface.methods]
    for method in rule.allow or ():
        if method.text not in names:
            others = {other.text for other in rule.allow or ()}
            yield codes.UNKNOWN_METHOD.at(
                method.span,
                interface=interface.name,
                name=method.text,
                hint=did_you_mean(method.text, names, others, otherwise=f"it has {', '.join(names)}"),
                related=[Related("the interface", interface.span)],
            )


def _fits(served: Served, port: Port) -> bool:
    """Whether a member serves the interface that the group offers."""
    if served.port is None:
        return served.adapter.rpartition(".")[2] == port.interface.name
    mine, other = served.port, port
    return (mine.scope.module.name, mine.interface.name) == (other.scope.module.name, other.interface.name)


def _name(group: LinkedGroup, instance: LinkedInstance) -> str:
    """The name of a member in the document of the group."""
    return instance.name.removeprefix(group.scope)
