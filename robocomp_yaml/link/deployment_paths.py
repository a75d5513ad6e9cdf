"""Where the paths of a deployment's document lead: each as opened, from the document's own folder or another."""

from __future__ import annotations

import os

from robocomp_yaml.model.deployment import COMPONENT, Deployment, Entry
from robocomp_yaml.source.disk import Disk

COMPONENT_SUFFIXES = (".cdsl.yaml", os.sep + "cdsl.yaml")


def joined(folder: str, text: str) -> str:
    """`~` is the caller's home, as launchers have it."""
    return os.path.normpath(os.path.join(folder, os.path.expanduser(text)))


def document_folder(deployment: Deployment) -> str:
    return os.path.dirname(deployment.path)


def component_paths(deployment: Deployment, text: str, disk: Disk) -> list[str]:
    """The component's document at a path, or those in a folder; none where there is nothing of the kind."""
    path = joined(document_folder(deployment), text)
    if disk.has_folder(path):
        names = (name for name in disk.documents(path) if name == "cdsl.yaml" or name.endswith(".cdsl.yaml"))
        return [os.path.join(path, name) for name in names]
    is_component = disk.has_file(path) and f"{os.sep}{path}".endswith(COMPONENT_SUFFIXES)
    return [path] if is_component else []


def entry_folder(deployment: Deployment, entry: Entry, component: str) -> str:
    """The folder that an entry's own paths start from: that of its component's document, or where a program runs."""
    if entry.kind == COMPONENT:
        return os.path.dirname(component)
    return joined(document_folder(deployment), entry.cwd.text if entry.cwd else "")


def config_paths(deployment: Deployment, place: str, text: str) -> tuple[str, str]:
    """Where a configuration is looked for: from the entry's folder, then from the deployment's document."""
    return joined(place, text), joined(document_folder(deployment), text)


def is_values(path: str) -> bool:
    """Whether a configuration is a values document, and no flat file."""
    name = os.path.basename(path)
    return name == "config.yaml" or name.endswith(".config.yaml")


def include_path(deployment: Deployment, text: str, disk: Disk) -> str | None:
    path = joined(document_folder(deployment), text)
    name = os.path.basename(path)
    is_deployment = name == "ddsl.yaml" or name.endswith(".ddsl.yaml")
    return path if disk.has_file(path) and is_deployment else None
