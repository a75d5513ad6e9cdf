"""A deployment with all that it includes: every instance with its component and values, every group with its members.

Names are full names: an entry `elbow` of an include called `arm` is `arm.elbow`. An entry with `instances:` is one
`LinkedInstance` for each number, with `{i}` replaced. `network` derives processes and connections from these.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port
from robocomp_yaml.model.deployment import Deployment, Entry, Exposed, Group, Host, Storm


class LinkedInstance(msgspec.Struct, frozen=True, eq=False):
    """An instance of an entry of `components:`. `entry` has the texts of this instance (only its TCP ports are as
    written); `number` counts from 0, None for an entry without `instances:`. `document` contains the entry, and `scope`
    is the prefix of full names in that document: '' or `arm.`.

    `component` is None for a program, and for a document with errors. `values` is the document that `config:` names, or
    the component's `etc/config.yaml`; `flat` is the path (as opened) of a flat config: that of `config:`, or
    the component's `etc/config` if it has no values document. `folder` is that of the component's document, or the
    working folder of a program. `host` is None for this machine. `process` is the instance of which a PROCESS entry is
    a second name.
    """

    name: str
    entry: Entry
    document: Deployment
    scope: str = ""
    number: int | None = None
    component: LinkedComponent | None = None
    values: LinkedValues | None = None
    flat: str = ""
    folder: str = ""
    host: Host | None = None
    process: LinkedInstance | None = None
    after: tuple[LinkedInstance | LinkedStorm, ...] = ()
    groups: tuple[LinkedGroup, ...] = ()
    broken: bool = False
    """Whether an error in the instance is reported, so that nothing that depends on it is checked."""


class LinkedStorm(msgspec.Struct, frozen=True, eq=False):
    """An entry of `services:` by its full name."""

    name: str
    storm: Storm
    document: Deployment
    scope: str = ""
    host: Host | None = None
    broken: bool = False


class Served(msgspec.Struct, frozen=True):
    """An interface that a group serves under `name`. `adapter` is the name that the member `instance` has for it, under
    `implements` (its `port`) or, for a program, under `endpoints:`. `rule` is the entry of `expose:` with a rate or
    access rule, else None."""

    name: str
    instance: LinkedInstance
    adapter: str
    port: Port | None = None
    rule: Exposed | None = None


class LinkedGroup(msgspec.Struct, frozen=True, eq=False):
    """A group by its full name. `members` are all instances in the group, including those of the groups `inner`, at any
    depth. `serves` is what a closed group offers; an open group offers what its members implement."""

    name: str
    group: Group
    document: Deployment
    scope: str = ""
    members: tuple[LinkedInstance, ...] = ()
    inner: tuple[LinkedGroup, ...] = ()
    facade: LinkedComponent | None = None
    serves: tuple[Served, ...] = ()
    broken: bool = False

    @property
    def is_closed(self) -> bool:
        return self.group.is_closed

    @property
    def breadth(self) -> tuple[int, int]:
        """Sorts groups: a group that contains another one is greater, even if both have the same members."""
        return len(self.members), len(self.inner)

    def offers(self) -> Iterator[Served]:
        """The interfaces to which others can connect through the group."""
        if self.is_closed:
            yield from self.serves
            return
        for member in self.members:
            yield from offers(member)


def offers(instance: LinkedInstance) -> Iterator[Served]:
    """The interfaces that an instance serves: those of its component, or of a program's endpoints."""
    if instance.component is not None:
        for port in instance.component.implements:
            yield Served(port.name, instance, port.name, port)
        return
    for endpoint in instance.entry.endpoints:
        yield Served(endpoint.name, instance, endpoint.name)


Target = LinkedInstance | LinkedStorm | LinkedGroup


class LinkedDeployment(msgspec.Struct, frozen=True, eq=False):
    """One DDSL document with its includes, in the order of the documents. `real` is its real path. `hosts` is empty if
    all runs on this machine. `names` maps each scope to its names, and each name to its targets: the name of an entry
    with instances has all of them. `is_included` holds if another document includes this one, and may define what this
    one requires."""

    deployment: Deployment
    real: str
    hosts: Mapping[str, Host] = {}
    instances: Mapping[str, LinkedInstance] = {}
    storms: Mapping[str, LinkedStorm] = {}
    groups: Mapping[str, LinkedGroup] = {}
    names: Mapping[str, Mapping[str, tuple[Target, ...]]] = {}
    documents: tuple[Deployment, ...] = ()
    is_included: bool = False
    broken: bool = False

    def find(self, text: str, scope: str) -> tuple[tuple[Target, ...], str]:
        """Resolves a text such as `speech`, `speech.Speech` or `arm.elbow.Motor` in a scope. Returns the targets of the
        longest prefix that is a name, and the rest of the text (an interface, or '')."""
        name, behind = text, ""
        while True:
            found = self._named(name, scope)
            if found or "." not in name:
                return found, behind
            name, _, last = name.rpartition(".")
            behind = f"{last}.{behind}" if behind else last

    def _named(self, name: str, scope: str) -> tuple[Target, ...]:
        found = self.names.get(scope, {}).get(name)
        if found is None and "." in name:
            inner, _, last = name.rpartition(".")
            found = self.names.get(f"{scope}{inner}.", {}).get(last)
        return found or ()

    def closed_groups_of(self, target: Target, source: LinkedInstance) -> list[LinkedGroup]:
        """The closed groups that contain the target but not `source`, the outermost first."""
        members = _instances(target)
        groups = [
            group
            for group in (members[0].groups if members else ())
            if group is not target
            and group.is_closed
            and group not in source.groups
            and all(group in member.groups for member in members)
            and not (isinstance(target, LinkedGroup) and group.breadth <= target.breadth)
        ]
        return sorted(groups, key=lambda group: group.breadth, reverse=True)

    def storms_for(self, source: LinkedInstance) -> list[LinkedStorm]:
        """The IceStorms in the scopes around `source`, the innermost scope first."""
        storms = [storm for storm in self.storms.values() if source.scope.startswith(storm.scope)]
        used = dict.fromkeys(self.storm_instead(storm) for storm in storms)
        return sorted(used, key=lambda storm: -len(storm.scope))

    def storm_instead(self, storm: LinkedStorm) -> LinkedStorm:
        """The IceStorm that is used instead of a shared one: the nearest one around it that is not shared, else the
        outermost shared one, around it or at the same address. Without one of these, the same."""
        if not storm.storm.shared:
            return storm
        around = [one for one in self.storms.values() if storm.scope.startswith(one.scope)]
        if own := [one for one in around if not one.storm.shared]:
            return max(own, key=lambda one: len(one.scope))
        return min((one for one in self.storms.values() if one in around or _is_same(one, storm)),
                   key=lambda one: len(one.scope))  # fmt: skip


def _instances(target: Target) -> tuple[LinkedInstance, ...]:
    if isinstance(target, LinkedGroup):
        return target.members
    return (target,) if isinstance(target, LinkedInstance) else ()


def _is_same(one: LinkedStorm, other: LinkedStorm) -> bool:
    """Whether two shared IceStorms have the same address."""
    is_set = one.storm.shared and one.storm.port is not None and one.storm.port == other.storm.port
    return is_set and (one.host.name if one.host else "") == (other.host.name if other.host else "")
