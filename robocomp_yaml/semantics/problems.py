# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Problems of the values of parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Problem:
    """A problem of one value. `parameter` is its path, `value` the rejected value, `wanted` what it must be, such as a
    range, in its `unit`. `message` is a sentence with all of them."""

    parameter: str
    message: str
    value: str = ""
    wanted: str = ""
    unit: str = ""

    def __str__(self) -> str:
        return self.message


class ParameterError(ValueError):
    """Values were rejected, and no parameter has changed. `problems` has one entry for each rejected value."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(problem.message for problem in problems))
        self.problems = tuple(problems)

    @property
    def parameter(self) -> str:
        """The path of the first rejected value."""
        return self.problems[0].parameter
