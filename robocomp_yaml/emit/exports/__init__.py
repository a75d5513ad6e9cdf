"""Exports of networks for other tools: a module for each form, with `export(network) -> {relative path: text}`.

A text that contains a configuration may contain secrets.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from types import ModuleType
from typing import TYPE_CHECKING

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._unwritable import Unwritable as Unwritable
from robocomp_yaml.emit.exports._unwritable import noted as noted
from robocomp_yaml.plugins import EXPORTS, NONE, Plugin, Plugins
from robocomp_yaml.registry import Modules

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network

OWN = Modules(__name__, "form")


def built_in() -> Collection[str]:
    """The names of the forms that are part of rcyaml."""
    return OWN.table().keys()


def forms(plugins: Plugins = NONE) -> list[str]:
    """The names of all forms, those of plug-ins last."""
    return [*built_in(), *sorted(plugins.of(EXPORTS))]


def export(network: Network, form: str, plugins: Plugins = NONE) -> dict[str, str]:
    """The files with which another tool runs the network, by relative path. `form` is one of `forms()`: ValueError is
    raised for another one. Raises Unwritable if the form cannot express the network; what is only written in another
    way is collected by `noted`."""
    if form in plugins.of(EXPORTS):
        with _unwritable.of(network):
            return _of_plugin(network, form, *plugins.of(EXPORTS)[form])
    module = OWN.load(form)
    with _unwritable.of(network):
        files: dict[str, str] = module.export(network)
    return files


def _of_plugin(network: Network, form: str, plugin: Plugin, module: ModuleType) -> dict[str, str]:
    with plugin.guarded(f"export '{form}'", Unwritable):
        files = module.export(network)
        if not isinstance(files, dict) or not all(isinstance(each, str) for item in files.items() for each in item):
            raise TypeError("it returns no dict of paths and texts")
        _require_files(files)
    return files


def _require_files(files: Mapping[str, str]) -> None:
    """Raises ValueError if a file cannot be written, or not beside the others, so that none is."""
    known: dict[str, str] = {}
    for path, text in files.items():
        real = os.path.normpath(path)
        if os.path.isabs(path) or real.split(os.sep)[0] in (os.pardir, os.curdir) or path.endswith(os.sep):
            raise ValueError(f"'{path}' is not a relative path of a file")
        if "\0" in path or not (_is_encodable(path) and _is_encodable(text)):
            raise ValueError(f"{path!a} has a character that no file can have")
        if real in known:
            raise ValueError(f"'{known[real]}' and '{path}' are the same file")
        known[real] = path
    for real, path in known.items():
        folder = os.path.dirname(real)
        while folder:
            if folder in known:
                raise ValueError(f"'{known[folder]}' is a file, and the folder of '{path}'")
            folder = os.path.dirname(folder)


def _is_encodable(text: str) -> bool:
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        return False
    return True
