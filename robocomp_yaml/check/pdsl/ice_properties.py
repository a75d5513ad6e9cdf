"""The properties of Ice itself in values documents and flat configs: Ice ignores an unknown one, and most impossible
values."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean, likeness, meaning, suggest
from robocomp_yaml.link.program import LinkedValues, Program
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source import ice_properties
from robocomp_yaml.source.ice_properties import PREFIX
from robocomp_yaml.source.tree import Mapping, Scalar

_NEAR = 0.8  # similarity of a name that is surely misspelled; another may be one of a later Ice


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in sorted(program.values.values(), key=lambda values: values.document.path):
        part = "Ice properties", linked.document.path
        yield from program.memory.listed(part, (linked,), partial(of_document, linked))


def of_document(linked: LinkedValues) -> Iterator[Diagnostic]:
    """What is wrong with the properties of Ice in a document, or in a flat config that was read as one."""
    is_migrated = "legacy" in linked.document.root.entries
    for fault in _faults(linked):
        yield fault.as_severity(WARNING) if is_migrated else fault


def _faults(linked: LinkedValues) -> Iterator[Diagnostic]:
    for section in ("ice", "properties"):
        found = linked.document.root.get(section)
        for key, value in found.items() if isinstance(found, Mapping) else ():
            name = key.lexeme.removeprefix(PREFIX)
            if section == "ice" or name != key.lexeme:
                is_whole = section == "properties" or not linked.document.path.endswith(".yaml")
                yield from _property(key, name, PREFIX if is_whole else "", value)


def _property(key: Scalar, name: str, head: str, value: object) -> Iterator[Diagnostic]:
    if not ice_properties.is_known(name):
        meant = suggest(name, (one.removesuffix("*") for one in ice_properties.names()))
        hint = meaning(f"{head}{name}", f"{head}{meant}") if meant else ""
        unknown = codes.UNKNOWN_OF_ICE.at(key.span, name=f"{PREFIX}{name}", hint=hint)
        yield unknown if meant and likeness(name, meant) >= _NEAR else unknown.as_severity(WARNING)
    elif isinstance(value, Scalar) and (wanted := ice_properties.wanted(name, unquoted(value.lexeme))):
        text = unquoted(value.lexeme)
        hint = did_you_mean(text, ice_properties.words(name))
        yield codes.WRONG_FOR_ICE.at(value.span, name=f"{PREFIX}{name}", value=text, wanted=wanted, hint=hint)
