"""The document that `rcyaml new deployment` writes: the components of the workspace, each of them once."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import msgspec

if TYPE_CHECKING:
    from robocomp_yaml.link.program import LinkedComponent, Port
    from robocomp_yaml.parameters.types import Parameters

_SUFFIX = "comp"


class DeploymentView(msgspec.Struct, frozen=True):
    modeline: str
    name: str
    rows: list[str]
    has_topics: bool
    has_components: bool


def deployment_document(root: str, name: str) -> tuple[str, str]:
    """Path and text: in the workspace's folder of deployments."""
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.link.workspace_files import modeline

    path = os.path.join(root, "deployments", f"{name.lower()}.ddsl.yaml")
    components = _components(root)
    names = _names(components)
    rows = [row for linked in components for row in _entry(linked, path, names, components)]
    has_topics = any(linked.component.publishes or linked.component.subscribes for linked in components)
    view = DeploymentView(modeline("ddsl", path, root), name, rows, has_topics, bool(components))
    return path, render("new/deployment.ddsl.yaml.j2", view)


def _components(root: str) -> list[LinkedComponent]:
    """The components of a workspace that have no errors, in the order of their paths."""
    from robocomp_yaml.link.documents import Documents
    from robocomp_yaml.link.linker import Linker
    from robocomp_yaml.link.workspace import Search
    from robocomp_yaml.pipeline import search_folders
    from robocomp_yaml.source.discover import of_kind

    program = Linker(Documents(), Search(search_folders(()))).link(of_kind(root, "cdsl"))
    sound = (linked for linked in program.components.values() if not linked.broken)
    return sorted(sound, key=lambda linked: linked.component.path)


def _names(components: Sequence[LinkedComponent]) -> dict[LinkedComponent, str]:
    """A name of its own for each, by what the component is called: SpeechComp is `speech`."""
    names: dict[LinkedComponent, str] = {}
    for linked in components:
        plain = linked.component.name.lower()
        plain = plain.removesuffix(_SUFFIX) or plain
        taken = set(names.values())
        numbered = (f"{plain}{number}" for number in range(2, len(components) + 2))
        names[linked] = plain if plain not in taken else next(n for n in numbered if n not in taken)
    return names


def _entry(
    linked: LinkedComponent, path: str, names: dict[LinkedComponent, str], components: Sequence[LinkedComponent]
) -> Iterator[str]:
    document = os.path.relpath(linked.component.path, os.path.dirname(path))
    yield f"  {names[linked]}:"
    yield f"    component: {document}"
    missing = {} if _has_values(linked) else _required(linked.parameters.parameters)
    if missing:
        from robocomp_yaml.source.yaml_text import flow

        yield f"    set: {flow(missing)}  # examples: these have no default"
    connect = list(_connections(linked, names, components))
    if connect:
        yield "    connect:"
        yield from connect


def _has_values(linked: LinkedComponent) -> bool:
    return os.path.isfile(os.path.join(os.path.dirname(linked.component.path), "etc", "config.yaml"))


def _required(parameters: Parameters) -> dict[str, Any]:
    """A value, for example, of each parameter that needs one."""
    from robocomp_yaml.parameters.examples.fitting import fitted

    found: dict[str, Any] = {}
    for path, value in fitted(parameters).present.items():
        here = found
        for step in path[:-1]:
            here = here.setdefault(step, {})
        here[path[-1]] = value
    return found


def _connections(
    linked: LinkedComponent, names: dict[LinkedComponent, str], components: Sequence[LinkedComponent]
) -> Iterator[str]:
    """What has to be said: who serves it where several do, and where it is where nobody does."""
    for port in linked.requires:
        serving = [other for other in components if other is not linked for p in other.implements if _equal(p, port)]
        if len(serving) == 1:
            continue
        if serving:
            others = ", ".join(dict.fromkeys(names[other] for other in serving[1:]))
            yield f"      {port.name}: {names[serving[0]]}  # or {others}"
        else:
            where = f'"{port.interface.name.lower()}:tcp -h localhost -p 10000"'
            yield f"      {port.name}: {where}  # no component here implements it: where is it?"


def _equal(port: Port, other: Port) -> bool:
    mine, theirs = (port.scope.module.name, port.interface.name), (other.scope.module.name, other.interface.name)
    return mine == theirs
