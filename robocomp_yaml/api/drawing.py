"""Which picture is meant: that of a deployment, else that of the components of a folder."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from robocomp_yaml.api.deployments import deployments_of, one_of
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.source.discover import kind_of

if TYPE_CHECKING:
    from robocomp_yaml.emit.graphs.picture import Picture
    from robocomp_yaml.pipeline import Analysis


def draw(analysis: Analysis, form: str, path: str) -> str:
    """The picture of what is at a path, in a form."""
    from robocomp_yaml.emit.graphs.forms import draw, forms

    inside = os.path.join(path, "") if os.path.isdir(path) else path  # as a document, whose workspace decides
    plugins = analysis.linker.workspace_of(inside).plugins
    if form not in forms(plugins):
        raise Refused(f"there is no picture '{form}'; there are {', '.join(forms(plugins))}")
    made = _picture(path, analysis)
    if made is None:
        raise Faulty(analysis.diagnostics, analysis.program.documents)
    return draw(made, form, plugins)


def _picture(path: str, analysis: Analysis) -> Picture | None:
    """None where the document, or everything in the folder, is too broken to show."""
    from robocomp_yaml.emit.graphs import of_components, of_network

    if not os.path.isdir(path):
        network = analysis.networks.get(os.path.realpath(path))
        if network is None and kind_of(path) != "ddsl":
            raise Refused(f"'{path}' is no deployment document (NAME.ddsl.yaml), and no folder")
        return of_network.picture_of(network, analysis.diagnostics) if network is not None else None
    readable = [one for one in deployments_of(path, analysis=analysis) if os.path.realpath(one) in analysis.networks]
    if readable:
        return of_network.picture_of(analysis.networks[os.path.realpath(one_of(readable))], analysis.diagnostics)
    if analysis.program.deployments or not analysis.program.components:
        return None
    name = os.path.basename(os.path.abspath(path))
    return of_components.picture_of(name, analysis.program.components.values())
