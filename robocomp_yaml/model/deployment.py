"""The DDSL model: the components and programs of a network, their hosts and connections.

Names and paths are as written; the texts of an entry with `instances:` still contain `{i}`.
"""

from __future__ import annotations

import msgspec
from msgspec.structs import astuple

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.located import Spanned, Text
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.source.tree import Mapping

COMPONENT, PROGRAM, PROCESS = "component", "program", "process"
NEVER, ON_FAILURE, ALWAYS = "no", "on-failure", "always"
SERVER, TASK = "server", "task"
ADDRESS, ANY = "address", "any"
TOKEN, OPEN = "token", "open"
TLS, PLAIN = "tls", "none"
ARGUMENT = "argument"
INDEX = "{i}"
CONFIG = "{config}"
"""A placeholder in arguments: the path of the process's configuration."""


class Variable(Spanned, frozen=True):
    """An environment variable: `value`, or the operator's variable `source`, or the text of `file`."""

    name: str
    value: str = ""
    source: str = ""
    file: str = ""


class Pair(Spanned, frozen=True):
    """A key and its text under `connect`, `topics` or `endpoints`. `span` is that of the text."""

    name: str
    text: str
    name_span: Span = Span("")


class ResourceLimits(msgspec.Struct, frozen=True):
    """What a process may use; None if it is not limited. `memory` and `core` are in bytes (`core` is UNLIMITED for any
    size), `cpu` is in percent of a core, `cores` is a list of numbers and ranges, such as `0,2-3`."""

    memory: int | None = None
    cpu: int | None = None
    cores: str | None = None
    nice: int | None = None
    realtime: int | None = None
    core: int | None = None
    files: int | None = None


UNLIMITED = -1


class SshOptions(Spanned, frozen=True):
    """The key `ssh` of a host. `port` is None if it is not set; the others are '' then. `identity` and `known_hosts`
    are paths of files of the operator."""

    user: str = ""
    port: int | None = None
    identity: str = ""
    known_hosts: str = ""
    jump: str = ""


class Host(Spanned, frozen=True):
    """An entry of `hosts:`. `user` is for ssh; '' is the operator's own. `listen` says where its processes listen:
    ADDRESS, ANY, or names, IP addresses and interfaces of the machine; () if it is not set. `paths` are folders of the
    operator with the folders on the host in their stead; a single folder is for the workspace, with the name ''.
    `systemd` is `user` or `system`."""

    name: str
    address: Text
    user: str = ""
    listen: tuple[Text, ...] = ()
    doc: str = ""
    ssh: SshOptions = SshOptions(span=Span(""))
    paths: tuple[Pair, ...] = ()
    env: tuple[Variable, ...] = ()
    python: Text | None = None
    limits: ResourceLimits | None = None
    systemd: str = ""


class Storm(Spanned, frozen=True):
    """An entry of `services:`: an IceStorm. `port` is that of its topic manager, `publish` that of its publishers; None
    if it is not set. A `shared` one is not used if there is another."""

    name: str
    host: Text | None = None
    port: int | None = None
    doc: str = ""
    publish: int | None = None
    shared: bool = False
    port_span: Span = Span("")
    publish_span: Span = Span("")


class Number(Spanned, frozen=True):
    """The TCP port of the interface `name`, which is '' for `port:`."""

    name: str
    number: int
    name_span: Span = Span("")


class Ready(Spanned, frozen=True):
    """When a process is ready: `port` accepts connections, the proxy `ping` answers, `command` exits with 0, or a line
    of output matches `log`. If none is set, all that the process serves must answer a ping. `within` is in seconds,
    None if it is not set."""

    within: float | None = None
    port: int | None = None
    command: tuple[str, ...] = ()
    log: str = ""
    ping: str = ""


class Restart(Spanned, frozen=True):
    """`policy` is NEVER, ON_FAILURE or ALWAYS; the others are None if they are not set. Times are in seconds."""

    policy: str = ON_FAILURE
    delay: float | None = None
    tries: int | None = None
    within: float | None = None


