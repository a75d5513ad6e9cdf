"""Random modules, mostly right, with odd names and now and then a fault. `Nn` in names stands for a number."""

from __future__ import annotations

from random import Random

from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import (
    BASIC_TYPES,
    Constant,
    Enum,
    Enumerator,
    ExceptionType,
    Import,
    Interface,
    Literal,
    Map,
    Member,
    Method,
    Module,
    Sequence,
    Struct,
    TypeDefinition,
    TypeRef,
)

PLAIN = ["Pose", "Scan", "Side", "Route", "left", "right", "goal", "speed", "size", "text", "update", "Busy", "near"]
ODD = [
    "OtherNn", "Class", "lambda", "self", "None", "current", "std", "linux", "NULL", "value", "object", "Out", "import",
    "a_b", "x_1", "nice", "Disp", "L", "operator", "Int", "ROBOCOMPMODULENN_ICE", "checkedCast", "String", "x" * 150,
    "RoboCompOtherNn", "ModuleNn", "prx", "HELPER", "A", "defined", "result", "context", "returnValue", "E", "clone",
]  # fmt: skip
WRONG = [
    "RoboCompModuleNn", "robocompmodulenn", "class", "Value", "Object", "out", "throws", "a__b", "_a", "a_", "iceberg",
    "IceX", "ice", "LaserPrx", "LaserPtr", "Helper", "with", "True", "DataHolder", "int", "pose", "POSE", "SIDE",
]  # fmt: skip
DOCS = [
    "Says *it*.", '"""', '""""', "ends with \\", "\\u \\x \\N{", "*/ /* //", "@param x", "{@link", "a\x00b\x0c\r",
    "é\u2028€\x85", "word " * 60, "x" * 70000, "two\n\n    paragraphs\\\n/", "#define X\n#endif", "@throws Busy", "*",
    "/", "??/", "@deprecated",
]  # fmt: skip
RIGHT_VALUES = {
    "bool": [(True, "True"), (False, "false")],
    "byte": [(0, "0"), (255, "+255")],
    "short": [(-(2**15), "-32768")],
    "int": [(2**31 - 1, "2147483647"), (0, "-0")],
    "long": [(-(2**63), "-9223372036854775808"), (2**63 - 1, "9223372036854775807")],
    "float": [(0.9, ".9"), (1e5, "1E5"), (10**30, "1" + "0" * 30), (0.0, "0e-999")],
    "double": [(2000.0, "2000."), (1e300, "+1e300"), (5e-324, "5e-324"), (3, "3"), (1e16, "1" + "0" * 16)],
    "string": [(t, "…") for t in ('a"\\\n\t\x01\x7fé??/??!', "", "/* x */ //", "\x85\u2028€😀", "x\\" * 5000)],
}
WRONG_VALUES = [
    (2**63, str(2**63)), (-1, "-1"), (1e39, "1e39"), (0.0, "1e-400"), ("x", "x"), (1, "1"),
]  # fmt: skip


