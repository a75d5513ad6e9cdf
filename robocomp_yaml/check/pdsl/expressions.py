"""Constraints are true or false, and say only what has a meaning."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.parameters.expressions.expression import NotInLanguage
from robocomp_yaml.parameters.expressions.types import check_constraint
from robocomp_yaml.parameters.resolution.limits import inside
from robocomp_yaml.source.tree import Scalar


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        for constraint in linked.parameters.constraints if not linked.broken else ():
            try:
                check_constraint(constraint.expression, linked.parameters.root)
            except NotInLanguage as refused:
                assert isinstance(constraint.node, Scalar)
                yield codes.BAD_EXPRESSION.at(
                    inside(constraint.node, refused.index), problem=str(refused), hint=refused.hint
                )
