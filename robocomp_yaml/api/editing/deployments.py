"""Changes of deployments: which values of the document a change sets, removes or renames."""

from __future__ import annotations

import os
import re
from functools import singledispatch

from robocomp_yaml.api.editing import changes
from robocomp_yaml.api.editing.entries import COMPONENTS, GROUPS, HOSTS, SERVICES, Entries
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.model.deployment import INDEX
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.tree import Mapping


@singledispatch
def make(change: changes.DeploymentChange, entries: Entries) -> None:
    """Makes a change in the text of `entries`. Raises Refused and NotEditable."""
    raise TypeError(change)


@make.register
def _(change: changes.Connect, entries: Entries) -> None:
    entries.edited.set([*entries.steps(change.entry), "connect", change.port], entries.own(change.to))


@make.register
def _(change: changes.Disconnect, entries: Entries) -> None:
    steps = [*entries.steps(change.entry), "connect", change.port]
    if entries.edited.at(*steps) is None:
        raise Refused(
            f"{entries.edited.path} does not set who serves {change.port} of {change.entry}: the connection follows "
            "from the components, because only one entry serves it; connect it to another one, or change the component"
        )
    entries.edited.remove(steps)


@make.register
def _(change: changes.NameTopic, entries: Entries) -> None:
    _set_or_remove(entries, [*entries.steps(change.entry), "topics", change.port], change.to or None)


@make.register
def _(change: changes.MoveEntry, entries: Entries) -> None:
    if entries.names(HOSTS):
        entries.require(HOSTS, change.host)
    entries.edited.set([*entries.steps(change.entry), "host"], change.host)


@make.register
def _(change: changes.AddHost, entries: Entries) -> None:
    """With a second host, what runs on the first one says so."""
    edited, known = entries.edited, entries.names(HOSTS)
    if change.name in known:
        raise Refused(f"{edited.path} has a host '{change.name}' already")
    if len(known) == 1:
        for name in entries.names():
            if edited.at(COMPONENTS, name, "host") is None and edited.at(COMPONENTS, name, "process") is None:
                edited.set([COMPONENTS, name, "host"], known[0])
        for name in entries.names(SERVICES):
            if edited.at(SERVICES, name, "icestorm", "host") is None:
                edited.set([SERVICES, name, "icestorm", "host"], known[0])
    ssh = {
        "port": change.port, "identity": change.identity, "known-hosts": change.known_hosts, "jump": change.jump,
    }  # fmt: skip
    ssh = {key: value for key, value in ssh.items() if value not in ("", None)}
    new = {"address": change.address, "user": change.user, "path": change.path, "ssh": ssh}
    new = {key: value for key, value in new.items() if value}
    edited.set([HOSTS, change.name], new if len(new) > 1 else change.address)


@make.register
def _(change: changes.RemoveHost, entries: Entries) -> None:
    entries.require(HOSTS, change.name)
    entries.edited.remove([HOSTS, change.name], with_comments=True)


@make.register
def _(change: changes.GroupEntries, entries: Entries) -> None:
    edited, steps = entries.edited, [GROUPS, change.group, "components"]
    if change.group not in entries.names(GROUPS):
        entries.require_new(change.group)
    groups = entries.names(GROUPS)
    members = [one if (one := entries.own(name)) in groups else entries.key(name) for name in change.members]
    for member in dict.fromkeys(members):
        if member not in (edited.data(*steps) or ()):
            edited.append(steps, member)


@make.register
def _(change: changes.UngroupEntries, entries: Entries) -> None:
    edited = entries.edited
    entries.require(GROUPS, change.group)
    if not change.members:
        _without_uses(entries, change.group)
        edited.remove([GROUPS, change.group], with_comments=True)
        return
    for name in change.members:
        members = edited.data(GROUPS, change.group, "components") or []
        own = entries.own(name)
        member = own if own in members else entries.key(name)
        if member not in members:
            raise Refused(f"'{name}' is not a member of the group '{change.group}'{meant(name, members)}")
        edited.remove([GROUPS, change.group, "components", members.index(member)])


@make.register
def _(change: changes.AddEntry, entries: Entries) -> None:
    entries.require_new(change.entry)
    if bool(change.component) == bool(change.program):
        raise Refused("an entry is either a component or a program")
    new: dict[str, object] = {"component": _relative(change.component, entries)} if change.component else {}
    if change.program:
        new = {"program": change.program, **({"args": list(change.args)} if change.args else {})}
    if change.host:
        new["host"] = change.host
    entries.edited.set([COMPONENTS, change.entry], new)


@make.register
def _(change: changes.AddNew, entries: Entries) -> None:
    (path,) = entries.created
    make(changes.AddEntry(change.entry, component=path, host=change.host), entries)


@make.register
def _(change: changes.RemoveEntry, entries: Entries) -> None:
    steps = entries.steps(change.entry)
    _without_uses(entries, str(steps[-1]))
    entries.edited.remove(steps, with_comments=True)


@make.register
def _(change: changes.RenameEntry, entries: Entries) -> None:
    own = entries.own(change.entry)
    section, old = (GROUPS, own) if own in entries.names(GROUPS) else (COMPONENTS, entries.key(change.entry))
    new = entries.own(change.name)
    if (INDEX in old) != (INDEX in new):
        raise Refused(f"an entry with instances has {INDEX} in its name, and no other has it: '{change.name}'")
    if old == new:
        return
    entries.require_new(new)
    _rename(entries, section, old, new)


@make.register
def _(change: changes.SetParameter, entries: Entries) -> None:
    steps = [*entries.steps(change.entry), "set"]
    place, is_set = _parameter(entries, steps, change.parameter)
    if change.value is None and not is_set:
        raise Refused(f"{entries.edited.path} does not set {change.parameter} of {change.entry}")
    if change.value is None:
        entries.edited.remove(place)
    else:
        entries.edited.set(place, change.value)


