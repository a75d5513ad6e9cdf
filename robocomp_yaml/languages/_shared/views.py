"""Views that the languages share, and files that are the same in several of them."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from robocomp_yaml.emit.render import View
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.transactions.plan import ONCE, FilePlan


class PortViews(msgspec.Struct, frozen=True):
    """All ports of a component, as views of its language: `accessors` are the proxies of the worker, `services` the
    implemented and subscribed ports."""

    requires: list[View]
    publishes: list[View]
    implements: list[View]
    subscribes: list[View]

    @property
    def accessors(self) -> list[View]:
        return [*self.requires, *self.publishes]

    @property
    def services(self) -> list[View]:
        return [*self.implements, *self.subscribes]


def constraint_views(parameters: Parameters, language: TargetLanguage, literal: Callable[[str], str]) -> list[View]:
    """The constraints of parameters: each with its text, the message if it does not hold, and the code that checks it.
    `literal` makes a literal of a text."""
    if not parameters.constraints:  # most components have none, and need nothing of expressions
        return []
    lambda_of = language.part("constraints").lambda_of
    return [
        View(
            text=literal(each.text), otherwise=literal(each.message), value=lambda_of(each.expression, parameters.root)
        )
        for each in parameters.constraints
    ]


def ignored_program(name: str) -> FilePlan:
    """`bin/.gitignore`: a build makes the program, so that it is not part of the repository."""
    head = "# This file is yours: rcyaml wrote it once. Below is what the build makes."
    return FilePlan("bin/.gitignore", f"{head}\n/{name}\n", ONCE)
