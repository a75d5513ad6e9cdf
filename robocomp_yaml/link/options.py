"""Options of legacy components. The data in `migrate/options/` says what each option adds to a component."""

from __future__ import annotations

from functools import cache

import msgspec
from msgspec.structs import replace

from robocomp_yaml import resources
from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model.build_interface import text, texts
from robocomp_yaml.model.component import LISTS, Component, Use
from robocomp_yaml.model.interface import Import
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.tree import parse


class OptionMeaning(msgspec.Struct, frozen=True):
    """The `imports` and, by list, the interfaces that an option adds; `left` is what the user has to write."""

    imports: tuple[str, ...]
    interfaces: dict[str, tuple[str, ...]]
    left: str


def expanded(component: Component) -> tuple[Component, list[Diagnostic]]:
    """Returns the component with what its options add, without duplicates, and diagnostics about the options."""
    diagnostics: list[Diagnostic] = []
    for option in component.options:
        meaning = meanings().get(option.text.lower())
        if meaning is None:
            others = {other.text.lower() for other in component.options}
            hint = did_you_mean(option.text, meanings(), others, otherwise=f"there are {', '.join(meanings())}")
            diagnostics.append(codes.UNKNOWN_OPTION.at(option.span, name=option.text, hint=hint))
            continue
        component = _with(component, option, meaning)
        if meaning.left:
            diagnostics.append(codes.OPTION_LEFT.at(option.span, name=option.text, left=meaning.left))
    return component, diagnostics


def _with(component: Component, option: Text, meaning: OptionMeaning) -> Component:
    known = {imported.stem.lower() for imported in component.imports}
    imports = tuple(Import(name, span=option.span) for name in meaning.imports if name.lower() not in known)
    lists: dict[str, tuple[Use, ...]] = {}
    for list_, names in meaning.interfaces.items():
        uses: tuple[Use, ...] = getattr(component, list_)
        present = {use.interface.rpartition(".")[2] for use in uses}
        lists[list_] = (*uses, *(Use(name, name, span=option.span) for name in names if name not in present))
    return replace(component, imports=(*component.imports, *imports), **lists)


@cache
def meanings() -> dict[str, OptionMeaning]:
    """The meanings of all options by their names in lower case."""
    names = (name for name in resources.names("migrate/options") if name.endswith(".yaml"))
    return {name.removesuffix(".yaml"): _meaning(resources.text(f"migrate/options/{name}"), name) for name in names}


def _meaning(content: str, name: str) -> OptionMeaning:
    tree, _ = parse(name, content)
    imports, *interfaces = (tuple(str(word) for word in texts(tree, key)) for key in ("imports", *LISTS))
    return OptionMeaning(imports, dict(zip(LISTS, interfaces, strict=True)), text(tree, "left"))
