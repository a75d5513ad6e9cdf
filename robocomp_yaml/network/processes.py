"""From a draft to its process: command, folder, environment, readiness, restarts."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import component_argument
from robocomp_yaml.model import deployment as model
from robocomp_yaml.model.deployment import CONFIG, ResourceLimits
from robocomp_yaml.network import icestorm, liveness, ready_when
from robocomp_yaml.network.draft import Draft, StormDraft
from robocomp_yaml.network.listening import SSL
from robocomp_yaml.network.network import (
    COMPONENT,
    PROGRAM,
    PYTHON,
    ConfigFile,
    EnvironmentVariable,
    Process,
    RestartRule,
)
from robocomp_yaml.source.disk import Disk


def of_draft(draft: Draft, text: str | None, disk: Disk, secrets: tuple[str, ...] = ()) -> Process:
    """The process of a draft. `text` is its configuration, with the names of the `secrets` in it."""
    instance, entry = draft.instance, draft.instance.entry
    component = instance.component
    program = program_of(draft)
    folder = os.path.abspath(instance.folder or ".")
    if component is not None and entry.cwd is not None:
        folder = os.path.abspath(os.path.join(os.path.dirname(instance.document.path), entry.cwd.text))
    command = tuple(_command(draft, program))
    reads_config = any(CONFIG in part for part in command[1:])
    ready = ready_when.of_draft(draft)
    return Process(
        draft.name,
        draft.host.name,
        command,
        folder,
        PROGRAM if component is None else COMPONENT,
        env=tuple(_environment(draft)),
        config=ConfigFile(f"config/{draft.name}", text, secrets) if text is not None and reads_config else None,
        endpoints=tuple(adapter.resolved() for adapter in draft.adapters),
        ready=ready,
        restart=_restart(entry.restart),
        alive=liveness.of_draft(draft),
        limits=_limits(draft),
        watched=(program, *_code(instance.folder, component, disk)) if os.path.isabs(program) else (),
        aliases=tuple(alias.name for alias in draft.aliases),
        groups=tuple(group.name for group in instance.groups),
        enabled=entry.enabled,
        is_ice=component is not None or bool(draft.offers or entry.config_as or entry.connect),
        role=entry.role,
        is_secured=draft.protocol == SSL,
        settled=ready_when.settled(entry.ready, ready),
        secrets=_secrets(component),
        component=component.component.name if component is not None else "",
        build=_build(draft),
        introspection=liveness.introspection(draft),
        extra=_extra(draft),
        span=entry.span,
    )


def _secrets(component: LinkedComponent | None) -> tuple[str, ...]:
    """The names of the secret parameters."""
    if component is None:
        return ()
    from robocomp_yaml.parameters.hidden import secrets_of  # programs have no parameters

    return secrets_of(component.parameters)


def _extra(draft: Draft) -> tuple[tuple[str, object], ...]:
    """What only exports need of an entry, of its aliases, and of what they spell."""
    entry = draft.instance.entry
    extra = entry.extra
    of_aliases = {alias.name: dict(alias.entry.extra) for alias in draft.aliases if alias.entry.extra}
    if of_aliases:
        extra = (*extra, ("aliases", of_aliases))
    if extra and entry.cwd is not None:
        extra = (*extra, ("cwd", entry.cwd.text))
    return (*extra, ("after", [text.text for text in entry.after])) if extra else ()


def _environment(draft: Draft) -> Iterator[EnvironmentVariable]:
    """The variables of the entry, and those of its host that the entry does not set."""
    instance, host = draft.instance, draft.instance.host
    own = [_variable(one, instance.document.path) for one in instance.entry.env]
    names = {one.name for one in own}
    if host is not None and not {PYTHON, *(one.name for one in host.env)} <= names:
        of_host = [_variable(one, host.span.file) for one in host.env]
        if host.python and instance.component is not None:
            of_host.append(EnvironmentVariable(PYTHON, host.python.text))
        yield from ({one.name: one for one in of_host if one.name not in names}).values()
    yield from own


def _limits(draft: Draft) -> ResourceLimits:
    """An entry's keys have precedence over those of its host, and these over those of its deployment."""
    instance = draft.instance
    layers = (instance.document.limits, instance.host.limits if instance.host else None, instance.entry.limits)
    keys = ResourceLimits.__struct_fields__
    found = {key: value for one in layers if one for key in keys if (value := getattr(one, key)) is not None}
    return ResourceLimits(**found)


