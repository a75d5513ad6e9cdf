"""A component's parameters as Python: a class for each record, whose members have type, limits, default and unit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.parameters import (
    Types,
    TypeSpelling,
    about_enum,
    about_member,
    declared,
    group_of,
    path_of,
    records,
    titled,
)
from robocomp_yaml.emit.render import View, render
from robocomp_yaml.languages._shared.views import constraint_views
from robocomp_yaml.languages.python import LANGUAGE
from robocomp_yaml.languages.python.text import docstring, folded, literal, one_line
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedMember,
    Size,
    Type,
)
from robocomp_yaml.transactions.plan import FilePlan

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling as PropertySpelling

WIDTH = 92
_TAKEN = (
    "Literal Mapping Optional Parameters TABLE Values annotations bool composite constraints float int parameters "
    "plain reading str tuple"
).split()


def plan(linked: LinkedComponent) -> FilePlan:
    """`generated/parameters.py`."""
    return FilePlan("generated/parameters.py", text(*declared(linked)))


def text(parameters: Parameters, component: str, source: str) -> str:
    """The module with the parameters of a component; `source` is the path of their document."""
    types = _Types(parameters.root)
    views = [types.record(path, record) for path, record in types.records]
    constraints = constraint_views(parameters, LANGUAGE, literal)
    return render(
        "python/parameters.py.j2",
        source=one_line(source.rpartition("/")[2]),
        title=docstring(titled(f"The parameters of {component}.", parameters.doc), ""),
        imports=list(_imports(views, bool(types.enums), bool(parameters.spellings), bool(constraints))),
        enums=[types.enum(enum) for enum in types.enums],
        records=views,
        spellings=[f"{literal(spelling.path)}: {_spelling(spelling)}" for spelling in parameters.spellings],
        constraints=constraints,
    )


def _imports(views: list[View], enums: bool, spellings: bool, constraints: bool) -> Iterator[str]:
    hints = " ".join(member.hint for view in views for member in view.members)
    if "Mapping[" in hints:
        yield "from collections.abc import Mapping"
    typing = [name for name, used in (("Literal", enums), ("Optional", "Optional[" in hints)) if used]
    if typing:
        yield f"from typing import {', '.join(typing)}"
    if "Mapping[" in hints or typing:
        yield ""
    yield "from generated.runtime import parameters"
    modules = {"composite": True, "constraints": constraints, "plain": True, "reading": spellings}
    yield f"from generated.runtime.semantics import {', '.join(name for name, used in modules.items() if used)}"


_SPELLING = TypeSpelling(
    basic={"bool": "bool", "int": "int", "long": "int", "float": "float", "double": "float", "string": "str"},
    listing="tuple[{}, ...]",
    mapping="Mapping[str, {}]",
    path="`{}`",
)


class _Types(Types):
    """The classes of all records that the parameters use, with names that do not clash."""

    def __init__(self, root: RecordType) -> None:
        members = {LANGUAGE.in_code(member.code_name) for _, record in records(root)[0] for member in record.members}
        super().__init__(
            root, NameAllocator((*_TAKEN, *members)), _SPELLING
        )  # a class's members hide types of the same name

    def enum(self, enum: EnumType) -> View:
        names, about = ", ".join(map(literal, enum.names)), docstring("\n".join(about_enum(enum)), "")
        return View(name=self.of[enum.name], literal=f"Literal[{names}]", docstring=about)

    def record(self, path: str, record: RecordType) -> View:
        group = group_of(path, record)
        return View(
            name=self.of[path],
            docstring=docstring(self.about_record(path, record), "    "),
            members=[self.member(member, group) for member in record.members],
        )

    def member(self, member: ResolvedMember, group: str | None) -> View:
        """`group` is the path of the member's group, None in a struct."""
        inner = path_of(member, group)
        arguments = [self.kind(member.type, inner)]
        if member.default is not None:
            arguments.append(f"default={literal(member.default.data)}")
        arguments += [f"{word}=True" for word in ("optional", "editable") if getattr(member, word)]
        name = LANGUAGE.in_code(member.code_name)
        if name != member.name:
            arguments.append(f"key={literal(member.name)}")
        hint = self.spelled(member.type, inner)
        hint = f"Optional[{hint}]" if member.optional else hint
        return View(
            name=name,
            hint=hint,
            declaration=folded("composite.member(", arguments, ")", "    ", WIDTH),
            docstring=docstring(about_member(member, "\n\n"), "    "),
        )

    def kind(self, type_: Type, group: str | None) -> str:
        match type_:
            case BasicType():
                return _secret(type_, _plain(type_))
            case EnumType(name=name, allowed=allowed):
                return _secret(type_, f"plain.choice({', '.join(map(literal, (name, *allowed)))})")
            case ListType(element=element, size=size, unique=unique):
                words = [self.kind(element, None), *_size(size), *(["unique=True"] if unique else [])]
                return f"composite.listing({', '.join(words)})"
            case MapType(element=element, size=size):
                return f"composite.naming({', '.join((self.kind(element, None), *_size(size)))})"
            case _:
                made = "group" if type_.is_group else "record"
                return f"composite.{made}({self.spelled(type_, group)})"


def _secret(type_: BasicType | EnumType, made: str) -> str:
    return f"plain.secret({made})" if type_.secret else made


def _plain(type_: BasicType) -> str:
    limits = list(_limits(type_))
    if type_.name == "bool":
        return "plain.truth()"
    if type_.name == "string":
        return f"plain.text({', '.join(limits)})"
    made = "whole" if type_.is_integer else "decimal"
    return f"plain.{made}({', '.join((literal(type_.name), *limits))})"


def _limits(type_: BasicType) -> Iterator[str]:
    if type_.values:
        yield f"values={literal(tuple(value.value for value in type_.values))}"
    if type_.range:
        yield from (f"{name}={end!r}" for name, end in type_.range.limits.items())
    if type_.pattern is not None:
        yield f"pattern={literal(type_.pattern.portable)}"
        if type_.pattern.text != type_.pattern.portable:
            yield f"shown_as={literal(type_.pattern.text)}"
    if type_.unit:
        yield f"unit={literal(type_.unit)}"


def _size(size: Size) -> Iterator[str]:
    if size.least:
        yield f"at_least={size.least}"
    if size.most is not None:
        yield f"at_most={size.most}"


def _spelling(spelling: PropertySpelling) -> str:
    words = [literal(spelling.key)] if spelling.key else []
    words += [f"fields={literal(spelling.fields)}"] if spelling.fields else []
    words += [f"first={spelling.first}"] if spelling.first else []
    words += [f"columns={literal(spelling.columns)}"] if spelling.columns else []
    words += [f"separator={literal(spelling.separator)}"] if spelling.separator != "," else []
    words += [f"separators={literal(spelling.separators)}"] if spelling.separators else []
    words += ["trailing=True"] if spelling.trailing else []
    words += [f"count={literal(spelling.count)}"] if spelling.count else []
    return folded("reading.Spelling(", words, ")", "        ", WIDTH)
