"""Changes of components: what they implement, require, publish and subscribe to."""

from __future__ import annotations

import os
from collections.abc import Sequence

from robocomp_yaml.api.editing.changes import ComponentChange
from robocomp_yaml.api.editing.text import EditedText
from robocomp_yaml.api.new.imports import imports_for
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.fix import IMPORT, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.source.spelled import DocumentText

PORT_LISTS = ("implements", "requires", "publishes", "subscribes")


def make(
    change: ComponentChange, edited: EditedText, component: LinkedComponent | None, root: str, include: Sequence[str]
) -> None:
    """Makes a change in the text of a component's document. `root` is the folder of the workspace. Raises Refused and
    NotEditable."""
    key = change.key
    if change.adds:
        known = _known(component)
        for name in change.interfaces:
            if _name(name) in _listed(edited, key):
                raise Refused(f"{edited.path} {key} '{name}' already")
        wanted = [name for name in change.interfaces if _name(name) not in known]
        for text in imports_for(root, edited.path, wanted, include):
            if text not in (edited.data("imports") or ()):
                _import(edited, text)
        for name in change.interfaces:
            edited.append([key], name)
    else:
        for name in change.interfaces:
            listed = _listed(edited, key)
            if _name(name) not in listed:
                raise Refused(f"{edited.path} does not list '{name}' under {key}{meant(name, listed)}")
            edited.remove([key, listed.index(_name(name))])


def document_of(program: Program, name: str) -> str:
    """The document of a component of the workspace: by the component's name, its folder, or the document's path. Raises
    Refused if there is none, or more than one."""
    real = os.path.realpath(name)
    known = {path: linked.component for path, linked in program.components.items()}
    by_path = [one.path for path, one in known.items() if real in (path, os.path.dirname(path))]
    found = by_path or [one.path for one in known.values() if one.name == name]
    if len(found) != 1:
        several = f": {', '.join(found)}" if found else meant(name, [one.name for one in known.values()])
        raise Refused(f"{'several components are' if found else 'unknown component'} '{name}'{several}")
    return found[0]


def _import(edited: EditedText, name: str) -> None:
    document = DocumentText(edited.path, edited.text)
    made = document.spelled(Edit(Span(edited.path), name, IMPORT))
    if made:
        (one,) = made
        edited.insert(document.index(one.span.line, one.span.column), one.text, ["imports"], name)
    else:
        edited.append(["imports"], name)


def _known(component: LinkedComponent | None) -> set[str]:
    """The interfaces and topics that the component's imports define."""
    modules = component.modules() if component is not None else []
    return {one.name for linked in modules for one in linked.module.all_interfaces}


def _listed(edited: EditedText, key: str) -> list[str]:
    """The names of a component's ports below a key."""
    items = edited.data(key) or []
    return [next(iter(item), "") if isinstance(item, dict) else _name(str(item)) for item in items]


def _name(interface: str) -> str:
    return interface.rpartition(".")[2]