def _variable(given: model.Variable, document: str) -> EnvironmentVariable:
    file = given.file
    if file and not file.startswith("~/"):
        file = os.path.abspath(os.path.join(os.path.dirname(document), file))
    return EnvironmentVariable(given.name, given.value, given.source, file)


def program_of(draft: Draft) -> str:
    """The absolute path of the program, or a bare name, which is resolved in PATH."""
    instance, entry = draft.instance, draft.instance.entry
    component = instance.component
    if component is None:
        text = entry.target.text
        return os.path.abspath(os.path.join(instance.folder, text)) if "/" in text else text
    path = entry.executable.text if entry.executable else own_program(component)
    return os.path.abspath(os.path.join(instance.folder, path))


def _build(draft: Draft) -> str:
    component, executable = draft.instance.component, draft.instance.entry.executable
    if component is None:
        return ""
    if executable is not None and os.path.normpath(executable.text) != own_program(component):
        return f"build it, or correct `executable: {executable.text}`"
    return how_to_build(component)


def how_to_build(component: LinkedComponent) -> str:
    """The commands that write or build the program of a component."""
    path = component.component.path
    compile_ = f"`{typed('rcyaml', 'compile', path)}`"
    if not component.component.language.target.build:
        return f"{compile_} writes it"
    name = component_argument(component.component.name, path)
    return f"{compile_}, then `{typed('rcyaml', 'build', name)}`"


def own_program(component: LinkedComponent) -> str:
    """The program of a component, relative to its folder."""
    return component.component.language.target.program.format(name=component.component.name)


def _command(draft: Draft, program: str) -> Iterator[str]:
    """The program and its arguments. The path of the configuration is the first argument, unless `config-as:` or an
    argument has it elsewhere; a program without a configuration gets none."""
    entry = draft.instance.entry
    has_one = draft.instance.component is not None or entry.config is not None
    in_arguments = any(CONFIG in argument.text for argument in entry.args)
    how = entry.config_as.text if entry.config_as else model.ARGUMENT if has_one and not in_arguments else ""
    yield program
    if how == model.ARGUMENT:
        yield CONFIG
    yield from (argument.text for argument in entry.args)
    if how.startswith("-"):
        yield f"{how}={CONFIG}"


def _restart(given: model.Restart | None) -> RestartRule:
    if given is None:
        return RestartRule()
    keys: dict[str, Any] = {"delay": given.delay, "tries": given.tries, "window": given.within}
    rule = RestartRule(given.policy, **{key: value for key, value in keys.items() if value is not None})
    return replace(rule, longest=max(rule.delay, rule.longest))


def _code(folder: str, component: LinkedComponent | None, disk: Disk) -> tuple[str, ...]:
    """The files of code that a component loads when it starts."""
    loaded = component.component.language.target.loaded if component is not None else {}
    return disk.ask(_files_of, folder, tuple(loaded.items())) if loaded else ()


def _files_of(folder: str, loaded: tuple[tuple[str, tuple[str, ...]], ...]) -> tuple[str, ...]:
    top = os.path.abspath(folder)
    files = (
        os.path.join(where, name)
        for below, endings in loaded
        for where, _, names in os.walk(os.path.join(top, below))
        for name in names
        if name.endswith(endings)
    )
    return tuple(sorted(files))


def of_storm(storm: StormDraft, folder: str, *, enabled: bool) -> Process:
    """The process of an IceStorm. It is not `enabled` if no enabled process needs it."""
    host = storm.host.name
    made = icestorm.process(
        storm.name, host, storm.endpoints(), storm.proxy, folder, storm.span, enabled=enabled,
        published=storm.published(),
    )  # fmt: skip
    return replace(made, is_secured=storm.protocol == SSL, unless=(storm.proxy,) if storm.linked.storm.shared else ())