class Alive(Spanned, frozen=True):
    """How it is checked that a process answers while it runs; None for what is not set. `is_on` is set by a scalar.
    Times are in seconds. `restarts` says what happens if it does not answer. `worker` is the time for which the worker
    may show no life, infinite for `off`."""

    is_on: bool | None = None
    every: float | None = None
    within: float | None = None
    misses: int | None = None
    restarts: bool | None = None
    worker: float | None = None


class Entry(Spanned, frozen=True):
    """An entry of `components:`. `kind` is the key that defines the entry: COMPONENT, PROGRAM, or PROCESS (a second
    name of another entry's process); `target` is that key's value. `executable` replaces the program of a component.

    `role` is SERVER or TASK, '' if it is not set. `listen` is as that of a host, () if it is not set. `settings` is the
    tree of `set:`. `config_as` is ARGUMENT or an option such as `--Ice.Config`. `instances` is None if the key is
    missing. `extra` is the data of `x-rcmanager:`, every scalar as spelled.
    """

    name: str
    kind: str
    target: Text
    executable: Text | None = None
    args: tuple[Text, ...] = ()
    cwd: Text | None = None
    env: tuple[Variable, ...] = ()
    host: Text | None = None
    port: Number | None = None
    ports: tuple[Number, ...] = ()
    config: Text | None = None
    config_as: Text | None = None
    connect: tuple[Pair, ...] = ()
    topics: tuple[Pair, ...] = ()
    settings: Mapping | None = None
    restart: Restart | None = None
    ready: Ready | None = None
    role: str = ""
    alive: Alive | None = None
    listen: tuple[Text, ...] = ()
    limits: ResourceLimits | None = None
    endpoints: tuple[Pair, ...] = ()
    after: tuple[Text, ...] = ()
    enabled: bool = True
    instances: int | None = None
    extra: tuple[tuple[str, object], ...] = ()
    doc: str = ""
    instances_span: Span = Span("")


class Exposed(Spanned, frozen=True):
    """An entry of a group's `expose:`: a member serves `name` (`member.Interface` if the interface has another name).
    `rate` is in calls per second; `allow` are the methods that may be called (None: all). Each of the two requires a
    gate between the group and its callers."""

    name: str
    member: Text
    rate: float | None = None
    allow: tuple[Text, ...] | None = None


class Group(Spanned, frozen=True):
    """An entry of `groups:`, or a named entry of `include:`. `members` are names in this document, `include` is the
    path of another deployment, `facade` is the component document of `as:`. `host` is for members without a host."""

    name: str
    members: tuple[Text, ...] = ()
    include: Text | None = None
    facade: Text | None = None
    exposed: tuple[Exposed, ...] = ()
    host: Text | None = None
    doc: str = ""

    @property
    def is_closed(self) -> bool:
        """Whether processes outside the group can connect to its members only through the group."""
        return self.facade is not None or bool(self.exposed)


class Deployment(Spanned, frozen=True):
    """One DDSL document. `includes` are the paths without a name: the entries of those documents count as entries of
    this one. `extra` is the plain data of `x-rcmanager:`. `ports` is the range of default TCP ports.
    `control` is TOKEN or OPEN, `security` TLS or PLAIN; both '' if they are not set."""

    name: str
    path: str
    hosts: tuple[Host, ...] = ()
    services: tuple[Storm, ...] = ()
    entries: tuple[Entry, ...] = ()
    groups: tuple[Group, ...] = ()
    includes: tuple[Text, ...] = ()
    alive: Alive | None = None
    limits: ResourceLimits | None = None
    extra: tuple[tuple[str, object], ...] = ()
    doc: str = ""
    ports: PortRange | None = None
    control: str = ""
    security: str = ""
    control_span: Span = Span("")
    security_span: Span = Span("")

    def causes(self) -> tuple[object, ...]:
        """All that it consists of, with its locations, as causes for a memory. What is built from an unchanged part of
        a document is the same object after an edit elsewhere."""
        fields = (getattr(self, name) for name in self.__struct_fields__)
        return tuple(astuple(field) if isinstance(field, Span) else field for field in fields)

    @property
    def all_includes(self) -> tuple[Text, ...]:
        """All included paths: those of `include:` and of groups."""
        return (*self.includes, *(group.include for group in self.groups if group.include))
