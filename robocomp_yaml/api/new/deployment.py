"""The document that `rcyaml new deployment` writes: each component of the workspace, once."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any

from robocomp_yaml.addresses.interface_comparison import Implementers
from robocomp_yaml.api.new.documents import NewDocument, free, require_name
from robocomp_yaml.api.which import VALUES
from robocomp_yaml.emit.render import render
from robocomp_yaml.link.documents import Documents
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import ImportSearch, Workspaces
from robocomp_yaml.link.workspace_files import modeline
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.pipeline import search_folders
from robocomp_yaml.source.discover import of_kind
from robocomp_yaml.source.yaml_text import flow

_SUFFIX = "comp"


def deployment_document(root: str, name: str) -> NewDocument:
    """The document, in the workspace's folder of deployments. Raises Refused if the name is not possible, or the
    document exists."""
    require_name(name)
    path = free(os.path.join(root, "deployments", f"{name.lower()}.ddsl.yaml"))
    components = _components(root)
    names = _names(components)
    implementers = Implementers()
    for linked in components:
        implementers.add(linked)
    rows = [row for linked in components for row in _entry(linked, path, names, implementers)]
    has_topics = any(linked.component.publishes or linked.component.subscribes for linked in components)
    text = render(
        "new/deployment.ddsl.yaml.j2", modeline=modeline("ddsl", path, root), name=name, rows=rows,
        has_topics=has_topics, has_components=bool(components),
    )  # fmt: skip
    return NewDocument(path, text)


def _components(root: str) -> list[LinkedComponent]:
    """The components of a workspace that have no errors, sorted by path."""
    program = Linker(Documents(), ImportSearch(search_folders(())), Workspaces()).link(of_kind(root, "cdsl"))
    sound = (linked for linked in program.components.values() if not linked.broken)
    return sorted(sound, key=lambda linked: linked.component.path)


def _names(components: Sequence[LinkedComponent]) -> dict[LinkedComponent, str]:
    """A unique name for each component, from its own name: `speech` for SpeechComp."""
    names: dict[LinkedComponent, str] = {}
    for linked in components:
        plain = linked.component.name.lower()
        plain = plain.removesuffix(_SUFFIX) or plain
        taken = set(names.values())
        numbered = (f"{plain}{number}" for number in range(2, len(components) + 2))
        names[linked] = plain if plain not in taken else next(n for n in numbered if n not in taken)
    return names


def _entry(
    linked: LinkedComponent, path: str, names: dict[LinkedComponent, str], implementers: Implementers
) -> Iterator[str]:
    document = os.path.relpath(linked.component.path, os.path.dirname(path))
    yield f"  {names[linked]}:"
    yield f"    component: {document}"
    values = os.path.join(os.path.dirname(linked.component.path), VALUES)
    missing = {} if os.path.isfile(values) else _required(linked.parameters.parameters)
    if missing:
        yield f"    set: {flow(missing)}  # examples: these have no default"
    connect = list(_connections(linked, names, implementers))
    if connect:
        yield "    connect:"
        yield from connect


def _required(parameters: Parameters) -> dict[str, Any]:
    """An example of a value for each parameter that requires one."""
    from robocomp_yaml.parameters.examples.fitting import fitted

    found: dict[str, Any] = {}
    for path, value in fitted(parameters).present.items():
        node = found
        for step in path[:-1]:
            node = node.setdefault(step, {})
        node[path[-1]] = value
    return found


def _connections(
    linked: LinkedComponent, names: dict[LinkedComponent, str], implementers: Implementers
) -> Iterator[str]:
    """The connections that do not follow from the documents: which of several servers to use. `check` reports an
    interface that nobody serves."""
    for port in linked.requires:
        serving = [other for other, _ in implementers.of(port, besides=linked)]
        if len(serving) > 1:
            others = ", ".join(dict.fromkeys(names[other] for other in serving[1:]))
            yield f"      {port.name}: {names[serving[0]]}  # or {others}"
