"""A network in the words of other tools: one module a form, each with `export(network) -> {relative path: text}`.

Texts that hold a configuration may hold what nobody else should read, as `Network` says of it.
"""

from __future__ import annotations

import os
from collections.abc import Collection
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
    return OWN.table().keys()


def forms(plugins: Plugins = NONE) -> list[str]:
    """What `export` can make."""
    return [*built_in(), *sorted(plugins.of(EXPORTS))]


def export(network: Network, form: str, plugins: Plugins = NONE) -> dict[str, str]:
    """The files that another tool runs the network from, by their relative paths; `form` is one of `forms()`. Raises
    Unwritable where the form cannot say what the network has; what is only written otherwise is `noted`."""
    if form in plugins.of(EXPORTS):
        with _unwritable.of(network):
            return _of_plugin(network, form, *plugins.of(EXPORTS)[form])
    made = OWN.load(form)
    with _unwritable.of(network):
        files: dict[str, str] = made.export(network)
    return files


def _of_plugin(network: Network, form: str, plugin: Plugin, module: ModuleType) -> dict[str, str]:
    with plugin.guarded(f"export '{form}'", Unwritable):
        files = module.export(network)
        if not isinstance(files, dict) or not all(isinstance(each, str) for item in files.items() for each in item):
            raise TypeError("it gives no texts by their paths")
        for path in files:
            if os.path.isabs(path) or os.path.normpath(path).split(os.sep)[0] in (os.pardir, os.curdir):
                raise ValueError(f"'{path}' is no path of a file below a folder")
    return files