@make.register
def _(change: changes.SetPort, entries: Entries) -> None:
    """`port:` and `ports:` exclude each other. The port of an endpoint is in its text."""
    steps, edited, component = entries.steps(change.entry), entries.edited, entries.component(change.entry)
    endpoints = edited.data(*steps, "endpoints")
    if isinstance(endpoints, dict) and (change.interface in endpoints or component is None):
        _set_port_of_endpoint(entries, change, [*steps, "endpoints"], endpoints)
        return
    served = [port.name for port in component.implements] if component is not None else []
    first = next(iter(served), "CommonBehavior")
    number = edited.data(*steps, "port")
    is_first = change.interface in ("", first)
    if edited.at(*steps, "ports") is not None:
        _set_or_remove(entries, [*steps, "ports", change.interface or first], change.number)
    elif is_first or (number is None and change.number is None):
        _set_or_remove(entries, [*steps, "port"], change.number)
    else:
        if number is not None and change.number is not None:
            edited.remove([*steps, "port"])
            edited.set([*steps, "ports"], {first: number})
        _set_or_remove(entries, [*steps, "ports", change.interface], change.number)


def _set_port_of_endpoint(
    entries: Entries, change: changes.SetPort, steps: list[Step], endpoints: dict[str, object]
) -> None:
    known = list(endpoints)
    interface = change.interface or next(iter(known), "")
    if interface not in known:
        raise Refused(f"{change.entry} serves no '{interface}'{meant(interface, known)}")
    text = str(endpoints[interface])
    changed, count = re.subn(r"(?<!\S)-p(\s+)\d+", rf"-p\g<1>{change.number}", text, count=1)
    if change.number is None or not count:
        raise Refused(f"the endpoint of {interface} is '{text}': change its text, `endpoints:` of {change.entry}")
    entries.edited.set([*steps, interface], changed)


@make.register
def _(change: changes.SetInstances, entries: Entries) -> None:
    """An entry that gets instances gets a name with their number. What was connected to it is connected to the first
    one; what starts after it starts after all of them."""
    if change.count < 1:
        raise Refused("an entry has at least one instance; remove it instead")
    old = entries.key(change.entry)
    name = old if INDEX in old else f"{old}{INDEX}"
    if name != old:
        entries.require_new(name)
        _rename(entries, COMPONENTS, old, name, one=f"{old}0")
    entries.edited.set([COMPONENTS, name, "instances"], change.count)


@make.register
def _(change: changes.StartAfter, entries: Entries) -> None:
    steps = [*entries.steps(change.entry), "after"]
    for name in dict.fromkeys(map(entries.own, change.needed)):
        if name not in (entries.edited.data(*steps) or ()):
            entries.edited.append(steps, name)


@make.register
def _(change: changes.StartIndependently, entries: Entries) -> None:
    steps = [*entries.steps(change.entry), "after"]
    for name in dict.fromkeys(map(entries.own, change.needed)):
        listed = entries.edited.data(*steps) or []
        if name not in listed:
            raise Refused(f"{entries.edited.path} does not say that {change.entry} starts after '{name}'")
        entries.edited.remove([*steps, listed.index(name)])


def _set_or_remove(entries: Entries, steps: list[Step], value: object) -> None:
    if value is not None:
        entries.edited.set(steps, value)
    elif entries.edited.at(*steps) is None:
        raise Refused(f"{entries.edited.path} does not set {paths.in_words(steps[2:])} of {steps[1]}")
    else:
        entries.edited.remove(steps)


def _without_uses(entries: Entries, name: str) -> None:
    while found := next((use for use in entries.uses(name) if use.steps[-1] != "process"), None):
        steps = found.steps[:-1] if found.steps[-1] == "member" else found.steps
        entries.edited.remove(steps)


def _rename(entries: Entries, section: str, old: str, new: str, one: str = "") -> None:
    """Renames a key and its uses. `one` is the name for uses that mean a single process, if that is not `new`."""
    for use in list(entries.uses(old)):
        pattern = re.escape(old).replace(re.escape(INDEX), r"(\d+)")
        number = re.fullmatch(pattern, use.text) if INDEX in old and use.text != old else None
        named = new.replace(INDEX, number[1]) if number is not None else new if use.is_all or not one else one
        entries.edited.set(use.steps, named + use.rest)
    entries.edited.rename([section, old], new)
    if section == COMPONENTS:
        entries.renamed.append((old, new))


def _parameter(entries: Entries, steps: list[Step], parameter: str) -> tuple[list[Step], bool]:
    """Where `set:` has a parameter, or would have it, and whether it has it: nested, or by its path, or both."""
    if not (wanted := paths.parse(parameter)):
        raise Refused(f"'{parameter}' is not a path of a parameter, such as motors[0].vel")
    node, found = entries.edited.at(*steps), list(steps)
    while isinstance(node, Mapping):
        for key, (_, value) in node.entries.items():
            own = paths.parse(key)
            if own and own == wanted[: len(own)] and (len(own) == len(wanted) or isinstance(value, Mapping)):
                found, node, wanted = [*found, key], value, wanted[len(own) :]
                break
        else:
            return [*found, paths.in_words(int(one) if one.isdigit() else one for one in wanted)], False
        if not wanted:
            return found, True
    return [*found, paths.in_words(int(one) if one.isdigit() else one for one in wanted)], False


def _relative(path: str, entries: Entries) -> str:
    if path not in entries.created and not os.path.exists(path):
        raise Refused(f"'{path}' does not exist")
    return os.path.relpath(path, os.path.dirname(entries.edited.path) or ".")
