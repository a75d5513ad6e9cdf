"""Literal values in code that cannot be right: compared with what never equals them, or passed to what rejects them."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.emit.usage.code import Chain, Constant
from robocomp_yaml.emit.usage.kinds import wanted
from robocomp_yaml.emit.usage.offer import PLAIN, Offer, OfferedMember
from robocomp_yaml.emit.usage.values import rejected, type_of_setting
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import BasicType, EnumType, Type
from robocomp_yaml.parameters.words import in_words


def never_equal(
    chain: Chain, member: OfferedMember | None, now: Offer | None, *, integers: bool
) -> Iterator[Diagnostic]:  # fmt: skip
    """Comparisons of a parameter, or of a member of a struct, that are always false. With `integers`, an enumerator
    never equals one."""
    for constant in chain.compared:
        name = next((step.word.text for step in reversed(chain.steps) if step.word.text), "")
        parameter = (member.read or member.parameter) if member is not None else None
        if member is not None and parameter is not None:
            yield from _of_parameter(parameter.type, member.path or parameter.name, constant)
        elif now is not None and now.kind == PLAIN and (needed := wanted(now.name, constant.value, integers=integers)):
            yield codes.NEVER_EQUAL.at(constant.span, name=name, value=repr(constant.value), wanted=needed)


def of_setting(linked: LinkedComponent, chain: Chain) -> Iterator[Diagnostic]:
    """Comparisons of a property that RoboComp's code reads. Its value may be a text or not, so only texts count."""
    key = ".".join(step.word.text for step in chain.steps)
    type_ = type_of_setting(linked, key)
    is_text = isinstance(type_, EnumType) or (isinstance(type_, BasicType) and type_.name == "string")
    for constant in chain.compared if is_text and type_ is not None else ():
        if isinstance(constant.value, str):
            yield from _of_parameter(type_, key, constant)


def _of_parameter(type_: Type | None, path: str, constant: Constant) -> Iterator[Diagnostic]:
    if constant.value != "" and rejected(type_, constant.value):  # '' may mean: not set
        allowed = type_.allowed if isinstance(type_, EnumType) else ()
        if isinstance(type_, BasicType):
            allowed = tuple(str(one.value) for one in type_.values)
        needed = in_words(type_)  # type: ignore[arg-type]
        hint = did_you_mean(str(constant.value), allowed)
        yield codes.NEVER_EQUAL.at(
            constant.span, name=path, value=repr(constant.value), wanted=needed, hint=hint.text
        )  # fmt: skip
