"""A component's parameters as Java: a class for each record, getters and setters, and the run time's table."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.emit.lowering import parameters as lowering
from robocomp_yaml.emit.lowering.kinds import Builders
from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.parameters import (
    Types,
    TypeSpelling,
    about_enum,
    about_member,
    declared,
    group_of,
    inside,
    path_of,
    titled,
)
from robocomp_yaml.emit.render import render
from robocomp_yaml.languages.java import LANGUAGE
from robocomp_yaml.languages.java.names import METHODS, TYPES
from robocomp_yaml.languages.java.text import IN, comment, listed, literal, one_line, value
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Member,
    Parameters,
    RecordType,
    Type,
    is_secret,
)
from robocomp_yaml.transactions.plan import FilePlan


class EnumView(msgspec.Struct, frozen=True):
    """`constants` with what ends each, `cases` of the switch over them."""

    name: str
    comment: str
    constants: list[str]
    cases: list[str]


class MemberView(msgspec.Struct, frozen=True):
    comment: str
    field: str
    read: str
    kind: str


class RecordView(msgspec.Struct, frozen=True):
    """`function` makes its type in the table; `secret` are the names of members that are not shown, as arguments."""

    name: str
    comment: str
    function: str
    made: str
    secret: str
    members: list[MemberView]


class GetterView(msgspec.Struct, frozen=True):
    comment: str
    declaration: str
    field: str
    setters: list[str]


class ConstraintView(lowering.ConstraintView, frozen=True):
    comma: str


class View(msgspec.Struct, frozen=True):
    source: str
    comment: str
    enums: list[EnumView]
    records: list[RecordView]
    getters: list[GetterView]
    root: str
    spellings: list[str]
    constraints: list[ConstraintView]


def plan(linked: LinkedComponent) -> FilePlan:
    """`generated/Parameters.java`."""
    return FilePlan("generated/Parameters.java", text(*declared(linked)))


def text(parameters: Parameters, component: str, source: str) -> str:
    """The class with the parameters of a component, made from the document `source`."""
    types = _Types(parameters.root)
    view = View(
        source=one_line(source.rpartition("/")[2]),
        comment=comment(titled(f"The parameters of {component} while it runs.", parameters.doc)),
        enums=[types.enum(enum) for enum in types.enums],
        records=[types.record(path, record) for path, record in types.records],
        getters=list(types.getters()),
        root=types.functions["."],
        spellings=_ended(
            f"java.util.Map.entry({literal(each.path)}, new Spelling({_BUILDERS.spelling(each)}))"
            for each in parameters.spellings
        ),
        constraints=_constraints(parameters) if parameters.constraints else [],
    )
    return render("java/Parameters.java.j2", view)


def _constraints(parameters: Parameters) -> list[ConstraintView]:
    from robocomp_yaml.languages.java.constraints import lambda_of  # with all about expressions

    last = len(parameters.constraints) - 1
    return [
        ConstraintView(
            literal(each.text), literal(each.message), lambda_of(each.expression, parameters.root),
            "" if number == last else ",",
        )
        for number, each in enumerate(parameters.constraints)
    ]  # fmt: skip


def _ended(items: Iterator[str], last: str = "") -> list[str]:
    """With commas between them."""
    every = list(items)
    return [f"{item}{last if number == len(every) else ','}" for number, item in enumerate(every, 1)]


_SPELLING = TypeSpelling(
    basic={
        "bool": "boolean", "int": "int", "long": "long", "float": "float", "double": "double", "string": "String",
    },
    boxed={"bool": "Boolean", "int": "Integer", "long": "Long", "float": "Float", "double": "Double"},
    listing="java.util.List<{}>",
    mapping="java.util.Map<String, {}>",
)  # fmt: skip
_BUILDERS = Builders(prefix="Kind.", text=literal, value=value, listed=listed, pattern=literal)
_READ = {
    "bool": "(Boolean) {}", "int": "((Long) {}).intValue()", "long": "(Long) {}", "float": "((Double) {}).floatValue()",
    "double": "(Double) {}", "string": "(String) {}",
}  # fmt: skip


class _Types(Types):
    """The classes of all enums and records that the parameters use, with names that do not clash."""

    def __init__(self, root: RecordType) -> None:
        super().__init__(root, NameAllocator(TYPES), _SPELLING)
        self.root = root
        functions = NameAllocator(METHODS)
        self.functions = {path: functions.allocate(f"kindOf{self.of[path]}") for path, _ in self.records}
        self.constants = {enum.name: _constants(enum) for enum in self.enums}

    def enum(self, enum: EnumType) -> EnumView:
        constants = self.constants[enum.name]
        return EnumView(
            self.of[enum.name],
            comment("\n".join(about_enum(enum)), IN),
            _ended(iter(constants.values()), ";"),
            [f"case {constant} -> {literal(name)};" for name, constant in constants.items()],
        )

    def record(self, path: str, record: RecordType) -> RecordView:
        group = group_of(path, record)
        secret = [literal(member.name) for member in record.members if is_secret(member.type)]
        members = [self.member(member, group) for member in record.members]
        last = len(members) - 1
        return RecordView(
            self.of[path],
            comment(self.about_record(path, record), IN),
            self.functions[path],
            "Kind.group(" if record.is_group else f"Kind.record({literal(record.name)}{',' if members else ''}",
            "".join(f", {name}" for name in secret),
            [
                msgspec.structs.replace(member, kind=member.kind + ("" if number == last else ","))
                for number, member in enumerate(members)
            ],
        )

    def member(self, member: Member, group: str | None) -> MemberView:
        """`group` is the path of the group that it stands in, None in a struct."""
        inner = path_of(member, group)
        name, key = LANGUAGE.in_code(member.code_name), literal(member.name)
        got = f"of.get({key})"
        if member.optional:
            got = f"optional({got}, {self.function(member.type, inner)})"
        else:
            got = self.read(member.type, got, inner)
        return MemberView(
            comment=comment(about_member(member, "\n"), IN * 2),
            field=f"public final {self.member_type(member, inner)} {name};",
            read=f"this.{name} = {got};",
            kind=_BUILDERS.member(f"new Member({key}", member, self.functions, inner),
        )

    def member_type(self, member: Member, group: str | None) -> str:
        if member.optional:
            return f"java.util.Optional<{self.spelled(member.type, group, boxed=True)}>"
        return self.spelled(member.type, group)

    def read(self, type_: Type, data: str, group: str | None = None, depth: int = 0) -> str:
        """An expression for the typed value of data."""
        match type_:
            case BasicType(name=name):
                return _READ[name].format(data)
            case EnumType(name=name):
                return f"named({self.of[name]}.class, {data})"
            case ListType(element=element):
                return f"list({data}, {self.function(element, None, depth)})"
            case MapType(element=element):
                return f"map({data}, {self.function(element, None, depth)})"
            case _:
                return f"new {self.of[type_.name or group or '']}(fields({data}))"

    def function(self, type_: Type, group: str | None, depth: int = 0) -> str:
        return f"v{depth} -> {self.read(type_, f'v{depth}', group, depth + 1)}"

    def getters(self) -> Iterator[GetterView]:
        names = NameAllocator(METHODS)
        getters = {member.name: names.allocate(LANGUAGE.in_code(member.code_name)) for member in self.root.members}
        for member in self.root.members:
            group = inside(".", member.code_name)
            yield GetterView(
                comment(about_member(member, "\n"), IN),
                f"public {self.member_type(member, group)} {getters[member.name]}()",
                LANGUAGE.in_code(member.code_name),
                [
                    f"public void {name}({self.member_type(inner, None)} value) "
                    f"{{\n{IN * 2}set({literal(path)}, value);\n{IN}}}"
                    for name, inner, path in self.setters(member, names)
                ],
            )


def _constants(enum: EnumType) -> dict[str, str]:
    """The names in code of an enum's names."""
    names = NameAllocator(TYPES)  # it would hide the type in the enum itself
    return {name: names.allocate(LANGUAGE.in_code(name)) for name in enum.names}
