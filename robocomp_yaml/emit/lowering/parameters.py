"""Lowers parameters: the classes of their enums and records, with documentation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import msgspec

from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedMember,
    Type,
)
from robocomp_yaml.parameters.words import for_code

ROOT = "."
"""The path of the record of all parameters."""
Setter = tuple[str, ResolvedMember, str]
"""Name, member and path of a setter."""
Accessors = tuple[str, ResolvedMember, list[Setter]]
"""The name of a getter with its member, and the setters of the member."""


class TypeSpelling(msgspec.Struct, frozen=True):
    """How a language spells types. `basic` maps the names of basic types; `listing` and `mapping` have {} for the type
    of the elements, `own` for the name of a generated class. `boxed` are basic types as elements, if they differ.
    `path` is a path of a parameter in documentation."""

    basic: Mapping[str, str]
    listing: str
    mapping: str
    own: str = "{}"
    boxed: Mapping[str, str] = {}
    path: str = "{}"


class Types:
    """The classes of all enums and records of parameters: `of` maps the name, or the path of a group, to the class."""

    def __init__(self, root: RecordType, names: NameAllocator, spelling: TypeSpelling) -> None:
        self.root = root
        self.records, self.enums = records(root)
        self.spelling = spelling
        self.of = {enum.name: names.allocate(enum.name) for enum in self.enums}
        self.of |= {path: names.allocate(path) for path, record in self.records if not record.is_group}
        for path, record in self.records:
            if record.is_group:
                self.of[path] = "Values" if path == ROOT else names.allocate(f"{capitals(path[1:])}Group")

    def spelled(self, type_: Type, group: str | None = None, *, boxed: bool = False) -> str:
        """The type in code; `group` is the path of a group, `boxed` is set for the type of elements."""
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
        self, member: ResolvedMember, names: NameAllocator, group: str = ROOT, prefix: str = ""
    ) -> Iterator[Setter]:
        """Name, member and path of each setter: of the member, or of the members of its group."""
        in_code, path = inside(group, member.code_name), f"{prefix}{member.name}"
        if member.is_group and isinstance(member.type, RecordType):
            for inner in member.type.members:
                yield from self.setters(inner, names, in_code, f"{path}.")
        elif member.editable:
            yield names.allocate(f"set{capitals(in_code[1:])}"), member, path

    def accessors(self, names: NameAllocator, in_code: Callable[[str], str]) -> Iterator[Accessors]:
        getters = {member.name: names.allocate(in_code(member.code_name)) for member in self.root.members}
        for member in self.root.members:
            yield getters[member.name], member, list(self.setters(member, names))

    def about_record(self, path: str, record: RecordType) -> str:
        """The documentation of a record."""
        if path == ROOT:
            return "All parameters, as they were at one moment."
        if record.doc:
            return record.doc
        return f"The group {self.spelling.path.format(path[1:])}." if record.is_group else f"The record {record.name}."


def declared(linked: LinkedComponent) -> tuple[Parameters, str, str]:
    """The parameters of a component, its name, and the path of the document with the parameters."""
    linked_parameters, component = linked.parameters, linked.component
    document = linked_parameters.document or component
    return linked_parameters.parameters, component.name, document.path


def titled(title: str, doc: str) -> str:
    """A title with documentation below."""
    return f"{title}\n\n{doc}" if doc else title


def about_enum(enum: EnumType) -> list[str]:
    """The documentation of an enum, and of each of its names, one line each."""
    words = [enum.doc or f"One of {len(enum.enumerators)} names."]
    return words + [f"{name}: {' '.join(doc.split())}" for name, doc in enum.enumerators if doc]


def about_member(member: ResolvedMember, between: str) -> str:
    """The documentation of a member, and its type and limits in words, with `between` in the middle."""
    return between.join(part for part in (member.doc.strip(), for_code(member)) if part) or f"{member.name}."


def path_of(member: ResolvedMember, group: str | None) -> str | None:
    """The path of a member of a group; None in a struct."""
    return None if group is None else inside(group, member.code_name)


def group_of(path: str, record: RecordType) -> str | None:
    """The path of a record that is a group; None for a struct."""
    return path if record.is_group else None


def capitals(path: str) -> str:
    """`period.compute` makes `PeriodCompute`."""
    return "".join(part[:1].upper() + part[1:] for part in path.split("."))


def records(root: RecordType) -> tuple[list[tuple[str, RecordType]], list[EnumType]]:
    """The records of parameters, inner ones first, by name (a group by a dot and its path in code, the root by a dot),
    and the enums."""
    by_name: dict[str, RecordType] = {}
    enums: dict[str, EnumType] = {}

    def visit(type_: Type, path: str) -> None:
        match type_:
            case EnumType(name=name):
                enums.setdefault(name, type_)
            case ListType(element=element) | MapType(element=element):
                visit(element, "")
            case RecordType(name=name, members=members):
                if (name or path) in by_name:
                    return
                for member in members:
                    visit(member.type, "" if name else inside(path, member.code_name))
                by_name[name or path] = type_

    visit(root, ".")
    return list(by_name.items()), list(enums.values())


def inside(group: str, name: str) -> str:
    """The path of a member of a group."""
    return f".{name}" if group == "." else f"{group}.{name}"
