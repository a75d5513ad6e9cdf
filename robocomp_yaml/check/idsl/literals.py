"""Values of constants and defaults fit their types."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link import numbers
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.model.interface import Enum, ExceptionType, Literal, Struct, TypeRef
from robocomp_yaml.source.retyped import BOOL, INTEGER, NUMBER, STRING, retyped

RANGES = {"byte": (0, 255), "short": (-(2**15), 2**15 - 1), "int": (-(2**31), 2**31 - 1), "long": (-(2**63), 2**63 - 1)}
_EXPECTED = {"bool": BOOL, "string": STRING, "float": NUMBER, "double": NUMBER}
LONGEST_STRING = 10_000  # characters; Slice's preprocessor crashes on lines above 64 KiB
MOST_LISTED = 8


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        for constant in linked.module.constants:
            yield from _fits(linked, constant.type, constant.value, default=False)
        for definition in (*linked.module.types, *linked.module.exceptions):
            if isinstance(definition, (Struct, ExceptionType)):
                for member in definition.members:
                    if member.default is not None:
                        yield from _fits(linked, member.type, member.default, default=True)


def _fits(linked: LinkedModule, type_: TypeRef, value: Literal, *, default: bool) -> Iterator[Diagnostic]:
    enum = None
    if not type_.is_basic:
        target = linked.find(type_)
        if target is None:
            return  # the unknown type is reported
        if not isinstance(target[1], Enum):
            code, span = (codes.DEFAULT_TYPE, value.span) if default else (codes.CONSTANT_TYPE, type_.span)
            yield code.at(span, type=type_.text, hint="use a basic type or an enum")
            return
        enum = target[1]
    reason, hint = _of_enum(enum, value) if enum else _of_basic(type_.text, value)
    if reason:
        yield codes.MISFIT.at(
            value.span,
            value=_shown(value),
            type=type_.text,
            reason=reason,
            hint=hint,
            fixes=() if enum else retyped([_EXPECTED.get(type_.text, INTEGER)], value.lexeme, value.value, value.span),
        )
    elif type_.text in ("float", "double"):
        yield from _arrives(type_.text, value)


def _arrives(type_name: str, value: Literal) -> Iterator[Diagnostic]:
    number = float(value.value)
    if numbers.is_integer_literal(number):
        return
    if not numbers.compiles(number, type_name):
        reason, hint = "its C++ for this number does not compile", "use double"
        yield codes.NUMBER.at(value.span, value=_shown(value), reason=reason, hint=hint)
    elif not numbers.arrives(number, type_name):
        written = numbers.printed(number)
        reason, hint = f"it becomes {written}", "if that is not exact enough, define it in the programs that use it"
        yield codes.NUMBER.at(value.span, value=_shown(value), reason=reason, hint=hint)


def _of_enum(enum: Enum, value: Literal) -> tuple[str, str | Hint]:
    names = [enumerator.name for enumerator in enum.enumerators]
    if value.lexeme in names:
        return "", ""
    listed = ", ".join(names[:MOST_LISTED]) + (", …" if len(names) > MOST_LISTED else "")
    return f"{enum.name} has no such enumerator", did_you_mean(value.lexeme, names, otherwise=f"it has {listed}")


def _of_basic(type_name: str, value: Literal) -> tuple[str, str]:
    """Why a value does not fit a basic type, and a hint; ('', '') if it fits."""
    match type_name, value.value:
        case "bool", bool():
            return "", ""
        case "bool", _:
            return "it is not true or false", "write true or false, without quotes"
        case "string", str(text):
            return _of_string(text)
        case "string", _:
            return "it is not text", f'write it in quotes: "{value.lexeme}"'
        case _, bool() | str():
            return "it is not a number", "write a number, without quotes"
        case "float" | "double", number:
            return _of_real(type_name, number, value.lexeme)
        case _, float():
            return "it is not an integer", "write it without a point or an exponent, or use float or double"
        case _, number:
            low, high = RANGES[type_name]
            return ("", "") if low <= number <= high else (f"it is not from {low} to {high}", _wider(number))


def _wider(number: int) -> str:
    for name in ("short", "int", "long"):
        if RANGES[name][0] <= number <= RANGES[name][1]:
            return f"use {name}, or a smaller value" if number > 0 else f"use {name}, or a larger value"
    return "use double, or a smaller value" if number > 0 else "use double, or a larger value"


def _of_real(type_name: str, number: float, lexeme: str) -> tuple[str, str]:
    try:
        real = float(number)
        stored = numbers.as_float32(real) if type_name == "float" else real
    except OverflowError:
        other = "use double, or " if type_name == "float" else ""
        return f"it is too large for a {type_name}", f"{other}write a smaller value"
    if stored == 0 and re.search("[1-9]", re.split("[eE]", lexeme)[0]):
        return f"it is too small for a {type_name}", "write 0, or a larger value"
    return "", ""


def _of_string(text: str) -> tuple[str, str]:
    if len(text) > LONGEST_STRING:
        return f"it has more than {LONGEST_STRING} characters", "put long texts into a file"
    if "\0" in text or any(0xD800 <= ord(c) <= 0xDFFF for c in text):
        return "it contains a NUL or half a character", "remove that character"
    return "", ""


def _shown(value: Literal) -> str:
    text = f"'{value.lexeme}'" if isinstance(value.value, str) else value.lexeme
    return text if len(text) <= 40 else f"{text[:36]}…{text[-1]}"
