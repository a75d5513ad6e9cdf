"""Arguments and results of which the code says what they are, and that the method of an interface cannot have."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import (
    LIST,
    MAPPING,
    MODULES,
    NOTHING,
    NUMBER,
    TEXT,
    TRUTH,
    TUPLE,
    Arguments,
    Chain,
    Constant,
    Returned,
    Step,
    Word,
)
from robocomp_yaml.emit.usage.kinds import Kind, instead_of, of_basic, unfit
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.model.interface import Member
from robocomp_yaml.parameters.types import BasicType, EnumType

_Wrong = tuple[Span, str, str]
"""Where something is, what it is, and what is expected instead."""


def wrong_arguments(
    owner: str, inputs: tuple[Member, ...], kinds: tuple[Kind | None, ...], arguments: Arguments, worker: WorkerOffer
) -> Iterator[Diagnostic]:  # fmt: skip
    """Arguments that the parameters of a method cannot be. `kinds` are those of these, None if unknown."""
    for number, member in enumerate(inputs[: arguments.count]):
        for span, value, needed in _wrong(kinds[number], arguments, number, worker):
            yield codes.WRONG_LITERAL.at(span, owner=owner, name=member.name, value=value, wanted=needed)
    by_name = {member.name: kind for member, kind in zip(inputs, kinds, strict=True)}
    for name, constant in zip(arguments.names, arguments.named, strict=False):
        kind = by_name.get(name.text)
        if kind is not None and constant is not None:
            for span, value, needed in _wrong_literal(kind, constant, worker):
                yield codes.WRONG_LITERAL.at(span, owner=owner, name=name.text, value=value, wanted=needed)


def wrong_results(returned: Returned, worker: WorkerOffer) -> Iterator[Diagnostic]:
    """Results that the callers of a method of the worker cannot get."""
    results = worker.answering[returned.method]
    values, name = returned.values, returned.method
    if not values.is_exact:
        return
    if len(results) > 1 and not returned.is_tuple:
        given = _given(values, 0, worker)
        text = repr(values.values[0].value) if values.values[0] is not None else given.text if given else ""
        if text and (given is None or given.text not in (LIST, TUPLE)):
            yield _no_result(returned.span, name, text, f"{len(results)} values")
    elif len(results) > 1 and values.count != len(results):
        yield _no_result(returned.span, name, f"{values.count} values", str(len(results)))
    elif len(results) == 1 and returned.is_tuple:
        kind = results[0][1]
        if kind is not None and (needed := unfit(kind, TUPLE)):
            yield _no_result(returned.span, name, TUPLE, needed)
    else:
        for number, (result, kind) in enumerate(results):
            for span, value, needed in _wrong(kind, values, number, worker):
                yield _no_result(span, name, f"{value} as {result}" if len(results) > 1 else value, needed)


def _no_result(span: Span, name: str, value: str, needed: str) -> Diagnostic:
    return codes.WRONG_RESULT.at(span, name=name, value=value, wanted=needed)


def _wrong(kind: Kind | None, arguments: Arguments, number: int, worker: WorkerOffer) -> Iterator[_Wrong]:
    """What is wrong with an argument by position."""
    if kind is None or number >= len(arguments.values):
        return
    constant, given = arguments.values[number], _given(arguments, number, worker)
    if constant is not None:
        yield from _wrong_literal(kind, constant, worker)
    elif given is not None and (needed := unfit(kind, given.text)):
        yield given.span, given.text, needed
    elif kind.element is not None and number < len(arguments.inside):
        for one in arguments.inside[number]:
            for span, value, needed in _wrong_literal(kind.element, one, worker):
                yield span, f"a list with {value}", f"a list, each {needed}"


def _wrong_literal(kind: Kind, constant: Constant, worker: WorkerOffer) -> Iterator[_Wrong]:
    if needed := instead_of(kind, constant.value, exact=worker.is_exact):
        yield constant.span, repr(constant.value), needed


def is_context(arguments: Arguments, number: int, worker: WorkerOffer) -> bool:
    """Whether an argument by position may be the context of a call, which is a mapping."""
    if arguments.values[number : number + 1] != (None,):
        return not arguments.values
    given = _given(arguments, number, worker)
    return given is None or given.text in (MAPPING, NOTHING)


def _given(arguments: Arguments, number: int, worker: WorkerOffer) -> Word | None:
    """What an argument surely is, in words; None if that is unknown."""
    if number < len(arguments.forms) and (form := arguments.forms[number]) is not None:
        return form
    chain = arguments.chains[number] if number < len(arguments.chains) else None
    text = _what(chain, *leads_to(chain, worker)) if chain is not None else ""
    return Word(text, chain.steps[-1].word.span) if chain is not None and text else None


def leads_to(chain: Chain, worker: WorkerOffer) -> tuple[Offer | None, OfferedMember | None]:
    """What a chain leads to, and the member that is; None if that is unknown."""
    now, member = worker.roots.get(chain.root), None
    for step in chain.steps:
        if now is None:
            return None, None
        if step.is_index:
            now, member = now.at(step), None
            continue
        member = now.members.get(step.word.text)
        if member is None:
            return None, None
        now = after(step, member)
    return now, member


def wrong_sum(chain: Chain, now: Offer | None, member: OfferedMember | None) -> Iterator[Diagnostic]:
    """A value that is added to one of another type, which Python does not convert."""
    other, last = chain.added, chain.steps[-1].word
    if other is None or "TypeError" in chain.caught or not last.text:
        return
    is_struct = now is not None and now.kind == offers.STRUCT
    if now is not None and not is_struct and not (now.kind == offers.PLAIN and now.is_complete):
        return
    if now is None and (member is None or member.parameter is None):
        return
    what = _what(chain, now, member)
    is_wrong = is_struct or {what, other.text} in ({TEXT, NUMBER}, {TEXT, TRUTH}, {TEXT, LIST}, {NUMBER, LIST})
    if is_wrong and what:
        hint = "write str(…), or an f-string" if TEXT in (what, other.text) and not is_struct else ""
        yield codes.NOT_ADDED.at(last.span, name=last.text, what=what, other=other.text, hint=hint)


def after(step: Step, member: OfferedMember) -> Offer | None:
    """What a step to a member leads to."""
    return member.result if step.arguments is not None and member.result is not None else member.value


def _what(chain: Chain, now: Offer | None, member: OfferedMember | None) -> str:
    if now is None and member is not None and member.result is not None:  # it is named, and not called
        if chain.root == MODULES:
            return f"the type {member.result.name}" if member.result.name else ""
        return "a method without ()"
    if now is None:
        type_ = member.parameter.type if member is not None and member.parameter is not None else None
        return TEXT if isinstance(type_, EnumType) else of_basic(type_.name) if isinstance(type_, BasicType) else ""
    match now.kind:
        case offers.PLAIN:
            return of_basic(now.name) or f"a {now.name}"
        case offers.STRUCT:
            return f"a {now.name}"
        case offers.ENUM:
            return f"the enum {now.name}"
        case offers.LIST:
            return LIST
        case offers.RECORD:
            return f"{now.name} of the parameters" if now.name else ""
        case offers.PROXY | offers.TOPIC:
            return "a proxy"
        case offers.FUTURE:
            return now.name
        case offers.RESULTS:
            return TUPLE if now.count else NOTHING
        case _:
            return ""
