"""What checks of names ask about the components of a language."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from robocomp_yaml.diag.diagnostic import Related
from robocomp_yaml.emit.lowering.types import results
from robocomp_yaml.grouping import grouped
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.model.interface import Interface, Method


def users(program: Program, language: TargetLanguage) -> Mapping[LinkedModule, list[LinkedComponent]]:
    """The components in a language, by each module that they need; an empty list for every other module."""
    own = [one for one in program.components.values() if one.component.language.target is language]
    return defaultdict(list, grouped((scope, one) for one in own for scope in one.modules()))


def needed_by(user: LinkedComponent) -> Related:
    """The component that needs a module, for a diagnostic about the module."""
    component = user.component
    return Related(
        f"component {component.name} is in {component.language.target.title}, and needs it", component.language.span
    )


def result_structs(interface: Interface) -> dict[str, Method]:
    """The methods that return several values, by the name of the struct that Ice makes of them."""
    return {f"{m.name[:1].upper()}{m.name[1:]}Result": m for m in interface.methods if len(results(m)) > 1}
