"""What a type of an interface expects of a value, and what it expects instead of one that cannot be right."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.usage.code import (
    FUNCTION,
    GENERATOR,
    LIST,
    MAPPING,
    NOTHING,
    NUMBER,
    SET,
    TEXT,
    TRUTH,
    TUPLE,
)
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Enum, Map, Sequence, Struct, TypeRef
from robocomp_yaml.semantics.limits import INTEGERS, LIMITS

NUMBERS = ("byte", "short", "int", "long", "float", "double")
_INTEGERS = {"byte": (0, 255), "short": (-(2**15), 2**15 - 1), **{name: LIMITS[name] for name in INTEGERS}}
_FORMS = frozenset((LIST, TUPLE, SET, FUNCTION, GENERATOR, MAPPING, NUMBER, TEXT, TRUTH))


class Kind(msgspec.Struct, frozen=True):
    """What values of a type are. `words` say it in messages; `name` is the one of a basic type, of a struct or of an
    enum; `element` is what the elements of a list are."""

    words: str
    name: str = ""
    is_enum: bool = False
    element: Kind | None = None


def kind_of(ref: TypeRef, scope: LinkedModule) -> Kind | None:
    """What values of a type are; None if nothing can be compared with it."""
    if ref.is_basic:
        return Kind(of_basic(ref.text), ref.text)
    found = scope.find(ref)
    match found[1] if found is not None else None:
        case (Struct() | Enum()) as definition:
            return Kind(f"a {definition.name}", definition.name, isinstance(definition, Enum))
        case Sequence(element=element) if found is not None:
            return Kind(LIST, element=kind_of(element, found[0]))
        case Map():
            return Kind(MAPPING)
        case _:
            return None


def of_basic(name: str) -> str:
    """What values of a basic type are, in words; '' for another type."""
    return TEXT if name == "string" else TRUTH if name == "bool" else NUMBER if name in NUMBERS else ""


def instead_of(kind: Kind, value: object, *, exact: bool) -> str:
    """What is expected instead of a literal value; '' if that may be right. With `exact`, no number is converted."""
    if kind.name:
        return wanted(kind.name, value, integers=True) or (_limits(kind.name, value) if exact else "")
    return kind.words if not isinstance(value, str) or not _accepts_texts(kind) else ""


def wanted(type_: str, value: object, *, integers: bool = False) -> str:
    """What a type of an interface expects instead of a literal value; '' if the value may be right. With `integers`,
    they are no enumerators."""
    if type_ == "string":
        return "" if isinstance(value, str) else "a text"
    if type_ in NUMBERS:
        return "a number" if isinstance(value, str) else ""
    if type_ == "bool":
        return "true or false" if isinstance(value, str) else ""
    return f"a {type_}" if type_ and (integers or isinstance(value, (str, float))) else ""


def _limits(name: str, value: object) -> str:
    if name not in _INTEGERS or not isinstance(value, (int, float)):
        return ""
    if isinstance(value, float):
        return "a whole number"
    low, high = _INTEGERS[name]
    return "" if low <= value <= high else f"a whole number from {low} to {high}"


def unfit(kind: Kind, given: str) -> str:
    """What is expected instead of something, which is given in words; '' if that may be right."""
    if given == NOTHING:  # a struct, a text, a list and a mapping may be None
        return kind.words if kind.name in NUMBERS or kind.is_enum else ""
    if given not in _FORMS and not given.startswith(("a ", "the ")):
        return ""
    if given == kind.words or (given in (NUMBER, TRUTH) and kind.words in (NUMBER, TRUTH)):
        return ""
    is_list = given == TUPLE or (given == TEXT and _accepts_texts(kind))
    return "" if kind.words == LIST and is_list else kind.words


def _accepts_texts(kind: Kind) -> bool:
    """Whether a text can be a list of its letters."""
    return kind.words == LIST and (kind.element is None or kind.element.name == "string")
