"""Methods: what each may throw, and how often it may say so."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import removal
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.model.interface import Method, TypeRef


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        for interface in linked.module.all_interfaces:
            for method in interface.methods:
                if len(method.throws) > 1:
                    yield from _thrown_once(linked, method)


def _thrown_once(linked: LinkedModule, method: Method) -> Iterator[Diagnostic]:
    """`Other.Failed` and `RoboCompOther.Failed` are the same exception."""
    first: dict[object, TypeRef] = {}
    for ref in method.throws:
        found = linked.find(ref)
        other = first.setdefault((found[0], found[1].name) if found else ref.text, ref)
        if other is not ref:
            yield codes.THROWN_TWICE.at(
                ref.span,
                method=method.name,
                name=ref.text,
                hint="remove one of them",
                related=[Related("it stands here first", other.span)],
                fixes=[removal(ref.span)],
            )
