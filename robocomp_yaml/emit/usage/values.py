"""The parameters that code names in texts, such as paths and properties, and the values that it sets literally."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.emit.usage.code import Arguments, Chain, Constant, Word
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.spelling.templates import exact_keys, row_keys
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    Type,
    is_secret,
    leaves,
)
from robocomp_yaml.parameters.verdict.plain import wrong
from robocomp_yaml.parameters.words import in_words
from robocomp_yaml.semantics.paths import parse

# Properties of Ice and of the run time, which are no parameters: by their first name, and by an ending.
_OTHERS = frozenset("commonbehavior endpoints ice icegrid icestorm period proxies topicmanager".split())
_OTHER_ENDINGS = ("proxy", "endpoints", "topic", "topicmanager", "prefix")


EDITABLE = "add `editable: true` to the parameter, if components may change it while they run"


def unknown(code: Code, word: Word, meant: str, *, otherwise: str, safe: bool, **facts: object) -> Diagnostic:
    """The diagnostic of an unknown word in code. If another one is `meant`, the hint and the fix say so."""
    facts = {"name": word.text, **facts}
    if not meant:
        return code.at(word.span, hint=otherwise, **facts)  # type: ignore[arg-type]
    fix = Fix(f"write '{meant}'", (Edit(word.span, meant),), safe)
    hint = f"did you mean '{meant}'?"
    return code.at(word.span, hint=hint, fixes=(fix,), meant=meant, **facts)  # type: ignore[arg-type]


def where(linked: LinkedComponent) -> str:
    """Where the parameters of a component are declared, as a hint."""
    document = linked.parameters.document
    if document is None:
        return f"{linked.component.name} has no parameters of its own; a document NAME.pdsl.yaml declares some"
    return f"the parameters are declared in {document.path}"


def wrong_paths(linked: LinkedComponent, arguments: Arguments) -> Iterator[Diagnostic]:
    """The paths of a call that lead to no parameter, or to one that is not editable; and the value that it sets, if
    that is wrong."""
    root = linked.parameters.parameters.root
    for word in (*([arguments.text] if arguments.text else ()), *arguments.keys):
        steps = parse(word.text)
        current: Type | None = root
        member: ResolvedMember | None = None
        is_editable = False
        for number, step in enumerate(steps):
            if isinstance(current, RecordType):
                member = current.member(step)
                if member is None:
                    yield _unknown_path(linked, word, number, steps, current)
                    current = None
                    break
                current = member.type
                is_editable |= member.editable and not member.is_group
            else:
                current = current.element if isinstance(current, (ListType, MapType)) else None
        if current is not None and member is not None and not is_editable and not member.is_group:
            yield codes.NOT_EDITABLE.at(word.span, name=word.text, hint=EDITABLE)
        elif current is not None and (constant := _under(word, arguments)) is not None:
            yield from wrong_value(current, word.text, constant)


def _under(word: Word, arguments: Arguments) -> Constant | None:
    """The literal that is set at a path."""
    if word == arguments.text:
        return arguments.constant
    return dict(zip(arguments.keys, arguments.under, strict=False)).get(word)


def _unknown_path(
    linked: LinkedComponent, word: Word, number: int, steps: list[str], record: RecordType
) -> Diagnostic:  # fmt: skip
    hint = did_you_mean(steps[number], [one.name for one in record.members])
    meant = ".".join([*steps[:number], hint.meant, *steps[number + 1 :]]) if hint.meant else ""
    if meant and word.text.count(steps[number]) == 1:  # an index keeps its spelling
        meant = word.text.replace(steps[number], hint.meant)
    owner = linked.component.name
    return unknown(codes.UNKNOWN_PARAMETER, word, meant, otherwise=where(linked), safe=hint.safe, owner=owner)


def wrong_value(type_: Type, path: str, constant: Constant) -> Iterator[Diagnostic]:
    """A literal value that the parameter rejects. None resets it. A secret is not quoted, and so not judged."""
    if rejected(type_, constant.value):
        yield codes.WRONG_VALUE.at(
            constant.span, name=path, value=repr(constant.value), hint=f"it must be {in_words(type_)}"
        )


def rejected(type_: Type | None, data: object) -> bool:
    """Whether a parameter of this type cannot have a value. A secret is not judged."""
    if data is None or not isinstance(type_, (BasicType, EnumType)) or is_secret(type_):
        return False
    if isinstance(data, int) and not isinstance(data, bool) and isinstance(type_, BasicType) and not type_.is_integer:
        data = float(data) if type_.is_number else data
    return bool(wrong(type_, data))


def type_of_setting(linked: LinkedComponent, key: str) -> Type | None:
    """The type of the parameter that a property sets as a whole; None if there is none."""
    path = next((path for path, name, _ in exact_keys(linked.parameters.parameters) if name == key), "")
    every = leaves(linked.parameters.parameters.root)
    return next((member.type for name, member in every if name == path and member is not None), None)


def keys(record: RecordType, head: str = "") -> Iterator[str]:
    """The dotted paths of the parameters in a record and its groups."""
    for member in record.members:
        if member.is_group and isinstance(member.type, RecordType):
            yield from keys(member.type, f"{head}{member.name}.")
        else:
            yield f"{head}{member.name}"


def unknown_setting(linked: LinkedComponent, chain: Chain, config: Collection[str]) -> Iterator[Diagnostic]:
    """A property that code of RoboComp reads, and that neither a parameter nor the flat config has. Without a
    parameters document, any property may be meant."""
    parameters = linked.parameters
    if parameters.document is None or "KeyError" in chain.caught:
        return
    key, word = ".".join(step.word.text for step in chain.steps), chain.steps[-1].word
    exact = [name for _, name, _ in exact_keys(parameters.parameters)]
    if _is_other(key) or any(_is_part(key, known) for known in (*exact, *config)):
        return
    rows = [name for _, name in row_keys(parameters.parameters)]
    if any(key.startswith(re.split(r"[{*]", name)[0]) or name.startswith(f"{key}.") for name in rows):
        return
    head = key.removesuffix(word.text)
    known = [name.removeprefix(head) for name in exact if name.startswith(head)]
    hint = did_you_mean(word.text, known, otherwise=where(linked))
    owner = linked.component.name
    yield unknown(
        codes.UNKNOWN_SETTING, word, hint.meant, otherwise=hint.text, safe=hint.safe, name=key, owner=owner
    )  # fmt: skip


def _is_part(key: str, known: str) -> bool:
    """Whether one of two keys is the other, or a group or list that contains it."""
    return key == known or known.startswith(f"{key}.") or key.startswith(f"{known}.")


def _is_other(key: str) -> bool:
    words = key.lower().split(".")
    return words[0] in _OTHERS or any(word.endswith(_OTHER_ENDINGS) for word in words)
