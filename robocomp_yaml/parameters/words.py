"""Types and parameters in words, for messages, editors, documents and code."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps

from robocomp_yaml.parameters.hidden import hidden
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    Size,
    Type,
    is_secret,
    unit_of,
)
from robocomp_yaml.patterns import pattern
from robocomp_yaml.semantics.limits import LIST, MAP, WORDS, one_of, record_in_words
from robocomp_yaml.source.yaml_text import flow

_CODE_OR_TAG = pattern(r"((`+)(?!`).*?(?<!`)\2(?!`))|(?<!\\)<(?!https?://)", re.DOTALL)


def kind_in_words(type_: Type) -> str:
    """The values of a type, without limits: `a whole number`."""
    match type_:
        case BasicType(name=name):
            return WORDS[name]
        case EnumType(allowed=allowed, secret=secret):
            return one_of(allowed, secret)
        case ListType():
            return LIST
        case MapType():
            return MAP
        case _:
            return record_in_words([member.name for member in type_.members])


def in_brief(type_: Type) -> str:
    """The values of a type in an expression, where all numbers have one type: `a number`, `a Motor`."""
    match type_:
        case BasicType():
            return WORDS["double" if type_.is_number else type_.name]
        case EnumType(name=name):
            return one_of([name])
        case ListType():
            return LIST
        case MapType():
            return "a map"
        case _:
            return f"a {type_.name}" if type_.name else "a group"


def in_words(type_: Type) -> str:
    """A type with its limits and unit: `a number from 0 to 2 (rad/s)`."""
    match type_:
        case RecordType():
            return f"of type {type_.name}" if type_.name else "a mapping of parameters to values"
        case ListType() | MapType():
            kind = "list" if isinstance(type_, ListType) else "map"
            size = "" if type_.size.is_any else f" of {elements_in_words(type_.size)}"
            unique = ", all different" if isinstance(type_, ListType) and type_.unique else ""
            return f"a {kind}{size}{unique}, each {in_words(type_.element)}"
        case BasicType(values=values) if values:
            words = one_of([literal.lexeme for literal in values])
        case BasicType(range=range_) if range_:
            words = f"{kind_in_words(type_)} {range_.in_words}"
        case BasicType(pattern=pattern) if pattern:
            words = f"{kind_in_words(type_)} that matches `{pattern.text}`"
        case _:
            words = kind_in_words(type_)
    return f"{words} ({type_.unit})" if isinstance(type_, BasicType) and type_.unit else words


def elements_in_words(size: Size) -> str:
    """A limited number of elements: `exactly 1 element`, `1 to 4 elements`."""
    return f"{size.in_words} element{'' if (size.most or size.least) == 1 else 's'}"


def limits_in_words(type_: Type) -> list[str]:
    """The limits of a type, for comments in code: `from 0 to 2 rad/s`."""
    match type_:
        case BasicType():
            unit = f" {type_.unit}" if type_.unit else ""
            if type_.values:
                return [f"{one_of([value.lexeme for value in type_.values])}{unit}"]
            if type_.range is not None:
                return [f"{type_.range.in_words}{unit}"]
            return [f"matches {type_.pattern.text}"] if type_.pattern is not None else []
        case EnumType(allowed=allowed):
            return [one_of(allowed)] if allowed != type_.names else []
        case ListType(element=element, size=size) | MapType(element=element, size=size):
            found = [] if size.is_any else [elements_in_words(size)]
            if isinstance(type_, ListType) and type_.unique:
                found.append("all different")
            return found + [f"each {limit}".replace("each each", "each of these") for limit in limits_in_words(element)]
        case _:
            return []


def label(type_: Type) -> str:
    """The name of a type: `list of Motor`."""
    if isinstance(type_, (ListType, MapType)):
        return f"{'list' if isinstance(type_, ListType) else 'map'} of {label(type_.element)}"
    return type_.name


def _once(words: Callable[[ResolvedMember], str]) -> Callable[[ResolvedMember], str]:
    """Words of a member that are kept with it: code, schemas and pages have the same ones."""

    @wraps(words)
    def kept(member: ResolvedMember) -> str:
        made = vars(member)
        if words.__name__ not in made:
            made[words.__name__] = words(member)
        found: str = made[words.__name__]
        return found

    return kept


@_once
def default_in_words(member: ResolvedMember) -> str:
    """The default of a member that has one, on one line of at most 60 characters. Secrets are hidden."""
    assert member.default is not None
    text = flow(hidden(member.type, member.default.data))
    return text if len(text) <= 60 else f"{text[:59]}…"


@_once
def for_editors(member: ResolvedMember) -> str:
    """The facts that an editor shows below the documentation of a parameter, with one line for each enumerator."""
    kind = in_words(member.type)
    facts = [kind[0].upper() + kind[1:]] if not member.is_group else []
    if member.default is not None:
        facts.append(f"default: {default_in_words(member)}")
    elif member.optional:
        facts.append("optional")
    elif not member.is_group:
        facts.append("required")
    if member.editable and not member.is_group:
        facts.append("may change while running")
    if is_secret(member.type):
        facts.append("secret: set it with {env: NAME} or {file: PATH}")
    text = "; ".join(facts) + ("." if facts else "")
    if isinstance(member.type, EnumType):
        text += "".join(f"\n- `{name}`: {doc}" for name, doc in member.type.enumerators if doc)
    return text


def for_documents(member: ResolvedMember) -> str:
    """The comment above a parameter in a first document."""
    facts = [in_words(member.type)]
    facts += ["optional"] if member.optional else []
    facts += ["may change while running"] if member.editable else []
    return "; ".join(facts)


@_once
def for_code(member: ResolvedMember) -> str:
    """The comment of an accessor, on one line; '' if there are no facts."""
    found = limits_in_words(member.type)
    if not found and (unit := unit_of(member.type)):
        found.append(f"in {unit}")
    if member.default is not None:
        found.append(f"default: {default_in_words(member)}")
    if member.optional:
        found.append("optional")
    if member.editable and not member.is_group:
        found.append("may change while the component runs")
    if is_secret(member.type):
        found.append("secret")
    line = "; ".join(found)
    return f"{line[:1].upper()}{line[1:]}." if line else ""


def prose(doc: str) -> str:
    """A doc as Markdown without HTML: `<name>` is escaped."""
    return _CODE_OR_TAG.sub(lambda found: found[0] if found[1] else "\\<", doc) if "<" in doc else doc
