"""A component's parameters as Java: a class for each record, getters and setters, and the run time's table."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.emit.lowering.kinds import Builders
from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.parameters import (
    Accessors,
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
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.languages._shared.text import IN
from robocomp_yaml.languages._shared.views import constraint_views
from robocomp_yaml.languages.java import LANGUAGE
from robocomp_yaml.languages.java.names import METHODS, TYPES
from robocomp_yaml.languages.java.text import comment, listed, literal, one_line, value
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
    is_secret,
)
from robocomp_yaml.transactions.plan import FilePlan


def plan(linked: LinkedComponent) -> FilePlan:
    """`generated/Parameters.java`."""
    return FilePlan("generated/Parameters.java", text(*declared(linked)))


def text(parameters: Parameters, component: str, source: str) -> str:
    """The class with the parameters of a component; `source` is the path of their document."""
    types = _Types(parameters.root)
    return render(
        "java/Parameters.java.j2",
        source=one_line(source.rpartition("/")[2]),
        comment=comment(titled(f"The parameters of {component} while it runs.", parameters.doc)),
        enums=[types.enum(enum) for enum in types.enums],
        records=[types.record(path, record) for path, record in types.records],
        getters=list(types.getters()),
        root=types.functions["."],
        spellings=[
            f"java.util.Map.entry({literal(each.path)}, new Spelling({_BUILDERS.spelling(each)}))"
            for each in parameters.spellings
        ],
        constraints=constraint_views(parameters, LANGUAGE, literal),
    )


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

    def enum(self, enum: EnumType) -> View:
        names = NameAllocator(TYPES)  # a constant hides a type of the same name in the enum
        constants = [View(name=names.allocate(LANGUAGE.in_code(name)), text=literal(name)) for name in enum.names]
        about = comment("\n".join(about_enum(enum)), IN)
        return View(name=self.of[enum.name], comment=about, constants=constants)

    def record(self, path: str, record: RecordType) -> View:
        """`function` creates the record's type in the table; `secret` are the names of secret members, as arguments."""
        group = group_of(path, record)
        secret = [literal(member.name) for member in record.members if is_secret(member.type)]
        named = f"Kind.record({literal(record.name)}{',' if record.members else ''}"
        return View(
            name=self.of[path],
            comment=comment(self.about_record(path, record), IN),
            function=self.functions[path],
            made="Kind.group(" if record.is_group else named,
            secret="".join(f", {name}" for name in secret),
            members=[self.member(member, group) for member in record.members],
        )

    def member(self, member: ResolvedMember, group: str | None) -> View:
        """`group` is the path of the member's group, None in a struct."""
        inner = path_of(member, group)
        name, key = LANGUAGE.in_code(member.code_name), literal(member.name)
        got = f"of.get({key})"
        if member.optional:
            got = f"optional({got}, {self.function(member.type, inner)})"
        else:
            got = self.read(member.type, got, inner)
        return View(
            comment=comment(about_member(member, "\n"), IN * 2),
            field=f"public final {self.member_type(member, inner)} {name};",
            read=f"this.{name} = {got};",
            kind=_BUILDERS.member(f"new Member({key}", member, self.functions, inner),
        )

    def member_type(self, member: ResolvedMember, group: str | None) -> str:
        if member.optional:
            return f"java.util.Optional<{self.spelled(member.type, group, boxed=True)}>"
        return self.spelled(member.type, group)

    def read(self, type_: Type, data: str, group: str | None = None, depth: int = 0) -> str:
        """An expression that converts data to the typed value."""
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

    def getters(self) -> Iterator[View]:
        for getter, member, setters in accessors(self.root, self):
            group = inside(".", member.code_name)
            yield View(
                comment=comment(about_member(member, "\n"), IN),
                declaration=f"public {self.member_type(member, group)} {getter}()",
                field=LANGUAGE.in_code(member.code_name),
                setters=[
                    f"public void {name}({self.member_type(inner, None)} value) "
                    f"{{\n{IN * 2}set({literal(path)}, value);\n{IN}}}"
                    for name, inner, path in setters
                ],
            )


def accessors(root: RecordType, types: _Types | None = None) -> Iterator[Accessors]:
    """The getters and setters of all parameters."""
    return (types or _Types(root)).accessors(NameAllocator(METHODS), LANGUAGE.in_code)
