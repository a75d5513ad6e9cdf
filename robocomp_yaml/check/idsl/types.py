"""References to types and exceptions: that each names something, and something of the right kind."""

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

# How other languages call the basic types.
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
MOST_SUGGESTIONS = 100  # in a run: each compares a word with every name in reach
_MEANT = {foreign: ours for ours, others in _FOREIGN.items() for foreign in others.split()}


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
    """What helps to explain a name that is not found; made only when there is one."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self._by_name: dict[tuple[str, bool], list[Module]] = {}
        self._suggestions_left = MOST_SUGGESTIONS

    def meant(self, word: str, candidates: Iterator[str], given: Container[str]) -> Hint:
        self._suggestions_left -= 1
        return did_you_mean(word, candidates, given) if self._suggestions_left >= 0 else NO_HINT

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
    """`thrown` are the exceptions of the same list, None for a type."""
    found = None if ref.is_basic else linked.find(ref)
    if found is None:
        if ref.module not in linked.unresolved:
            code = codes.UNKNOWN_TYPE if thrown is None else codes.UNKNOWN_EXCEPTION
            yield code.at(ref.span, name=ref.text, hint=_hint(linked, ref, index, thrown))
    elif not isinstance(found[1], TypeDefinition if thrown is None else ExceptionType):
        kind = kind_of(found[1])
        code, hint = codes.NOT_A_TYPE, "a type is a basic one, or one defined under `types:`"
        if thrown is not None:
            code, hint = codes.NOT_AN_EXCEPTION, "an exception is defined under `exceptions:`"
        related = [Related(f"the {kind} stands here", found[1].span)]
        yield code.at(ref.span, name=ref.text, kind=kind, hint=hint, related=related)


def _thrown_once(linked: LinkedModule, method: Method) -> Iterator[Diagnostic]:
    """`Other.Failed` and `RoboCompOther.Failed` are the same exception."""
    for other, ref in repeated(method.throws, lambda ref: linked.find(ref) or ref.text):
        yield codes.THROWN_TWICE.at(
            ref.span,
            method=method.name,
            name=ref.text,
            hint="remove one of them",
            related=[Related("it stands here first", other.span)],
            fixes=[removal(ref.span)],
        )


def _hint(linked: LinkedModule, ref: TypeRef, index: _Definers, thrown: set[str] | None) -> Hint:
    """How to mend a name that is not there; `thrown` are the exceptions of the same list, None for a type."""
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
                f"write '{module.stem}.{ref.name}': a name of another module stands behind that module's",
                ref.text,
                f"{module.stem}.{ref.name}",
                len(definers) == 1,
            )
    if definers:
        full = f"{definers[0].stem}.{ref.name}"
        said = f"add {definers[0].stem} to `imports`"
        if full == ref.text:
            return Hint(said, imports=definers[0].stem)
        return Hint(f"{said}, and write '{full}'", ref.text, full, imports=definers[0].stem)
    meant = index.meant(ref.text, _known(linked, exception), thrown or ())
    return meant or Hint("define it, or import the module that does")


def _known(linked: LinkedModule, exception: bool) -> Iterator[str]:
    """The names that could stand there."""
    wanted = ExceptionType if exception else TypeDefinition
    yield from (d.name for d in linked.module.definitions if isinstance(d, wanted))
    if not exception:
        yield from BASIC_TYPES
    for imported in linked.imports:
        yield from (f"{imported.module.stem}.{d.name}" for d in imported.module.definitions if isinstance(d, wanted))
