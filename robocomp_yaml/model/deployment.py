"""The DDSL model: the components and programs of a network, their hosts and connections.

Names and paths are as written; the texts of an entry with `instances:` still contain `{i}`.
"""

from __future__ import annotations

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.located import Spanned, Text
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.source.tree import Mapping

COMPONENT, PROGRAM, PROCESS = "component", "program", "process"
NEVER, ON_FAILURE, ALWAYS = "no", "on-failure", "always"
SERVER, TASK = "server", "task"
ARGUMENT = "argument"
INDEX = "{i}"
CONFIG = "{config}"
"""A placeholder in arguments: the path of the process's configuration."""


class Host(Spanned, frozen=True):
    """An entry of `hosts:`. `user` is for ssh; '' is the operator's own."""

    name: str
    address: Text
    user: str = ""
    doc: str = ""


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


class Variable(Spanned, frozen=True):
    """An environment variable: `value`, or the operator's variable `source`, or the text of `file`."""

    name: str
    value: str = ""
    source: str = ""
    file: str = ""


class Number(Spanned, frozen=True):
    """The TCP port of the interface `name`, which is '' for `port:`."""

    name: str
    number: int
    name_span: Span = Span("")


class Pair(Spanned, frozen=True):
    """A key and its text under `connect`, `topics` or `endpoints`. `span` is that of the text."""

    name: str
    text: str
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

    `role` is SERVER or TASK, '' if it is not set. `settings` is the tree of `set:`. `config_as` is ARGUMENT or an
    option such as `--Ice.Config`. `instances` is None if the key is missing. `extra` is the data of
    `x-rcmanager:`, every scalar as spelled.
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
    this one. `extra` is the plain data of `x-rcmanager:`. `ports` is the range of default TCP ports."""

    name: str
    path: str
    hosts: tuple[Host, ...] = ()
    services: tuple[Storm, ...] = ()
    entries: tuple[Entry, ...] = ()
    groups: tuple[Group, ...] = ()
    includes: tuple[Text, ...] = ()
    alive: Alive | None = None
    extra: tuple[tuple[str, object], ...] = ()
    doc: str = ""
    ports: PortRange | None = None

    @property
    def all_includes(self) -> tuple[Text, ...]:
        """All included paths: those of `include:` and of groups."""
        return (*self.includes, *(group.include for group in self.groups if group.include))
