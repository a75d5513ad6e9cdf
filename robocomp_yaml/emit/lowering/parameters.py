"""Parameters in code: the classes of their enums and records, and what is said of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import BasicType, EnumType, ListType, MapType, Member, Parameters, RecordType, Type
from robocomp_yaml.parameters.words import for_code

ROOT = "."
"""The path of the record that holds all parameters."""


class TypeSpelling(msgspec.Struct, frozen=True):
    """How a language names types: `basic` by our names, `listing` and `mapping` with {} for the element's, `own` for
    the classes that are made. `boxed` are the basic ones as elements, where they are others there."""

    basic: Mapping[str, str]
    listing: str
    mapping: str
    own: str = "{}"
    boxed: Mapping[str, str] = {}
    path: str = "{}"


class ConstraintView(msgspec.Struct, frozen=True):
    """A rule that parameters keep: as it is written, what is said where it is broken, and what judges it, in code."""

    text: str
    otherwise: str
    value: str


class Types:
    """The classes of all enums and records that parameters use: `of` by name, that of a group by its path."""

    def __init__(self, root: RecordType, names: NameAllocator, spelling: TypeSpelling) -> None:
        self.records, self.enums = records(root)
        self.spelling = spelling
        self.of = {enum.name: names.take(enum.name) for enum in self.enums}
        self.of |= {path: names.take(path) for path, record in self.records if not record.is_group}
        for path, record in self.records:
            if record.is_group:
                self.of[path] = "Values" if path == ROOT else names.take(f"{capitals(path[1:])}Group")

    def spelled(self, type_: Type, group: str | None = None, *, boxed: bool = False) -> str:
        """The type in code; `group` is the path of a group, `boxed` what is an element of something."""
        spelling = self.spelling
        match type_:
            case BasicType(name=name):
                return spelling.boxed.get(name, spelling.basic[name]) if boxed else spelling.basic[name]
            case EnumType(name=name):
                return spelling.own.format(self.of[name])
            case ListType(element=element):
                return spelling.listing.format(self.spelled(element, boxed=True))
            case MapType(element=element):
                return spelling.mapping.format(self.spelled(element, boxed=True))
            case _:
                return spelling.own.format(self.of[type_.name or group or ""])

    def setters(
        self, member: Member, taken: NameAllocator, around: str = ROOT, before: str = ""
    ) -> Iterator[tuple[str, Member, str]]:
        """Name, member and path of each setter: of the member, or of what the group holds."""
        in_code, path = inside(around, member.code_name), f"{before}{member.name}"
        if member.is_group and isinstance(member.type, RecordType):
            for inner in member.type.members:
                yield from self.setters(inner, taken, in_code, f"{path}.")
        elif member.editable:
            yield taken.take(f"set{capitals(in_code[1:])}"), member, path

    def about_record(self, path: str, record: RecordType) -> str:
        if path == ROOT:
            return "All parameters, as they were at one moment."
        if record.doc:
            return record.doc
        return f"The group {self.spelling.path.format(path[1:])}." if record.is_group else f"The record {record.name}."


def declared(linked: LinkedComponent) -> tuple[Parameters, str, str]:
    """The parameters of a component, its name, and the path of the document that they stand in."""
    found, component = linked.parameters, linked.component
    return found.parameters, component.name, found.document.path if found.document is not None else component.path


def titled(said: str, doc: str) -> str:
    return f"{said}\n\n{doc}" if doc else said


def about_enum(enum: EnumType) -> list[str]:
    """What is said of an enum, and of each of its names: that on one line."""
    words = [enum.doc or f"One of {len(enum.enumerators)} names."]
    return words + [f"{name}: {' '.join(doc.split())}" for name, doc in enum.enumerators if doc]


def about_member(member: Member, between: str) -> str:
    return between.join(part for part in (member.doc.strip(), for_code(member)) if part) or f"{member.name}."


def path_of(member: Member, group: str | None) -> str | None:
    """The path of a member that stands in a group; None in a struct."""
    return None if group is None else inside(group, member.code_name)


def group_of(path: str, record: RecordType) -> str | None:
    return path if record.is_group else None


def capitals(path: str) -> str:
    """`period.compute` makes `PeriodCompute`."""
    return "".join(part[:1].upper() + part[1:] for part in path.split("."))


def records(root: RecordType) -> tuple[list[tuple[str, RecordType]], list[EnumType]]:
    """The records that parameters use, those inside first, by name (a group by its path in code behind a dot, the root
    by a dot); and the enums."""
    found: dict[str, RecordType] = {}
    enums: dict[str, EnumType] = {}

    def visit(type_: Type, path: str) -> None:
        match type_:
            case EnumType(name=name):
                enums.setdefault(name, type_)
            case ListType(element=element) | MapType(element=element):
                visit(element, "")
            case RecordType(name=name, members=members):
                if (name or path) in found:
                    return
                for member in members:
                    visit(member.type, "" if name else inside(path, member.code_name))
                found[name or path] = type_

    visit(root, ".")
    return list(found.items()), list(enums.values())


def inside(group: str, name: str) -> str:
    """The path of a group in a group."""
    return f".{name}" if group == "." else f"{group}.{name}"
