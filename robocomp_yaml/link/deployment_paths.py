"""Resolves the paths in a deployment's document. Results are relative to the current folder, or absolute."""

from __future__ import annotations

import os

from robocomp_yaml.model.deployment import COMPONENT, Deployment, Entry
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.file_names import is_deployment

COMPONENT_SUFFIXES = (".cdsl.yaml", os.sep + "cdsl.yaml")


def joined(folder: str, text: str) -> str:
    """A path relative to `folder`; `~` is the operator's home folder, as in launchers."""
    return os.path.normpath(os.path.join(folder, os.path.expanduser(text)))


def document_folder(deployment: Deployment) -> str:
    return os.path.dirname(deployment.path)


def component_paths(deployment: Deployment, text: str, disk: Disk) -> list[str]:
    """The component document at a path, or all component documents in a folder; none if there is none."""
    path = joined(document_folder(deployment), text)
    return disk.once(("component", path), lambda: _components_at(path, disk))


def _components_at(path: str, disk: Disk) -> list[str]:
    if disk.has_folder(path):
        names = (name for name in disk.documents(path) if name == "cdsl.yaml" or name.endswith(".cdsl.yaml"))
        return [os.path.join(path, name) for name in names]
    is_component = disk.has_file(path) and f"{os.sep}{path}".endswith(COMPONENT_SUFFIXES)
    return [path] if is_component else []


def entry_folder(deployment: Deployment, entry: Entry, component: str) -> str:
    """The folder to which an entry's paths are relative: that of its component document, or the `cwd` of a program."""
    if entry.kind == COMPONENT:
        return os.path.dirname(component)
    return joined(document_folder(deployment), entry.cwd.text if entry.cwd else "")


def config_paths(deployment: Deployment, folder: str, text: str) -> tuple[str, str]:
    """The paths where a configuration may be: from the entry's folder, then from that of the deployment."""
    return joined(folder, text), joined(document_folder(deployment), text)


def default_config(folder: str) -> str:
    """The values document of a component in a folder, which its entries use if they name no other configuration."""
    return joined(folder, os.path.join("etc", "config.yaml"))


def is_values(path: str) -> bool:
    """Whether a configuration is a values document, not a flat config."""
    name = os.path.basename(path)
    return name == "config.yaml" or name.endswith(".config.yaml")


def include_path(deployment: Deployment, text: str, disk: Disk) -> str | None:
    """The path of an included deployment; None if it is not a deployment document."""
    path = joined(document_folder(deployment), text)
    return path if disk.has_file(path) and is_deployment(path) else None