class Maker:
    """Draws linked modules. `faults` is the share of choices that are made at random instead of rightly."""

    def __init__(self, seed: int, faults: float) -> None:
        self.random = Random(seed)
        self.faults = faults

    def pair(self) -> list[LinkedModule]:
        """A module and the one that it imports."""
        name = "RoboCompOtherNn" if self.rightly() else self.random.choice(["RoboCompModuleNn", "ROBOCOMPModuleNn"])
        names = self.names(self.random.randint(0, 3))
        other = LinkedModule(Module(name, "OtherNn.idsl.yaml", types=self.types(names, {})))
        self.imported = {f"OtherNn.{d.name}": d for d in other.module.types}
        names = self.names(self.random.randint(1, 8))
        cut = self.random.randint(0, len(names))
        types = self.types(names[:cut], self.imported)
        rest = names[cut:]
        exceptions = tuple(
            ExceptionType(name, self.members(types), self.doc()) for name in rest if self.random.random() < 0.2
        )
        rest = [name for name in rest if name not in [e.name for e in exceptions]]
        constants = tuple(self.constant(name, types) for name in rest if self.random.random() < 0.3)
        rest = [name for name in rest if name not in [c.name for c in constants]]
        interfaces = tuple(
            Interface(name, self.methods(types, exceptions), self.random.random() < 0.2, self.doc()) for name in rest
        )
        shuffled = list(types)
        self.random.shuffle(shuffled)
        own = Module(
            "RoboCompModuleNn", "ModuleNn.idsl.yaml", (Import("OtherNn"),), constants, tuple(shuffled), exceptions,
            interfaces, doc=self.doc(),
        )  # fmt: skip
        return [other, LinkedModule(own, [other])]

    def rightly(self) -> bool:
        return self.random.random() >= self.faults

    def names(self, count: int) -> list[str]:
        """Names that are mostly different, in whatever case."""
        drawn: dict[str, str] = {}
        for _ in range(count):
            word = self.random.choice(PLAIN + ODD) if self.rightly() else self.random.choice(WRONG)
            drawn.setdefault(word.lower() if self.rightly() else word, word)
        return list(drawn.values())

    def doc(self) -> str:
        return self.random.choice(DOCS) if self.random.random() < 0.2 else ""

    def types(self, names: list[str], imported: dict[str, TypeDefinition]) -> tuple[TypeDefinition, ...]:
        made: list[TypeDefinition] = []
        for name in names:
            kind = self.random.randrange(4)
            if kind == 0:
                made.append(Struct(name, self.members(tuple(made)) or self.members(tuple(made)), self.doc()))
            elif kind == 1:
                numbers = [None] * 16 + [0, 1, 9, 2**31 - 1]
                words = self.names(self.random.randint(1, 5))
                enumerators = (Enumerator(word, self.random.choice(numbers), self.doc()) for word in words)
                made.append(Enum(name, tuple(enumerators) if self.rightly() else (), self.doc()))
            elif kind == 2:
                made.append(Sequence(name, self.type(tuple(made)), self.doc()))
            else:
                key = TypeRef(self.random.choice(["bool", "byte", "int", "string"]))
                made.append(Map(name, key if self.rightly() else self.type(tuple(made)), self.type(tuple(made))))
        return tuple(made)

    def type(self, types: tuple[TypeDefinition, ...]) -> TypeRef:
        if not self.rightly():
            return TypeRef(self.random.choice(PLAIN + ODD + ["OtherNn.Pose"]))
        known = [*BASIC_TYPES, *(t.name for t in types), *getattr(self, "imported", ())]
        return TypeRef(self.random.choice(known))

    def members(self, types: tuple[TypeDefinition, ...]) -> tuple[Member, ...]:
        made = []
        for name in self.names(self.random.randint(1, 4) if self.rightly() else 0):
            type_ = self.type(types)
            default = self.value(type_, types) if self.random.random() < 0.4 else None
            made.append(Member(name, type_, self.doc(), self.random.choice(["", "", "m/s"]), default))
        return tuple(made)

    def value(self, type_: TypeRef, types: tuple[TypeDefinition, ...]) -> Literal | None:
        if not self.rightly():
            return Literal(*self.random.choice(WRONG_VALUES))
        if type_.is_basic:
            return Literal(*self.random.choice(RIGHT_VALUES[type_.text]))
        definition = {**{t.name: t for t in types}, **getattr(self, "imported", {})}.get(type_.text)
        if isinstance(definition, Enum) and definition.enumerators:
            name = self.random.choice(definition.enumerators).name
            return Literal(name, name)
        return None

    def constant(self, name: str, types: tuple[TypeDefinition, ...]) -> Constant:
        type_ = self.type(types)
        value = self.value(type_, types)
        if value is None:
            type_, value = TypeRef("int"), Literal(7, "7")
        return Constant(name, type_, value, self.doc())

    def methods(self, types: tuple[TypeDefinition, ...], exceptions: tuple[ExceptionType, ...]) -> tuple[Method, ...]:
        made = []
        for name in self.names(self.random.randint(0, 5)):
            parameters = [Member(n, self.type(types), self.doc()) for n in self.names(self.random.randint(0, 5))]
            cut = self.random.randint(0, len(parameters))
            throws = [TypeRef(e.name) for e in exceptions if self.random.random() < 0.5]
            throws += [] if self.rightly() else [*throws, self.type(types)]
            made.append(Method(
                name, tuple(parameters[:cut]), tuple(parameters[cut:]), self.random.choice([None, self.type(types)]),
                tuple(throws), self.random.random() < 0.3, self.doc(), returns_doc=self.doc(),
            ))  # fmt: skip
        return tuple(made)
