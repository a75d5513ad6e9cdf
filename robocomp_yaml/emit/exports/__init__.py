"""A network in the words of other tools: one module a form, each with `export(network) -> {relative path: text}`.

Texts that hold a configuration may hold what nobody else should read, as `Network` says of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._unwritable import Unwritable as Unwritable
from robocomp_yaml.emit.exports._unwritable import noted as noted
from robocomp_yaml.registry import Modules

if TYPE_CHECKING:
    from robocomp_yaml.network.network import Network

EXPORTS = Modules(__name__, "form")


def forms() -> list[str]:
    """What `export` can make."""
    return [*EXPORTS.table()]


def export(network: Network, form: str) -> dict[str, str]:
    """The files that another tool runs the network from, by their relative paths; `form` is one of `forms()`. Raises
    Unwritable where the form cannot say what the network has; what is only written otherwise is `noted`."""
    made = EXPORTS.load(form)
    with _unwritable.of(network):
        files: dict[str, str] = made.export(network)
    return files
