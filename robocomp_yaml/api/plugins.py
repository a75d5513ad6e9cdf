"""The library for plug-ins: everything that their modules import from rcyaml. See docs/plugins.md.

The names in `__all__` keep their meaning as those of `robocomp_yaml.api` do. Each is imported when it is used, so that
a module that is loaded for every check costs only what it uses.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.diag.code import Code, Family
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Edit, Fix, Hint, removal, replacing
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.registry import lazy_attributes

if TYPE_CHECKING:
    from robocomp_yaml.emit.exports import Unwritable
    from robocomp_yaml.emit.graphs.picture import Picture
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.languages.record import TargetLanguage
    from robocomp_yaml.legacy.document import List, Map, Notes, Raw
    from robocomp_yaml.legacy.draft import (
        ComponentDraft,
        DeploymentDraft,
        ModuleDraft,
        ModuleNames,
        ParametersDraft,
        Reader,
        ValuesDraft,
    )
    from robocomp_yaml.legacy.grammar import token, trees
    from robocomp_yaml.link.program import LinkedComponent, Program
    from robocomp_yaml.network.network import Network
    from robocomp_yaml.transactions.plan import FilePlan

__all__ = [
    "Code", "ComponentDraft", "DeploymentDraft", "Diagnostic", "Edit", "Family", "FilePlan", "Fix", "Hint",
    "LinkedComponent", "List", "Map", "ModuleDraft", "ModuleNames", "Network", "Notes", "ParametersDraft", "Picture",
    "Program", "Raw", "Reader", "Related", "Span", "TargetLanguage", "Unwritable", "ValuesDraft", "did_you_mean",
    "removal", "render", "replacing", "token", "trees",
]  # fmt: skip

__getattr__ = lazy_attributes(__name__, {
    "emit.exports": "Unwritable", "emit.graphs.picture": "Picture", "emit.render": "render",
    "languages.record": "TargetLanguage", "legacy.document": "List Map Notes Raw",
    "legacy.draft": "ComponentDraft DeploymentDraft ModuleDraft ModuleNames ParametersDraft Reader ValuesDraft",
    "legacy.grammar": "token trees", "link.program": "LinkedComponent Program", "network.network": "Network",
    "transactions.plan": "FilePlan",
})  # fmt: skip
