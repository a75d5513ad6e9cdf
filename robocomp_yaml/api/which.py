"""Which document is meant: by its path, its folder or the component's name, or without a word where there is only
one. All of these raise Refused where none is meant, or several are."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, NoReturn

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.component_references import References, stem
from robocomp_yaml.source.discover import kind_of, of_kind
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import component_in

if TYPE_CHECKING:
    from robocomp_yaml.pipeline import Analysis

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
    several = f"'{folder}' has several components" if folder else "there are several components here"
    missing = f"there is no component {f'in {folder!r}' if folder else 'here'}"
    return _only(nearest, several) or _refuse(f"{missing}; `rcyaml new component NAME` writes one")


def _only(nearest: Iterable[list[str]], several: str) -> str | None:
    """The only element of the first list that has one; None if all lists are empty. Raises Refused if it has more."""
    found = next(filter(None, nearest), [])
    if len(found) > 1:
        more = f" and {len(found) - 10} more" if len(found) > 10 else ""
        raise Refused(f"{several}: {', '.join(found[:10])}{more}; name one of them")
    return found[0] if found else None


def _refuse(message: str) -> NoReturn:
    raise Refused(message)


def _named(name: str) -> str:
    """The component that is called so in this workspace; its document or its folder may be, and in another case."""
    from robocomp_yaml.link.workspace import root_above

    root = root_above("") or "."
    names = {
        path: (component_in(path), stem(path), os.path.basename(os.path.dirname(path)))
        for path in of_kind(root, "cdsl")
    }
    same = [path for path, known in names.items() if name in known]
    alike = [path for path, known in names.items() if name.lower() in map(str.lower, known)]
    components = [called for called, *_ in names.values() if called]
    return _only((same, alike), f"several components are called '{name}'") or _refuse(
        f"there is no component '{name}'{meant(name, components)}"
    )


def component_near(values_document: str) -> str:
    """The only component beside a values document, or one folder up."""
    folder = os.path.dirname(values_document)
    folders = (folder, os.path.normpath(os.path.join(folder, os.pardir)))
    nearest = (References(Disk()).beside(where, kind) for where in folders for kind in ("cdsl", "pdsl"))
    return _only(nearest, "there are several components here") or _refuse(
        f"there is no component beside {values_document}, nor one folder up"
    )


def deployment(path: str, include: tuple[str, ...]) -> str:
    """The deployment's document that a path means. Raises Refused where a folder has none, or
    several."""
    if not os.path.isdir(path):
        return path
    found = deployments_of(path, include)
    if not found:
        raise Refused(
            f"'{path}' is to have a deployment document; it has none: `rcyaml new deployment NAME` writes one"
        )
    return only_deployment(found)


def only_deployment(found: list[str]) -> str:
    if len(found) > 1:
        names = ", ".join(sorted(found))
        raise Refused(f"there are several deployments here, of which one is to be named: {names}")
    return found[0]


def deployments_of(folder: str, include: tuple[str, ...] = (), analysis: Analysis | None = None) -> list[str]:
    """The deployments of a folder, else those below it; those that others include are parts of these. `analysis` is of
    the folder, where there is one."""
    all_of_them, here = of_kind(folder, "ddsl"), os.path.normpath(folder)
    found = [path for path in all_of_them if (os.path.dirname(path) or ".") == here] or all_of_them
    if len(found) < 2:
        return found
    if analysis is None:
        from robocomp_yaml.pipeline import analyse

        analysis = analyse(found, include)
    parts = {real for real, linked in analysis.program.deployments.items() if linked.is_included}
    return [path for path in found if os.path.realpath(path) not in parts] or found
