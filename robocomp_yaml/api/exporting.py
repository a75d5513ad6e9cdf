"""The files with which another tool runs a network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from robocomp_yaml.api.refusals import cannot_write, require
from robocomp_yaml.deploy import exported
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.emit import exports
from robocomp_yaml.network.network import Network
from robocomp_yaml.plugins import Plugins


def export(
    network: Network, form: str, plugins: Plugins, *, reveal: bool
) -> tuple[dict[str, str], Sequence[Diagnostic]]:
    """The files by path, and diagnostics. Raises Refused if the format is unknown."""
    require("export format", form, exports.forms(plugins))
    try:
        return exported.files(network, form, plugins, reveal=reveal)
    except Faulty as error:  # a plug-in failed
        return {}, error.diagnostics


def write(output: str, files: Mapping[str, str]) -> Sequence[Diagnostic]:
    """Writes the files below a folder, unless one is in the way, which is reported. Raises Refused if a file cannot be
    written."""
    try:
        diagnostics = exported.conflicts(output, files)
        if not has_errors(diagnostics):
            exported.write(output, files)
    except OSError as error:
        raise cannot_write(error.filename or output, error) from error
    return diagnostics
