"""Constraints as Java."""

from __future__ import annotations

from robocomp_yaml.emit.lowering.constraints import Calls
from robocomp_yaml.languages.java.text import literal, value
from robocomp_yaml.parameters.specification.expression import Expression
from robocomp_yaml.parameters.types import RecordType


def lambda_of(expression: Expression, root: RecordType) -> str:
    """A lambda with the parameters' values as its argument `p`."""
    return f"p -> {CALLS.of(expression, root)}"


CALLS = Calls(
    prefix="Expressions.",
    value=value,
    text=literal,
    sign=lambda sign: f"'{sign}'",
    listing=lambda items: f"java.util.Arrays.<Object>asList({', '.join(items)})",
    pairs=lambda pairs: ", ".join(f"{sign}, {part}" for sign, part in pairs),
    later=lambda code: f"() -> {code}",
    parts=", ".join,
    function=lambda variable, body: f"{variable} -> {body}",
    member=lambda owner, key: f"Expressions.member({owner}, {key})",
    variable=lambda name, depth: f"{name}{depth}",  # a lambda's parameter cannot hide another
)
