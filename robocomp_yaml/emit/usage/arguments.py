"""Arguments of a call of which the code says what they are, and that the parameters of the method cannot be."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import MAPPING, NOTHING, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.emit.usage.literals import NUMBERS, wanted
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.model.interface import Member
from robocomp_yaml.parameters.types import BasicType, EnumType

_NUMBER, _TEXT, _TRUTH = "a number", "a text", "true or false"
_FORMS = frozenset(("a list", "a tuple", "a set", "a function", "a generator", MAPPING, _NUMBER, _TEXT, _TRUTH))


def wrong_arguments(
    owner: str, inputs: tuple[Member, ...], kinds: tuple[str, ...], arguments: Arguments, worker: WorkerOffer
) -> Iterator[Diagnostic]:  # fmt: skip
    """Arguments that the parameters of a method cannot be. `kinds` are the types of these, '' if unknown."""
    for number, constant in enumerate(arguments.values[: len(inputs)]):
        yield from _wrong(owner, inputs[number], kinds[number], constant, _given(arguments, number, worker))
    by_name = {member.name: (member, kind) for member, kind in zip(inputs, kinds, strict=True)}
    for name, constant in zip(arguments.names, arguments.named, strict=False):
        if name.text in by_name:
            yield from _wrong(owner, *by_name[name.text], constant, None)


def _wrong(
    owner: str, member: Member, kind: str, constant: Constant | None, given: Word | None
) -> Iterator[Diagnostic]:  # fmt: skip
    if constant is not None:
        if needed := wanted(kind, constant.value, integers=True):
            yield codes.WRONG_LITERAL.at(
                constant.span, owner=owner, name=member.name, value=repr(constant.value), wanted=needed
            )
    elif given is not None and (needed := _unfit(kind, given.text)):
        yield codes.WRONG_LITERAL.at(given.span, owner=owner, name=member.name, value=given.text, wanted=needed)


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
    text = _what(*leads_to(chain, worker)) if chain is not None else ""
    return Word(text, chain.steps[-1].word.span) if chain is not None and text else None


def leads_to(chain: Chain, worker: WorkerOffer) -> tuple[Offer | None, OfferedMember | None]:
    """What a chain leads to, and the member that is; None if that is unknown."""
    now, member = worker.roots.get(chain.root), None
    for step in chain.steps:
        if now is None:
            return None, None
        if step.is_index:
            now, member = now.each if step.is_each else now.element, None
            continue
        member = now.members.get(step.word.text)
        if member is None:
            return None, None
        now = after(step, member)
    return now, member


def after(step: Step, member: OfferedMember) -> Offer | None:
    """What a step to a member leads to."""
    return member.result if step.arguments is not None and member.result is not None else member.value


def _what(now: Offer | None, member: OfferedMember | None) -> str:
    if now is None:
        type_ = member.parameter.type if member is not None and member.parameter is not None else None
        if isinstance(type_, EnumType):
            return _TEXT
        return _basic(type_.name) if isinstance(type_, BasicType) else ""
    match now.kind:
        case offers.PLAIN:
            return _basic(now.name) or f"a {now.name}"
        case offers.STRUCT:
            return f"a {now.name}"
        case offers.ENUM:
            return f"the enum {now.name}"
        case _:
            return ""


def _basic(name: str) -> str:
    return _TEXT if name == "string" else _TRUTH if name == "bool" else _NUMBER if name in NUMBERS else ""


def _unfit(kind: str, given: str) -> str:
    """What a type of an interface expects instead of something; '' if that may be right."""
    if given == NOTHING:  # a struct, a text and a list may be None
        return _NUMBER if kind in NUMBERS else ""
    if not kind or (given not in _FORMS and not given.startswith(("a ", "the "))):
        return ""
    expected = _basic(kind) or f"a {kind}"
    if given == expected or (given in (_NUMBER, _TRUTH) and expected in (_NUMBER, _TRUTH)):
        return ""
    return expected
