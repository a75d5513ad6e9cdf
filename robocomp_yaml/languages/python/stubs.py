"""Stubs (`.pyi`) of the Slice modules, for editors and type checkers: only Ice creates the modules, at run time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robocomp_yaml.emit.render import View
from robocomp_yaml.languages._shared.text import IN
from robocomp_yaml.languages.python.names import module_variable, parameters, proxy_method, python_name
from robocomp_yaml.languages.python.text import about, docstring, signature
from robocomp_yaml.languages.python.types import argument_hint, hint, qualified, result_hint
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Constant, Definition, Enum, ExceptionType, Interface, Member, Struct


def stub(linked: LinkedModule) -> View:
    """The stub of a Slice module. It is shown as a class, which is a name space too."""
    module = linked.module
    return View(
        variable=module_variable(module.name),
        docstring=docstring(module.doc or module.name, IN),
        constants=[f"{python_name(c.name)}: {hint(c.type, linked)}" for c in module.constants],
        classes=[view for definition in module.definitions for view in _classes(definition, linked)],
    )


def _class(header: str, doc: str, attributes: Sequence[str] = (), methods: Sequence[View] = ()) -> View:
    """A class: `header` from the name to the colon, attributes, and methods."""
    return View(header=header, docstring=doc, attributes=attributes, methods=methods)


def _classes(definition: Definition, linked: LinkedModule) -> Iterator[View]:
    doc = docstring(definition.doc or definition.name, IN * 2)
    name = python_name(definition.name)
    match definition:
        case Enum(enumerators=enumerators):
            own = qualified(linked, definition.name)
            values = [f"{python_name(enumerator.name)}: {own}" for enumerator in enumerators]
            yield _class(f"{name}(Ice.EnumBase)", doc, values)
        case Struct(members=members):
            yield _record(name, doc, members, linked)
        case ExceptionType(members=members):
            yield _record(f"{name}(Ice.UserException)", doc, members, linked)
        case Interface():
            yield _class(f"{name}(Ice.Object)", doc)
            methods = list(_proxy_methods(definition, linked))
            older = [f"{each}_{method.name}: Any" for method in definition.methods for each in ("begin", "end")]
            yield _class(f"{definition.name}Prx(Ice.ObjectPrx)", doc, older, methods)
        case Constant() | _:
            return


def _record(header: str, doc: str, members: Sequence[Member], linked: LinkedModule) -> View:
    """A struct or exception. Its constructor accepts every member, by position or by name."""
    fields = [f"{python_name(member.name)}: {hint(member.type, linked)}" for member in members]
    given = [f"{python_name(member.name)}: {argument_hint(member.type, linked)} = ..." for member in members]
    notes = [f"  # {note}" if (note := about(member)) else "" for member in members]
    made = signature("__init__", given, "None", IN * 2)
    attributes = [field + note for field, note in zip(fields, notes, strict=True)]
    return _class(header, doc, attributes, [View(signature=made, docstring="...")])


def _proxy_methods(interface: Interface, linked: LinkedModule) -> Iterator[View]:
    """Each operation, and its variant with a future."""
    for method in interface.methods:
        names = list(parameters((member.name for member in method.inputs), ()))
        typed = [f"{n}: {argument_hint(m.type, linked)}" for n, m in zip(names, method.inputs, strict=True)]
        context = f"{'context_' if 'context' in names else 'context'}: dict[str, str] | None = ..."
        result = result_hint(method, linked)
        made = signature(proxy_method(method.name), [*typed, context], result, IN * 2)
        yield View(signature=made, docstring=docstring(method.doc or f"{interface.name}.{method.name}", IN * 3))
        future = signature(f"{method.name}Async", [*typed, context], f"Ice.InvocationFuture[{result}]", IN * 2)
        yield View(signature=future, docstring="...")
