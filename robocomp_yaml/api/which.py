"""Which document an argument means: by its path, its folder or the name of its component; without an argument, the only
one. The functions raise Refused if no document is meant, or more than one."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, NoReturn

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.link.flat_configs import FLAT
from robocomp_yaml.source.discover import kind_of, of_kind
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import component_in

if TYPE_CHECKING:
    from robocomp_yaml.deploy.registered import RegisteredDeployment
    from robocomp_yaml.link.component_references import References
    from robocomp_yaml.pipeline import Analysis

VALUES = os.path.join("etc", "config.yaml")


def component(argument: str) -> str:
    """The document of a component, or of parameters without one."""
    if os.path.isdir(argument or "."):
        return _of_folder(argument)
    if kind_of(argument) in ("cdsl", "pdsl") and os.path.isfile(argument):
        return argument
    if os.path.lexists(argument) or os.path.basename(argument) != argument or argument.endswith((".yaml", ".yml")):
        if not os.path.lexists(argument):
            problem = "does not exist"
        elif kind_of(argument) == "ddsl":
            problem = "is a deployment; name one of its components, or a folder"
        else:
            problem = "is not a document of a component"
        raise Refused(f"'{argument}' {problem}")
    return _named(argument)


def values(argument: str, *, has_flat: bool = False) -> str:
    """The values document: the argument itself, or that of the component that it means; with `has_flat`, the flat
    `etc/config` of a component without such a document."""
    if os.path.isfile(argument) and kind_of(argument) not in ("cdsl", "pdsl"):
        return argument
    if os.path.basename(argument) == "config.yaml" or argument.endswith(".config.yaml"):
        raise Refused(f"'{argument}' does not exist")
    document = component(argument)
    path = os.path.normpath(os.path.join(os.path.dirname(document), VALUES))
    flat = os.path.normpath(os.path.join(os.path.dirname(document), FLAT))
    if not os.path.isfile(path) and has_flat and os.path.isfile(flat):
        return flat
    if not os.path.isfile(path):
        raise Refused(f"{path} does not exist yet: `rcyaml config new {document}` writes it")
    return path


def _of_folder(folder: str) -> str:
    """The component of a folder: the only one in it, or else the only one below it."""
    beside = _references().beside
    nearest = (beside(folder, "cdsl"), beside(folder, "pdsl"), of_kind(folder, "cdsl"), of_kind(folder, "pdsl"))
    several = f"'{folder}' has several components" if folder else "this folder has several components"
    return _only(nearest, several) or _refuse(no_component("" if os.path.normpath(folder) == "." else folder))


def _references() -> References:
    from robocomp_yaml.link.component_references import References  # deployments are found without

    return References(Disk())


def no_component(folder: str = "") -> str:
    """The message that a folder has no component; '' is the working folder."""
    where = f"'{folder}'" if folder else "this folder"
    return f"{where} has no component; `rcyaml new component NAME` writes one"


def _only(nearest: Iterable[list[str]], several: str) -> str | None:
    """The only element of the first list that has one; None if all lists are empty. Raises Refused if it has more."""
    found = next(filter(None, nearest), [])
    if len(found) > 1:
        raise Refused(f"{several}: {some(found, 10)}; name one of them")
    return found[0] if found else None


def _refuse(message: str) -> NoReturn:
    raise Refused(message)


def _named(name: str) -> str:
    """The component of this workspace with this name. The name of its document or folder is accepted too, in any
    case."""
    from robocomp_yaml.link.component_references import stem
    from robocomp_yaml.link.workspace import root_above

    root = root_above("") or "."
    names = {
        path: (component_in(path), stem(path), os.path.basename(os.path.dirname(path)))
        for path in of_kind(root, "cdsl")
    }
    same = [path for path, known in names.items() if name in known]
    alike = [path for path, known in names.items() if name.lower() in map(str.lower, known)]
    components = [called for called, *_ in names.values() if called]
    return _only((same, alike), f"several components have the name '{name}'") or _refuse(
        f"unknown component '{name}'{meant(name, components, _others(components))}"
    )


def _others(components: list[str]) -> str:
    return f"known are {some(sorted(components), 8)}" if components else no_component()


def component_near(values_document: str) -> str:
    """The only component beside a values document, or one folder up."""
    folder = os.path.dirname(values_document)
    folders = (folder, os.path.normpath(os.path.join(folder, os.pardir)))
    nearest = (_references().beside(where, kind) for where in folders for kind in ("cdsl", "pdsl"))
    return _only(nearest, "this folder has several components") or _refuse(
        f"{values_document} has no component beside it, nor one folder up"
    )


def deployment(path: str, include: tuple[str, ...]) -> str:
    """The document of the deployment that a path means."""
    from robocomp_yaml.deploy import registered

    if not os.path.isdir(path) or registered.of_folder(path):
        return path
    found = deployments_of(path, include) or _running_below(path, registered.every())
    if not found:
        what = "this folder" if os.path.normpath(path) == "." else f"'{path}'"
        raise Refused(f"{what} has no deployment document: `rcyaml new deployment NAME` writes one")
    return only_deployment(found)


def root_around(document: str) -> str:
    """The folder whose documents are read beside a deployment ('': there is none): the workspace of the working folder,
    else that of the deployment. Any other working folder can have a hundred thousand folders below it."""
    from robocomp_yaml.link.workspace import root_above

    beside = os.path.dirname(document)
    return root_above("") or (root_above(beside) or beside if document else "") or "."


def _running_below(folder: str, running: Iterable[RegisteredDeployment]) -> list[str]:
    """The documents below a folder whose deployments run, though they are gone."""
    top = os.path.realpath(folder)
    documents = [one.document for one in running if os.path.commonpath([top, os.path.realpath(one.document)]) == top]
    return [os.path.relpath(path) for path in documents]


def only_deployment(found: list[str]) -> str:
    """The only one of these deployments. Raises Refused if there are more."""
    if len(found) > 1:
        names = ", ".join(sorted(found))
        raise Refused(f"there are several deployments: {names}; name one of them")
    return found[0]


def deployments_of(folder: str, include: tuple[str, ...] = (), analysis: Analysis | None = None) -> list[str]:
    """The deployments in a folder, or else below it, without those that another one includes. `analysis` is that of the
    folder, if there is one."""
    below, own_folder = of_kind(folder, "ddsl"), os.path.normpath(folder)
    found = [path for path in below if (os.path.dirname(path) or ".") == own_folder] or below
    if len(found) < 2:
        return found
    if analysis is None:
        from robocomp_yaml.pipeline import analyse

        analysis = analyse(found, include)
    parts = {real for real, linked in analysis.program.deployments.items() if linked.is_included}
    return [path for path in found if os.path.realpath(path) not in parts] or found
