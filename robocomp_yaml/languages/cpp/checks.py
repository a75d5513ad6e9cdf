"""Names that are illegal in C++ after Ice's mapping. Slice and Python accept them, so they are errors only if a
component in C++ needs the module. In migrated documents they are warnings: the names are in use elsewhere too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import msgspec

from robocomp_yaml.check.idsl.names import fault_of
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.emit.lowering.types import results
from robocomp_yaml.languages._shared.checks import needed_by, result_structs, users
from robocomp_yaml.languages.cpp import LANGUAGE
from robocomp_yaml.languages.cpp.globals import GLOBALS
from robocomp_yaml.languages.cpp.macros import EVER, FAMILIES, is_macro
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.references import Identifier, exceptions_of, groups, kind_of, types_of
from robocomp_yaml.model.interface import Enum, ExceptionType, Interface, Member, Method, Module, Struct, TypeRef
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.migrated import is_migrated
from robocomp_yaml.source.recall import recalled

_GENERATED = frozenset(("GenericWorker", "Parameters", "SpecificWorker", "Worker", "main"))


def check(program: Program) -> Iterator[Diagnostic]:
    by_module = users(program, LANGUAGE)
    for linked in program.modules.values():
        users_of_it = by_module[linked]

        def found(disk: Disk) -> tuple[Diagnostic, ...]:
            return tuple(_Module(linked, users_of_it, disk).check())  # noqa: B023

        part = "module in C++", linked.module.path
        yield from recalled(program.memory, program.disk, part, (linked, *users_of_it), found)


def has_taken(module: Module) -> bool:
    """Whether the names of a module prevent some component in C++ from being built."""
    return any(_Module(LinkedModule(module), [], Disk(), for_any=True).check())


class _Module(msgspec.Struct):
    """With `for_any`, a name is also reported if only some component in C++ could fail to build with it."""

    linked: LinkedModule
    users: list[LinkedComponent]
    disk: Disk
    for_any: bool = False

    def check(self) -> Iterator[Diagnostic]:
        module = self.linked.module
        yield from self.macro(Identifier("module", module.name, module.span))
        yield from self.module_name()
        for definition in module.definitions:
            yield from self.macro(Identifier(kind_of(definition), definition.name, definition.span))
            inside = list(groups(definition))
            for group in inside:
                for name in group:
                    yield from self.macro(name)
            match definition:
                case Struct():
                    # Ice's C++11 mapping, which components use, has no other name for it; the older mapping has.
                    for name in (name for group in inside for name in group if name.text == definition.name):
                        yield _clash(name)
                case ExceptionType(members=members):
                    yield from self.same_names([name for group in inside for name in group], {definition.name})
                    yield from self.hidden(members, "member")
                    yield from self.named_as_enum(members)
                case Interface(methods=methods):
                    used = {ref.text for ref in (*types_of(definition), *exceptions_of(definition))}
                    yield from self.same_names(inside[0] if methods else [], used)
                    for method in methods:
                        yield from self.hidden((*method.inputs, *method.outputs), "parameter")
                        yield from self.in_result(method)
                    yield from self.results(definition)

    def macro(self, name: Identifier) -> Iterator[Diagnostic]:
        if name.text not in EVER and not name.text.startswith(FAMILIES):
            return  # the usual case: users need not be examined
        hit = [user for user in self.users if _is_macro_for(name.text, user)]
        if hit or name.text in EVER or self.for_any:
            yield self.reported(
                codes.CPP_MACRO.at(name.span, kind=name.kind, name=name.text, hint=_other(name.text)), hit
            )

    def module_name(self) -> Iterator[Diagnostic]:
        """A module becomes a namespace beside the functions of the C library and the classes of a component."""
        name, span = self.linked.module.name, self.linked.module.span
        if name in EVER:
            return
        if name in GLOBALS or name in _GENERATED:
            owner = "something of each component" if name in _GENERATED else "something in the system's headers"
            hint = f"call it 'RoboComp{name[0].upper()}{name[1:]}'"
            yield self.reported(codes.CPP_GLOBAL.at(span, name=name, owner=owner, hint=hint), self.users)

    def same_names(self, names: Iterable[Identifier], taken: set[str]) -> Iterator[Diagnostic]:
        """In Ice's C++, a member cannot have the name of its exception, nor a method that of a type which it uses."""
        for name in names:
            if name.text in taken:
                yield self.clash(name)

    def hidden(self, members: tuple[Member, ...], kind: str) -> Iterator[Diagnostic]:
        """In a list of parameters, a name hides the type of the same name from the parameters after it."""
        for number, member in enumerate(members):
            if any(self.is_own(other.type, member.name) for other in members[number + 1 :]):
                yield self.clash(Identifier(kind, member.name, member.span))

    def named_as_enum(self, members: tuple[Member, ...]) -> Iterator[Diagnostic]:
        """The constructor of an exception takes enums by value, where a member of the same name hides the type."""
        for number, member in enumerate(members):
            behind = members[number + 1 :]
            if any(self.is_own(other.type, member.name) for other in behind):
                continue  # reported as hidden
            if any(self.is_own(other.type, member.name) and self.is_enum(other.type) for other in members):
                yield self.clash(Identifier("member", member.name, member.span))

    def in_result(self, method: Method) -> Iterator[Diagnostic]:
        """A method with several results returns a struct, whose members have the names of the outputs."""
        types = results(method)
        if len(types) < 2:
            return
        for number, output in enumerate(method.outputs):
            hides = any(self.is_own(other.type, output.name) for other in method.outputs[number + 1 :])
            if not hides and any(self.is_own(ref, output.name) for ref in types):
                yield self.clash(Identifier("parameter", output.name, output.span))

    def results(self, interface: Interface) -> Iterator[Diagnostic]:
        """The name of that struct."""
        made = result_structs(interface)
        for method in interface.methods:
            if method.name in made:
                yield self.clash(Identifier("method", method.name, method.span))
        for ref in types_of(interface):
            if ref.name in made and self.is_own(ref, ref.name):
                method = made[ref.name]
                yield self.clash(Identifier("method", method.name, method.span), ref.name)

    def is_own(self, ref: TypeRef, name: str) -> bool:
        """Whether a type is the one of this module that has the name; types of others are written with their module."""
        if ref.name != name or ref.is_basic:
            return False
        found = self.linked.find(ref)
        return found is not None and found[0].module.name == self.linked.module.name

    def is_enum(self, ref: TypeRef) -> bool:
        found = self.linked.find(ref)
        return found is not None and isinstance(found[1], Enum)

    def clash(self, name: Identifier, other: str = "") -> Diagnostic:
        return self.reported(_clash(name, other), self.users)

    def reported(self, diagnostic: Diagnostic, users: list[LinkedComponent]) -> Diagnostic:
        """An error if a component needs the module and the document was not migrated, else what it is by default."""
        if not users or is_migrated(diagnostic.span.file, self.disk):
            return diagnostic
        related = (*diagnostic.related, needed_by(users[0]))
        return msgspec.structs.replace(diagnostic, severity=ERROR, related=related)


def _clash(name: Identifier, other: str = "") -> Diagnostic:
    first = name.text[0].lower() + name.text[1:]
    better = first if first != name.text else f"the{name.text[0].upper()}{name.text[1:]}"
    hint = f"call it '{better}'" if not other else f"rename the method: its results become a '{other}'"
    return codes.CPP_NAME.at(name.span, kind=name.kind, name=name.text, hint=hint)


def _is_macro_for(name: str, user: LinkedComponent) -> bool:
    component = user.component
    has_qt = component.gui is not None or component.compatibility != ""
    return is_macro(name, component.language.standard or LANGUAGE.standards[0], has_qt)


def _other(name: str) -> str:
    """The hint with a name that C++ and Slice accept."""
    better = name.lower()
    if better == name or better in EVER or better.startswith(FAMILIES) or fault_of(better) is not None:
        better = f"{name.lower()}Value"
    return f"call it '{better}'" if fault_of(better) is None else "choose another name"
