"""Which document is meant: by its path, its folder or the component's name, or without a word where there is only
one. All of these raise Refused where none is meant, or several are."""

from __future__ import annotations

import os
from collections.abc import Callable

from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.link.component_references import References, stem
from robocomp_yaml.source.discover import kind_of, of_kind
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import component_in

VALUES = os.path.join("etc", "config.yaml")


def component(said: str) -> str:
    """The document of a component, or of parameters without one."""
    if os.path.isdir(said or "."):
        return _of_folder(said)
    if kind_of(said) in ("cdsl", "pdsl") and os.path.isfile(said):
        return said
    if os.path.lexists(said) or os.path.basename(said) != said or said.endswith((".yaml", ".yml")):
        raise Refused(
            f"'{said}' is no component's document" if os.path.lexists(said) else f"there is no document {said}"
        )
    return _named(said)


def values(said: str) -> str:
    """A values document: itself, or the one of the component that is meant."""
    if os.path.isfile(said) and kind_of(said) not in ("cdsl", "pdsl"):
        return said
    if os.path.basename(said) == "config.yaml" or said.endswith(".config.yaml"):
        raise Refused(f"there is no document {said}")
    document = component(said)
    path = os.path.normpath(os.path.join(os.path.dirname(document), VALUES))
    if not os.path.isfile(path):
        raise Refused(f"there is no {path} yet: `rcyaml config new {document}` writes it")
    return path


def _of_folder(folder: str) -> str:
    """The component of a folder: the only one in it, else the only one below it."""
    beside = References(Disk()).beside
    nearest = (beside(folder, "cdsl"), beside(folder, "pdsl"), of_kind(folder, "cdsl"), of_kind(folder, "pdsl"))
    for found in nearest:
        if len(found) == 1:
            return found[0]
        if found:
            several = "there are several components here" if not folder else f"'{folder}' has several components"
            raise Refused(f"{several}: {_listed(found)}; name one of them")
    raise Refused(f"there is no component {f'in {folder!r}' if folder else 'here'}; "
                           "`rcyaml new component NAME` writes one")  # fmt: skip


def _named(name: str) -> str:
    """The component that is called so in this workspace; its document or its folder may be, and in another case."""
    from robocomp_yaml.link.workspace import root_above

    root = root_above("") or "."
    names = {
        path: (component_in(path), stem(path), os.path.basename(os.path.dirname(path)))
        for path in of_kind(root, "cdsl")
    }
    same: list[Callable[[str], bool]] = [lambda other: other == name, lambda other: other.lower() == name.lower()]
    for is_same in same:
        found = [path for path, known in names.items() if any(map(is_same, known))]
        if len(found) == 1:
            return found[0]
        if found:
            raise Refused(f"several components are called '{name}': {_listed(found)}; name one of them")
    meant = suggest(name, [called for called, *_ in names.values() if called])
    raise Refused(f"there is no component '{name}'" + (f"; did you mean '{meant}'?" if meant else ""))


def _listed(paths: list[str]) -> str:
    return ", ".join(paths[:10]) + (f" and {len(paths) - 10} more" if len(paths) > 10 else "")


def component_near(values_document: str) -> str:
    """The only component beside a values document, or one folder up."""
    folder = os.path.dirname(values_document)
    for where in (folder, os.path.normpath(os.path.join(folder, os.pardir))):
        for kind in ("cdsl", "pdsl"):
            found = References(Disk()).beside(where, kind)
            if len(found) == 1:
                return found[0]
            if found:
                raise Refused(f"there are several components here: {', '.join(found)}; name one of them")
    raise Refused(f"there is no component beside {values_document}, nor one folder up")
