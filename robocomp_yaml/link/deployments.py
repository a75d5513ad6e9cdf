"""A deployment with all that it includes: every instance with its component and values, every group with its members.

Names are full here: what stands in an include that has a name is called `arm.elbow`, and an entry with instances is
there once for each, with `{i}` filled in everywhere. Ports and connections are derived from this, by `network`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port
from robocomp_yaml.model.deployment import Deployment, Entry, Exposed, Group, Host, Storm


class LinkedInstance(msgspec.Struct, frozen=True, eq=False):
    """An instance of an entry of `components:`. `entry` has this instance's texts (only its ports are not counted up);
    `number` counts from 0, None for an entry without `instances:`. `scope` is what full names begin with where the
    entry stands: '' or `arm.`; `document` is where that is.

    `component` is None for a program, and for a document with errors. `values` are those of the document that
    `config:` names, else of the component's `etc/config.yaml`; `flat` is the path (as opened) of a configuration file
    that is none of our documents. `folder` is where the component's document stands, or where a program runs.
    `host` is None for this machine. `process` is the instance that a PROCESS entry is a second name of.
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
    """Whether something about it has been reported, so that what depends on it is not judged."""


class LinkedStorm(msgspec.Struct, frozen=True, eq=False):
    """An entry of `services:` by its full name."""

    name: str
    storm: Storm
    document: Deployment
    scope: str = ""
    host: Host | None = None
    broken: bool = False


class Served(msgspec.Struct, frozen=True):
    """An interface that a group serves: `name` to those outside, `adapter` to the member `instance`, which has an entry
    of this name under `implements` (its `port`) or, for a program, under `endpoints:`. `rule` is the entry of `expose:`
    with a rate or access rule, else None."""

    name: str
    instance: LinkedInstance
    adapter: str
    port: Port | None = None
    rule: Exposed | None = None


class LinkedGroup(msgspec.Struct, frozen=True, eq=False):
    """A group by its full name. `members` are all instances in it, those of the groups `inner` too, which are all that
    it holds. `serves` is what a closed group offers; what an open one does is whatever its members implement."""

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
        """A group that holds another one has more of it, even if both have the same members."""
        return len(self.members), len(self.inner)

    def offers(self) -> Iterator[Served]:
        """What can be connected to through the group."""
        if self.is_closed:
            yield from self.serves
            return
        for member in self.members:
            yield from offers(member)


def offers(instance: LinkedInstance) -> Iterator[Served]:
    """What an instance serves by its component, or else by its endpoints."""
    if instance.component is not None:
        for port in instance.component.implements:
            yield Served(port.name, instance, port.name, port)
        return
    for endpoint in instance.entry.endpoints:
        yield Served(endpoint.name, instance, endpoint.name)


Target = LinkedInstance | LinkedStorm | LinkedGroup


class LinkedDeployment(msgspec.Struct, frozen=True, eq=False):
    """One DDSL document with its includes, in the order of the documents. `real` is its real path. `hosts` is empty
    where everything runs on this machine. `names` are, by scope, the names that stand in it and what they mean: an
    entry with instances stands for all of them. `is_included` when another document builds on this one, so that what
    it requires may be there."""

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
        """What a text such as `speech`, `speech.Speech` or `arm.elbow.Motor` means where names begin with `scope`: the
        targets of the longest name that is there, and what is left behind it (an interface, or '')."""
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

    def closed_around(self, target: Target, source: LinkedInstance) -> list[LinkedGroup]:
        """The closed groups that hold the target but not `source`, the outermost first."""
        held = _instances(target)
        around = [
            group
            for group in (held[0].groups if held else ())
            if group is not target
            and group.is_closed
            and group not in source.groups
            and all(group in member.groups for member in held)
            and not (isinstance(target, LinkedGroup) and group.breadth <= target.breadth)
        ]
        return sorted(around, key=lambda group: group.breadth, reverse=True)

    def storms_for(self, source: LinkedInstance) -> list[LinkedStorm]:
        """The IceStorms whose scope `source` stands in, the nearest scope first."""
        around = [storm for storm in self.storms.values() if source.scope.startswith(storm.scope)]
        return sorted(around, key=lambda storm: -len(storm.scope))


def _instances(target: Target) -> tuple[LinkedInstance, ...]:
    if isinstance(target, LinkedGroup):
        return target.members
    return (target,) if isinstance(target, LinkedInstance) else ()
