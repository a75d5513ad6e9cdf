"""Options of legacy components: what each stands for, as data in `migrate/options/`, is added to the component."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import msgspec
from msgspec.structs import replace

from robocomp_yaml import resources
from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model.build_interface import items, text
from robocomp_yaml.model.component import Component, Option, Use
from robocomp_yaml.model.interface import Import
from robocomp_yaml.source.tree import Node, Scalar, parse

_LISTS = ("implements", "requires", "publishes", "subscribes")


class Meaning(msgspec.Struct, frozen=True):
    """`imports` and, by list, interfaces that an option adds; `left` is what it asked for besides."""

    imports: tuple[str, ...]
    interfaces: dict[str, tuple[str, ...]]
    left: str


def expanded(component: Component) -> tuple[Component, list[Diagnostic]]:
    """The component with what its options add. What it has already is not added again."""
    diagnostics: list[Diagnostic] = []
    for option in component.options:
        meaning = _meanings().get(option.name.lower())
        if meaning is None:
            given = {other.name.lower() for other in component.options}
            hint = did_you_mean(option.name, _meanings(), given, otherwise=f"there are {', '.join(_meanings())}")
            diagnostics.append(codes.UNKNOWN_OPTION.at(option.span, name=option.name, hint=hint))
            continue
        component = _with(component, option, meaning)
        if meaning.left:
            diagnostics.append(codes.OPTION_LEFT.at(option.span, name=option.name, left=meaning.left))
    return component, diagnostics


def _with(component: Component, option: Option, meaning: Meaning) -> Component:
    known = {imported.text.rpartition("/")[2].removesuffix(".idsl.yaml").lower() for imported in component.imports}
    imports = tuple(Import(name, span=option.span) for name in meaning.imports if name.lower() not in known)
    lists: dict[str, tuple[Use, ...]] = {}
    for list_, names in meaning.interfaces.items():
        uses: tuple[Use, ...] = getattr(component, list_)
        mine = {use.interface.rpartition(".")[2] for use in uses}
        lists[list_] = (*uses, *(Use(name, name, span=option.span) for name in names if name not in mine))
    return replace(
        component, imports=(*component.imports, *imports), implements=lists["implements"], requires=lists["requires"],
        publishes=lists["publishes"], subscribes=lists["subscribes"],
    )  # fmt: skip


@cache
def _meanings() -> dict[str, Meaning]:
    """The meaning of each option, by its name in lower case."""
    names = (name for name in resources.names("migrate/options") if name.endswith(".yaml"))
    return {name.removesuffix(".yaml"): _meaning(resources.text(f"migrate/options/{name}"), name) for name in names}


def _meaning(content: str, name: str) -> Meaning:
    tree, _ = parse(name, content)
    interfaces = {list_: tuple(_words(tree, list_)) for list_ in _LISTS}
    return Meaning(tuple(_words(tree, "imports")), interfaces, text(tree, "left"))


def _words(tree: Node | None, key: str) -> Iterator[str]:
    yield from (item.lexeme for item in items(tree, key) if isinstance(item, Scalar))
