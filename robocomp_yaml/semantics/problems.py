# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""What is wrong with values of parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Problem:
    """One value that cannot be: `parameter` is its path, `value` what it was to be, `wanted` what it must be (its
    range, say) in its `unit`; `message` says it all."""

    parameter: str
    message: str
    value: str = ""
    wanted: str = ""
    unit: str = ""

    def __str__(self) -> str:
        return self.message


class ParameterError(ValueError):
    """Values that parameters cannot have: nothing has changed. `problems` are all of them."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(problem.message for problem in problems))
        self.problems = tuple(problems)

    @property
    def parameter(self) -> str:
        """The path of the first one."""
        return self.problems[0].parameter
