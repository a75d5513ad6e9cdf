"""The document that `rcyaml new parameters` writes, and where it goes."""

from __future__ import annotations

import os

import msgspec

from robocomp_yaml.diag.errors import Refused


class ParametersView(msgspec.Struct, frozen=True):
    modeline: str
    component: str


def parameters_document(root: str, name: str) -> tuple[str, str]:
    """Path and text: beside the component `name` of the workspace; where there is none, where it would be."""
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.link.workspace_files import modeline

    found = _component(root, name)
    if found is None:
        path = os.path.join(root, "components", name.lower(), f"{name.lower()}.pdsl.yaml")
        component = name
    else:
        component = os.path.basename(found)
        path = os.path.join(os.path.dirname(found), component.replace("cdsl.yaml", "pdsl.yaml"))
    return path, render("new/parameters.pdsl.yaml.j2", ParametersView(modeline("pdsl", path, root), component))


def _component(root: str, name: str) -> str | None:
    """The component document of this name, by what the component is called or by its file. Where there is none, it is
    still to come; unless one that has no parameters yet is called nearly so."""
    from robocomp_yaml.diag.suggest import suggest
    from robocomp_yaml.link.documents import Documents
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.source.discover import of_kind

    documents = Documents()
    found: list[tuple[str, bool]] = []
    without: list[str] = []
    for path in of_kind(root, "cdsl"):
        model = documents.get(path).model
        called = model.name if isinstance(model, Component) else ""
        stem = os.path.basename(path).removesuffix(".cdsl.yaml")
        names_parameters = isinstance(model, Component) and bool(model.parameters)
        if name.lower() in (called.lower(), stem.lower()):
            found.append((path, names_parameters))
        elif not names_parameters and not of_kind(os.path.dirname(path) or ".", "pdsl"):
            without += [called, stem]
    if len(found) > 1:
        shown = ", ".join(path for path, _ in found)
        raise Refused(f"several components are called '{name}': {shown}")
    if found and found[0][1]:
        raise Refused(f"{found[0][0]} names its parameters' document already")
    meant = None if found else suggest(name, filter(None, without))
    if meant:
        raise Refused(
            f"there is no component '{name}'; did you mean '{meant}'? Else `rcyaml new component {name}` comes first"
        )
    return found[0][0] if found else None
