"""Views that the languages share, and files that are the same in several of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import msgspec

from robocomp_yaml.emit.lowering.parameters import ConstraintView
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.transactions.plan import ONCE, FilePlan

Accessor = TypeVar("Accessor")
Service = TypeVar("Service")


class PortViews(msgspec.Struct, Generic[Accessor, Service], frozen=True):
    """All ports of a component, as views of its language."""

    requires: list[Accessor]
    publishes: list[Accessor]
    implements: list[Service]
    subscribes: list[Service]

    @property
    def accessors(self) -> list[Accessor]:
        return [*self.requires, *self.publishes]

    @property
    def services(self) -> list[Service]:
        return [*self.implements, *self.subscribes]


def constraint_views(
    parameters: Parameters, language: TargetLanguage, literal: Callable[[str], str]
) -> list[ConstraintView]:
    """The constraints of parameters as code; `literal` makes one of a text."""
    if not parameters.constraints:  # most components have none, and need nothing of expressions
        return []
    lambda_of = language.part("constraints").lambda_of
    return [
        ConstraintView(literal(each.text), literal(each.message), lambda_of(each.expression, parameters.root))
        for each in parameters.constraints
    ]


def ignored_program(name: str) -> FilePlan:
    """`bin/.gitignore`: a build makes the program, so that it is not part of the repository."""
    head = "# This file is yours: rcyaml wrote it once. Below is what the build makes."
    return FilePlan("bin/.gitignore", f"{head}\n/{name}\n", ONCE)
