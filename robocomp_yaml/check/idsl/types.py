"""References to types and exceptions: unknown ones, those of a wrong kind, and repetitions."""

from __future__ import annotations

from collections.abc import Container, Iterator

from robocomp_yaml.check import repeated
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import NO_HINT, Hint, removal
from robocomp_yaml.diag.suggest import did_you_mean, meaning
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.link.references import kind_of, types_of
from robocomp_yaml.model.interface import BASIC_TYPES, ExceptionType, Interface, Method, Module, TypeDefinition, TypeRef

# The names of basic types in other languages.
_FOREIGN = {
    "bool": "boolean Boolean Bool",
    "byte": "char uint8 uint8_t int8 int8_t octet",
    "short": "int16 int16_t",
    "int": "integer Integer int32 int32_t Int",
    "long": "int64 int64_t Long",
    "float": "float32 real single Float",
    "double": "float64 Double",
    "string": "str text String wstring",
}
MOST_SUGGESTIONS = 100  # in a run, because each compares a word with all known names
_MEANT = {foreign: name for name, others in _FOREIGN.items() for foreign in others.split()}


def check(program: Program) -> Iterator[Diagnostic]:
    index = _Definers(program)
    for linked in program.modules.values():
        for definition in linked.module.definitions:
            for ref in types_of(definition):
                yield from _resolved(linked, ref, index) if not ref.is_basic else ()
            for method in definition.methods if isinstance(definition, Interface) else ():
                yield from _thrown_once(linked, method)
                for ref in method.throws:
                    yield from _resolved(linked, ref, index, {other.text for other in method.throws})


class _Definers:
    """The modules that define a name, for hints. It is filled when the first name is unknown."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self._by_name: dict[tuple[str, bool], list[Module]] = {}
        self._suggestions_left = MOST_SUGGESTIONS

    def meant(self, word: str, candidates: Iterator[str], others: Container[str]) -> Hint:
        self._suggestions_left -= 1
        return did_you_mean(word, candidates, others) if self._suggestions_left >= 0 else NO_HINT

    def definers(self, name: str, exception: bool) -> list[Module]:
        """The modules that define a type, or an exception, of this name, in order of their paths."""
        if not self._by_name:
            for linked in sorted(self.program.modules.values(), key=lambda linked: linked.module.path):
                for definition in (*linked.module.types, *linked.module.exceptions):
                    key = (definition.name, isinstance(definition, ExceptionType))
                    self._by_name.setdefault(key, []).append(linked.module)
        return self._by_name.get((name, exception), [])


def _resolved(
    linked: LinkedModule, ref: TypeRef, index: _Definers, thrown: set[str] | None = None
) -> Iterator[Diagnostic]:  # fmt: skip
    """Reports a reference that is unknown or of a wrong kind. `thrown` are the exceptions of the same list, None for a
    type."""
    target = None if ref.is_basic else linked.find(ref)
    if target is None:
        if ref.module not in linked.unresolved:
            code = codes.UNKNOWN_TYPE if thrown is None else codes.UNKNOWN_EXCEPTION
            yield code.at(ref.span, name=ref.text, hint=_hint(linked, ref, index, thrown))
    elif not isinstance(target[1], TypeDefinition if thrown is None else ExceptionType):
        kind = kind_of(target[1])
        code, hint = codes.NOT_A_TYPE, "use a basic type, or one that is defined under `types:`"
        if thrown is not None:
            code, hint = codes.NOT_AN_EXCEPTION, "define it under `exceptions:`"
        related = [Related(f"the {kind}", target[1].span)]
        yield code.at(ref.span, name=ref.text, kind=kind, hint=hint, related=related)


def _thrown_once(linked: LinkedModule, method: Method) -> Iterator[Diagnostic]:
    """Reports exceptions that a method lists twice. `Other.Failed` and `RoboCompOther.Failed` are the same."""
    for other, ref in repeated(method.throws, lambda ref: linked.find(ref) or ref.text):
        yield codes.THROWN_TWICE.at(
            ref.span,
            method=method.name,
            name=ref.text,
            hint="remove one of them",
            related=[Related("the first one", other.span)],
            fixes=[removal(ref.span)],
        )


def _hint(linked: LinkedModule, ref: TypeRef, index: _Definers, thrown: set[str] | None) -> Hint:
    """The hint at an unknown name; `thrown` are the exceptions of the same list, None for a type."""
    exception = thrown is not None
    if not exception and ref.text == "void":
        return Hint("a method that returns nothing has no `returns`")
    if not exception and ref.text in _MEANT:
        return meaning(ref.text, _MEANT[ref.text])
    definers = index.definers(ref.name, exception)
    if ref.module:
        definers = [m for m in definers if ref.module in (m.name, m.stem)] or definers
    for module in definers:
        is_imported = any(other.module is module for other in linked.imports)
        if is_imported and ref.module:
            return meaning(ref.text, f"{module.stem}.{ref.name}")
        if is_imported:
            return Hint(
                f"write '{module.stem}.{ref.name}': names of other modules need the module's name",
                ref.text,
                f"{module.stem}.{ref.name}",
                len(definers) == 1,
            )
    if definers:
        full = f"{definers[0].stem}.{ref.name}"
        words = f"add {definers[0].stem} to `imports`"
        if full == ref.text:
            return Hint(words, imports=definers[0].stem)
        return Hint(f"{words}, and write '{full}'", ref.text, full, imports=definers[0].stem)
    meant = index.meant(ref.text, _known(linked, exception), thrown or ())
    return meant or Hint("define it, or import the module that defines it")


def _known(linked: LinkedModule, exception: bool) -> Iterator[str]:
    """All names of types, or of exceptions, that a reference can have."""
    kinds = ExceptionType if exception else TypeDefinition
    yield from (d.name for d in linked.module.definitions if isinstance(d, kinds))
    if not exception:
        yield from BASIC_TYPES
    for imported in linked.imports:
        yield from (f"{imported.module.stem}.{d.name}" for d in imported.module.definitions if isinstance(d, kinds))
