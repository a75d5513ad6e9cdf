"""A network in the words of other tools: one module a form, each with `export(network) -> {relative path: text}`.

Texts that hold a configuration may hold what nobody else should read, as `Network` says of it.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._unwritable import Unwritable as Unwritable
from robocomp_yaml.emit.exports._unwritable import noted as noted

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network


def forms() -> list[str]:
    """What `export` can make."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_"))


def export(network: Network, form: str) -> dict[str, str]:
    """The files that another tool runs the network from, by their relative paths; `form` is one of `forms()`. Raises
    Unwritable where the form cannot say what the network has; what is only written otherwise is `noted`."""
    if form not in forms():
        raise ValueError(f"there is no form '{form}'")
    with _unwritable.of(network):
        files: dict[str, str] = importlib.import_module(f"{__name__}.{form}").export(network)
    return files
