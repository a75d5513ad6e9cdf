"""Names within a module: what Slice lets them be, and that no two are alike.

Reserved words of target languages are no concern, since Ice's mappings escape them: but for a few that the one to
Python forgets.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.references import Name, groups, kind_of
from robocomp_yaml.model.interface import Interface, Module

RESERVED = frozenset(
    "bool byte class const dictionary double enum exception extends false float idempotent implements int interface "
    "local LocalObject long module Object optional out sequence short string struct throws true Value void".split()
)
RESERVED_SUFFIXES = ("Helper", "Holder", "Prx", "Ptr")
UNESCAPED_IN_PYTHON = frozenset(("False", "True", "as", "async", "await", "nonlocal", "with"))  # by Ice 3.7
LONGEST_NAME = 200


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        yield from _module(linked.module)


def _module(module: Module) -> Iterator[Diagnostic]:
    yield from _legal(Name("module", module.name, module.span))
    owner = f"module {module.name}"
    defined = [Name(kind_of(d), d.name, d.span) for d in sorted(module.definitions, key=lambda d: d.span)]
    yield from _distinct(owner, "definitions", defined)
    yield from _not_named_as("module", module.name, defined)
    for name in defined:
        yield from _legal(name)
    for definition in module.definitions:
        for group in groups(definition):
            for name in group:
                yield from _legal(name)
            owner = f"{kind_of(definition)} {definition.name}"
            if isinstance(definition, Interface) and group and group[0].kind == "method":
                yield from _not_named_as(kind_of(definition), definition.name, group)
            yield from _distinct(owner, f"{group[0].kind}s" if group else "", group)


def _legal(name: Name) -> Iterator[Diagnostic]:
    """Whether Slice takes an identifier; its characters are the schema's matter."""
    word = name.text
    if word in RESERVED:
        other = word[0].swapcase() + word[1:]
        hint = f"choose another name; '{other}' is allowed"
        yield codes.RESERVED_WORD.at(name.span, name=word, kind=name.kind, hint=hint)
        return
    if word in UNESCAPED_IN_PYTHON or (name.kind == "method" and word == "staticmethod"):
        yield codes.PYTHON_WORD.at(name.span, name=word, kind=name.kind, hint="choose another name")
        return
    parts = [part for part in word.split("_") if part]
    hint = "choose another name"
    if "_".join(parts) != word:
        reason = "underscores stand alone, between other characters"
        hint = f"write '{'_'.join(parts)}'" if parts and not parts[0][0].isdigit() else hint
    elif word[:3].lower() == "ice":
        reason = f"names that start with '{word[:3]}' are Ice's own"
    elif word.endswith(RESERVED_SUFFIXES):
        suffix = next(suffix for suffix in RESERVED_SUFFIXES if word.endswith(suffix))
        reason = f"names that end in '{suffix}' are Ice's own"
    elif len(word) > LONGEST_NAME:
        word, reason = f"{word[:20]}…", f"a name has at most {LONGEST_NAME} characters"
    else:
        return
    yield codes.ILLEGAL_NAME.at(name.span, name=word, kind=name.kind, reason=reason, hint=hint)


def _distinct(owner: str, kinds: str, names: Iterable[Name]) -> Iterator[Diagnostic]:
    first: dict[str, Name] = {}
    for name in names:
        other = first.setdefault(name.text.lower(), name)
        if other is name:
            continue
        related = [Related(f"'{other.text}' stands here first", other.span)]
        if other.text == name.text:
            yield codes.DUPLICATE_NAME.at(
                name.span, owner=owner, kinds=kinds, name=name.text, hint="rename one of them", related=related
            )
        else:
            yield codes.CASE_CLASH.at(
                name.span, owner=owner, kinds=kinds, name=name.text, other=other.text,
                hint="rename one of them: Slice takes both for the same name", related=related,
            )


def _not_named_as(outer: str, outer_name: str, names: Iterable[Name]) -> Iterator[Diagnostic]:
    for name in names:
        if name.text.lower() == outer_name.lower():
            yield codes.NAME_OF_OUTER.at(
                name.span, kind=name.kind, name=name.text, outer=outer, outer_name=outer_name,
                hint="choose another name: Slice allows no such pair, in whatever case",
            )
