"""The reference of a component's parameters, in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.parameters.types import EnumType, Parameters, RecordType, ResolvedMember, Type, innermost, is_secret
from robocomp_yaml.parameters.words import default_in_words, in_words, prose


def reference(parameters: Parameters, name: str) -> str:
    """The text of the reference. `name` is the name of the component."""
    return "\n".join(_lines(parameters, name)) + "\n"


def _lines(parameters: Parameters, name: str) -> Iterator[str]:
    yield f"# Parameters of {name}"
    yield ""
    if parameters.doc:
        yield prose(parameters.doc)
        yield ""
    yield from _table("Parameter", parameters.root, "")
    for type_ in parameters.types:
        yield ""
        yield f"## {type_.name}"
        yield ""
        if type_.doc:
            yield prose(type_.doc)
            yield ""
        if isinstance(type_, RecordType):
            yield from _table("Member", type_, "")
        else:
            yield "| Value | Meaning |"
            yield "|---|---|"
            yield from (f"| `{name}` | {_cell(doc)} |" for name, doc in type_.enumerators)
    if parameters.constraints:
        yield ""
        yield "## Constraints"
        yield ""
        for constraint in parameters.constraints:
            otherwise = f": {prose(constraint.otherwise)}, otherwise." if constraint.otherwise else ""
            yield f"- {_code(constraint.text)}{otherwise}"
    if parameters.spellings:
        yield ""
        yield "## Properties"
        yield ""
        yield "In `etc/config`, these parameters have other names than their paths:"
        yield ""
        for spelling in parameters.spellings:
            keys = [spelling.key] if spelling.key else [key for _, key in spelling.fields]
            shown = ", ".join(f"`{key}`" for key in keys)
            columns = f" = `{spelling.separator.join(spelling.columns)}`" if spelling.columns else ""
            count = f"; `{spelling.count}` is the number of rows" if spelling.count else ""
            yield f"- `{spelling.path}`: {shown}{columns}{count}"


def _table(head: str, record: RecordType, prefix: str) -> Iterator[str]:
    yield f"| {head} | Type | Default | Meaning |"
    yield "|---|---|---|---|"
    yield from _rows(record, prefix)


def _rows(record: RecordType, prefix: str) -> Iterator[str]:
    for member in record.members:
        if isinstance(member.type, RecordType) and member.is_group:
            if member.doc:
                yield f"| **`{prefix}{member.name}`** | | | {_cell(member.doc)} |"
            yield from _rows(member.type, f"{prefix}{member.name}.")
        else:
            kind = _cell(_linked(member.type))
            yield f"| `{prefix}{member.name}` | {kind} | {_default(member)} | {_cell(_meaning(member))} |"


def _linked(type_: Type) -> str:
    """The type in words, with a link to the section of a named type."""
    named = innermost(type_)
    if not isinstance(named, (RecordType, EnumType)):
        return in_words(type_)
    inner = in_words(named)
    outer = in_words(type_).removesuffix(inner)
    link = f"[{named.name}](#{named.name.lower()})"
    return f"{outer}{link}: {inner}" if isinstance(named, EnumType) else f"{outer}of type {link}"


def _default(member: ResolvedMember) -> str:
    if member.default is None:
        return "optional" if member.optional else "**required**"
    return _code(default_in_words(member)).replace("|", "\\|")


def _meaning(member: ResolvedMember) -> str:
    facts = ("May change while running.", member.editable), ("Secret.", is_secret(member.type))
    return " ".join(part for part in (member.documentation, *(fact for fact, holds in facts if holds)) if part)


def _cell(text: str) -> str:
    return prose(" ".join(text.split())).replace("|", "\\|")


def _code(text: str) -> str:
    """Text as code in Markdown, in as many backquotes as necessary."""
    fence = "`" * (1 + max(map(len, re.findall("`+", text)), default=0))
    return f"{fence} {text} {fence}" if "`" in text else f"{fence}{text}{fence}"
