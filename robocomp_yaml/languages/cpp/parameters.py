"""A component's parameters as C++: structs for records, a class of getters and setters, and the run time's table."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.emit.lowering.kinds import Builders, pattern_count
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
from robocomp_yaml.emit.render import View, changed, render
from robocomp_yaml.languages._shared.text import IN
from robocomp_yaml.languages._shared.views import constraint_views
from robocomp_yaml.languages.cpp import LANGUAGE
from robocomp_yaml.languages.cpp.names import names
from robocomp_yaml.languages.cpp.text import comment, folded, literal, number, one_line, string, value
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    Parameters,
    RecordType,
    ResolvedMember,
)
from robocomp_yaml.transactions.plan import FilePlan

_TYPES_TAKEN = ("Values", "table", "fromValue", "toValue", "of")
_METHODS_TAKEN = ("Parameters", "change", "listen", "live_", "now", "set")


def plan(linked: LinkedComponent) -> list[FilePlan]:
    """`generated/parameters.h` and `.cpp`."""
    return [FilePlan(f"generated/{name}", made) for name, made in texts(*declared(linked)).items()]


def texts(parameters: Parameters, component: str, source: str) -> dict[str, str]:
    """Header and source file of a component's parameters; `source` is the path of their document."""
    types = _Types(parameters.root)
    views = [types.record(path, record) for path, record in types.records]
    headers = [
        *(["expressions.h"] if parameters.constraints else []), "kinds.h",
        *(["pattern.h"] if pattern_count(parameters.root) else []),
    ]  # fmt: skip
    enums = [types.enum(enum) for enum in types.enums]
    view = View(
        source=one_line(source.rpartition("/")[2]),
        name=component,
        comment=comment(titled(f"The parameters of {component} while it runs.", parameters.doc)),
        enums=enums,
        records=views,
        converted=[*(enum.name for enum in enums), *(view.name for view in views)],
        getters=list(types.getters()),
        headers=headers,
        root=types.functions["."],
        spellings=[
            folded(f"{{{literal(each.path)}, runtime::Spelling{{{_BUILDERS.spelling(each)}}}}},", 3 * IN)
            for each in parameters.spellings
        ],
        constraints=[
            changed(each, value=folded(f"{each.value},", 4 * IN))
            for each in constraint_views(parameters, LANGUAGE, literal)
        ],
    )
    return {f"parameters.{suffix}": render(f"cpp/parameters.{suffix}.j2", view) for suffix in ("h", "cpp")}


_SPELLING = TypeSpelling(
    basic={
        "bool": "bool", "int": "int", "long": "long long", "float": "float", "double": "double",
        "string": "std::string",
    },
    listing="std::vector<{}>",
    mapping="std::map<std::string, {}>",
    own="parameters::{}",
)  # fmt: skip
_BUILDERS = Builders(
    prefix="runtime::",
    text=literal,
    value=value,
    listed=lambda items: f"{{{', '.join(items)}}}",
    pattern=lambda pattern: f"runtime::pattern({string(pattern)})",
)


class _Types(Types):
    """The C++ types of all enums and records that the parameters use, with names that do not clash."""

    def __init__(self, root: RecordType) -> None:
        taken = names(_TYPES_TAKEN)
        super().__init__(root, taken, _SPELLING)
        self.functions = {path: taken.allocate(f"kindOf{self.of[path]}") for path, _ in self.records}
        self.enumerators = {enum.name: _enumerators(enum) for enum in self.enums}
        self.tables = {enum.name: taken.allocate(f"namesOf{self.of[enum.name]}") for enum in self.enums}

    def enum(self, enum: EnumType) -> View:
        return View(
            name=self.of[enum.name],
            names=self.tables[enum.name],
            comment=comment("\n".join(about_enum(enum))),
            enumerators=[f"{name}," for name in self.enumerators[enum.name].values()],
            literals=[f"{literal(name)}," for name in enum.names],
        )

    def record(self, path: str, record: RecordType) -> View:
        group = group_of(path, record)
        return View(
            name=self.of[path],
            comment=comment(self.about_record(path, record)),
            function=self.functions[path],
            made="runtime::group(" if record.is_group else f"runtime::record({literal(record.name)}, ",
            members=[self.member(member, group) for member in record.members],
        )

    def member(self, member: ResolvedMember, group: str | None) -> View:
        """`group` is the path of the member's group, None in a struct."""
        inner = path_of(member, group)
        name, key = LANGUAGE.in_code(member.code_name), string(member.name)
        made = _BUILDERS.member(f"runtime::Member({key}", member, self.functions, inner)
        initial = self.initial(member)
        return View(
            comment=comment(about_member(member, "\n"), IN),
            field=f"{self.member_type(member, inner)} {name}{f' = {initial}' if initial else '{}'};",
            kind=folded(f"{made},", 2 * IN),
            read=f"fromValue(value[{key}], to.{name});",
            write=f"runtime::putMember(made, {key}, value.{name});",
        )

    def member_type(self, member: ResolvedMember, group: str | None) -> str:
        made = self.spelled(member.type, group)
        return f"std::optional<{made}>" if member.optional else made

    def initial(self, member: ResolvedMember) -> str:
        """The initializer of the member: its value before the config is read, and in a record that code creates."""
        data = member.default.data if member.default is not None else None
        match member.type:
            case EnumType(name=name) if isinstance(data, str):
                return f"parameters::{self.of[name]}::{self.enumerators[name][data]}"
            case BasicType() if isinstance(data, bool):
                return "true" if data else "false"
            case BasicType() if isinstance(data, str):
                return string(data)
            case BasicType(name=name) if isinstance(data, (int, float)):
                if name in ("int", "long"):
                    return number(int(data))
                return f"{float(data)!r}{'f' if name == 'float' else ''}"
        return ""

    def getters(self) -> Iterator[View]:
        for name, member, setting in accessors(self.root, self):
            group = inside(".", member.code_name)
            made = self.member_type(member, group)
            field = LANGUAGE.in_code(member.code_name)
            if member.optional or isinstance(member.type, (BasicType, EnumType)):
                body = f"return live_.now().{field};"
            else:
                made, body = f"runtime::Held<{made}>", f"return live_.held(&parameters::Values::{field});"
            setters = [(setter, self.argument(inner), path) for setter, inner, path in setting]
            yield View(
                comment=comment(about_member(member, "\n"), IN),
                declaration=f"{made} {name}() const;",
                definition=f"{made} Parameters::{name}() const\n{{\n{IN}{body}\n}}",
                setters=[f"void {setter}({type_} value);" for setter, type_, _ in setters],
                setter_definitions=[_setter(*setter) for setter in setters],
            )

    def argument(self, member: ResolvedMember) -> str:
        made = self.member_type(member, None)
        is_small = isinstance(member.type, (BasicType, EnumType)) and made != "std::string" and not member.optional
        return made if is_small else f"const {made}&"


def accessors(root: RecordType, types: _Types | None = None) -> Iterator[Accessors]:
    """The getters and setters of all parameters."""
    return (types or _Types(root)).accessors(names(_METHODS_TAKEN), LANGUAGE.in_code)


def _enumerators(enum: EnumType) -> dict[str, str]:
    """The name in code of each name of an enum."""
    taken = names()
    return {name: taken.allocate(LANGUAGE.in_code(name)) for name in enum.names}


def _setter(name: str, type_: str, path: str) -> str:
    body = f"{IN}using runtime::toValue;\n{IN}live_.store().change({{{{{literal(path)}, toValue(value)}}}});"
    return f"void Parameters::{name}({type_} value)\n{{\n{body}\n}}"
