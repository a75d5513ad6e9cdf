"""Names in a module: names that Slice allows, and duplicates.

Reserved words of target languages are allowed, because Ice's mappings escape them, except a few in Python. Names that
cannot be used in a language nevertheless are the subject of that language's own checks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache, partial
from typing import Any

import msgspec

from robocomp_yaml.check import repeated
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.references import Identifier, groups, kind_of
from robocomp_yaml.model.interface import Module

RESERVED = frozenset(
    "bool byte class const dictionary double enum exception extends false float idempotent implements int interface "
    "local LocalObject long module Object optional out sequence short string struct throws true Value void".split()
)
RESERVED_SUFFIXES = ("Helper", "Holder", "Prx", "Ptr")
UNESCAPED_IN_PYTHON = frozenset(("False", "True", "as", "async", "await", "nonlocal", "with"))  # by Ice 3.7
LONGEST_NAME = 200


class SliceNameFault(msgspec.Struct, frozen=True):
    """Why Slice rejects a name; `facts` are for the message, in addition to the name and its kind."""

    code: Code
    hint: str | Hint = "choose another name"
    facts: Mapping[str, Any] = {}


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        part = "names of module", linked.module.path
        yield from program.memory.listed(part, (linked.module,), partial(_module, linked.module))


def _module(module: Module) -> Iterator[Diagnostic]:
    yield from _legal(Identifier("module", module.name, module.span))
    defined = [Identifier(kind_of(d), d.name, d.span) for d in module.definitions]
    yield from _distinct(f"module {module.name}", sorted(defined, key=lambda name: name.span), "definitions")
    yield from _not_named_as("module", module.name, defined)
    for name in defined:
        yield from _legal(name)
    for definition in module.definitions:
        for group in groups(definition):
            for name in group:
                yield from _legal(name)
            if group and group[0].kind == "method":
                yield from _not_named_as(kind_of(definition), definition.name, group)
            if len(group) > 1:
                owner = group[0].owner or f"{kind_of(definition)} {definition.name}"
                yield from _distinct(owner, group, f"{group[0].kind}s")


def _legal(name: Identifier) -> Iterator[Diagnostic]:
    fault = fault_of(name.text)
    if fault is None and name.kind == "method" and name.text == "staticmethod":
        fault = SliceNameFault(codes.PYTHON_WORD)
    if fault is not None:
        word = name.text if len(name.text) <= LONGEST_NAME else f"{name.text[:20]}…"
        yield fault.code.at(name.span, name=word, kind=name.kind, hint=fault.hint, **fault.facts)


@lru_cache(maxsize=10_000)
def fault_of(word: str) -> SliceNameFault | None:
    """Why Slice rejects a word as an identifier, or None. The schema checks the characters."""
    if word in RESERVED:
        other = word[0].swapcase() + word[1:]
        return SliceNameFault(codes.RESERVED_WORD, f"choose another name; '{other}' is allowed")
    if word in UNESCAPED_IN_PYTHON:
        return SliceNameFault(codes.PYTHON_WORD)
    parts = [part for part in word.split("_") if part]
    if "_".join(parts) != word:
        reason = "each underscore must be between other characters"
        better = "_".join(parts) if parts and not parts[0][0].isdigit() else ""
        hint = Hint(f"write '{better}'", word, better) if better else "choose another name"
        return SliceNameFault(codes.ILLEGAL_NAME, hint, {"reason": reason})
    if word[:3].lower() == "ice":
        return SliceNameFault(
            codes.ILLEGAL_NAME, facts={"reason": f"names that start with '{word[:3]}' are reserved for Ice"}
        )
    if word.endswith(RESERVED_SUFFIXES):
        suffix = next(suffix for suffix in RESERVED_SUFFIXES if word.endswith(suffix))
        return SliceNameFault(
            codes.ILLEGAL_NAME, facts={"reason": f"names that end in '{suffix}' are reserved for Ice"}
        )
    if len(word) > LONGEST_NAME:
        return SliceNameFault(codes.ILLEGAL_NAME, facts={"reason": f"a name has at most {LONGEST_NAME} characters"})
    return None


def _distinct(owner: str, names: Iterable[Identifier], kinds: str) -> Iterator[Diagnostic]:
    for other, name in repeated(names, lambda name: name.text.lower()):
        related = [Related(f"the first '{other.text}'", other.span)]
        if other.text == name.text:
            yield codes.DUPLICATE_NAME.at(
                name.span, owner=owner, kinds=kinds, name=name.text, hint="rename one of them", related=related
            )
        else:
            yield codes.CASE_CLASH.at(
                name.span,
                owner=owner,
                kinds=kinds,
                name=name.text,
                other=other.text,
                hint="rename one of them: in Slice, case does not distinguish names",
                related=related,
            )


def _not_named_as(outer: str, outer_name: str, names: Iterable[Identifier]) -> Iterator[Diagnostic]:
    for name in names:
        if name.text.lower() == outer_name.lower():
            yield codes.NAME_OF_OUTER.at(
                name.span,
                kind=name.kind,
                name=name.text,
                outer=outer,
                outer_name=outer_name,
                hint="choose another name, not one that differs only in case",
            )
