"""Parameters with resolved types, from parameters as written. Each component also has the parameters of `period`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, meaning
from robocomp_yaml.parameters.resolution.limits import inside, limited
from robocomp_yaml.parameters.resolution.periods import with_period
from robocomp_yaml.parameters.specification.document import ConstraintSpec, MemberSpec, ParameterDocument, TypeSpec
from robocomp_yaml.parameters.types import (
    BASIC_TYPES,
    BasicType,
    Default,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedConstraint,
    ResolvedMember,
    ScalarType,
    Type,
    innermost,
)
from robocomp_yaml.parameters.words import kind_in_words
from robocomp_yaml.source.tree import Scalar

MAX_DEPTH = 30
MAX_VALUES = 5000
_IN_TYPES = ("type", "list", "map", "enum", "struct")
_IN_PARAMETERS = ("type", "list", "map", "group")


def resolve(document: ParameterDocument, period: int | None = None) -> tuple[Parameters, list[Diagnostic]]:
    """The parameters of a document whose types can be resolved, and the problems of the others. `period` is the period
    of the component in milliseconds, if it sets one."""
    resolver = _Resolver(document)
    members = tuple(resolver.members(document.parameters, None, _IN_PARAMETERS))
    constraints = tuple(resolver.constraints(document.rules))
    types = [resolver.named(name) for name, _ in document.types]
    resolver.unused()
    root = RecordType("", members, document.doc)
    if not resolver.found and _size(root, {}) > MAX_VALUES:
        resolver.report(codes.TOO_LARGE, document.span, name="parameters", limit=MAX_VALUES, what="plain values")
    root, problems = with_period(root, period)
    found = [*resolver.found, *problems]
    sound = tuple(_sound(constraints, root, found))
    named = tuple(t for t in types if isinstance(t, EnumType) or (isinstance(t, RecordType) and t.name))
    return Parameters(root, named, sound, document.legacy, document.doc), found


def leaves_types_unknown(found: Iterable[Diagnostic]) -> bool:
    """Whether some parameters have no usable type. An invalid constraint affects no type."""
    return has_errors(fault for fault in found if fault.code != codes.BAD_EXPRESSION.id)


def _sound(
    constraints: Iterable[ResolvedConstraint], root: RecordType, found: list[Diagnostic]
) -> Iterator[ResolvedConstraint]:
    """The constraints with valid types. The others are reported in `found` and dropped."""
    for constraint in constraints:
        from robocomp_yaml.parameters.expressions.types import check_constraint  # few documents have constraints
        from robocomp_yaml.parameters.specification.expression import ExpressionError

        try:
            check_constraint(constraint.expression, root)
        except ExpressionError as error:
            assert isinstance(constraint.node, Scalar)
            if not leaves_types_unknown(found):
                location = inside(constraint.node, error.index)
                found.append(codes.BAD_EXPRESSION.at(location, problem=str(error), hint=error.hint))
        else:
            yield constraint


class _Resolver:
    def __init__(self, document: ParameterDocument) -> None:
        self.specs = dict(document.types)
        self.path = document.path
        self.found: list[Diagnostic] = []
        self.done: dict[str, Type | None] = {}
        self.open: list[str] = []
        self.used: set[str] = set()

    def report(self, code: Code, span: Span, *, hint: str | Hint = "", **facts: object) -> None:
        self.found.append(code.at(span, hint=hint, related=(), more="", fixes=(), **facts))

    def unused(self) -> None:
        if not self.found:
            for name, spec in self.specs.items():
                if name not in self.used:
                    self.report(codes.UNUSED_TYPE, spec.key_span, name=name)

    def named(self, name: str) -> Type | None:
        """The type that the document defines with this name; None if it is invalid."""
        if name in self.done:
            return self.done[name]
        spec = self.specs[name]
        if name in BASIC_TYPES:
            self.report(codes.BASIC_NAME, spec.key_span, name=name)
        self.open.append(name)
        self.done[name] = resolved = self.definition(name, spec)
        self.open.pop()
        return resolved

    def definition(self, name: str, spec: TypeSpec) -> Type | None:
        if not self.has_one_kind(spec, "type", name, _IN_TYPES):
            return None
        if spec.kind == "enum":
            names = tuple(literal.lexeme for literal, _ in spec.enumerators)
            for index, (literal, _) in enumerate(spec.enumerators):
                if literal.lexeme in names[:index]:
                    problem = f"enumerator '{literal.lexeme}' appears twice"
                    self.report(codes.UNREACHABLE, literal.span, problem=problem)
            enumerators = tuple((literal.lexeme, doc) for literal, doc in spec.enumerators)
            return limited(EnumType(name, enumerators, names, spec.doc), spec.limits, self.found)
        if spec.kind == "struct":
            record = RecordType(name, tuple(self.members(spec.members, None, _IN_PARAMETERS[:3])), spec.doc)
            return limited(record, spec.limits, self.found)
        return self.type(spec, name)

    def has_one_kind(self, spec: TypeSpec, what: str, name: str, possible: tuple[str, ...]) -> bool:
        if not spec.kinds:
            choice = ", ".join(f"{kind}: …" for kind in possible)
            self.report(codes.NO_TYPE, spec.span, what=what, name=name, hint=f"write one of {choice}")
        elif len(spec.kinds) > 1:
            kinds = " and ".join(f"'{kind}'" for kind, _ in spec.kinds)
            self.report(codes.TWO_TYPES, spec.kinds[1][1], what=what, name=name, kinds=kinds)
        return len(spec.kinds) == 1

    def type(self, spec: TypeSpec, name: str) -> Type | None:
        """The type of a parameter, a member, or the elements of a list or map. `name` is for messages."""
        if len(self.open) > MAX_DEPTH:
            self.report(codes.TOO_LARGE, spec.span, name=name, limit=MAX_DEPTH, what="nested types")
            return None
        match spec.kind:
            case "type":
                base = self.reference(spec)
            case "list" | "map":
                assert spec.element is not None
                if not self.has_one_kind(spec.element, "the element type of", name, _IN_PARAMETERS[:3]):
                    return None
                element = self.type(spec.element, name)
                if element is None:
                    return None
                base = ListType(element) if spec.kind == "list" else MapType(element)
            case _:
                return None
        return None if base is None else limited(base, spec.limits, self.found)

    def reference(self, spec: TypeSpec) -> Type | None:
        name = spec.name
        if name in BASIC_TYPES and name not in self.specs:
            return BasicType(name)
        if name not in self.specs:
            known = (*BASIC_TYPES, *self.specs)
            hint = did_you_mean(name, known, otherwise=f"there are: {', '.join(known)}")
            if hint.meant not in self.specs and (own := _FOREIGN.get(name.lower())):
                hint = meaning(name, own)
            self.report(codes.UNKNOWN_TYPE, spec.span, name=name, hint=hint)
            return None
        self.used.add(name)
        if name in self.open:
            cycle = [*self.open[self.open.index(name) :], name]
            self.report(codes.RECURSIVE_TYPE, spec.span, name=name, cycle=" → ".join(cycle))
            return None
        return self.named(name)

    def members(
        self, entries: tuple[MemberSpec, ...], editable: bool | None, possible: tuple[str, ...], *, secret: bool = False
    ) -> Iterator[ResolvedMember]:
        """Members with resolved types. A member without a valid type is reported and omitted. `secret`: the name of
        their group is the name of a secret."""
        what = "parameter" if "group" in possible else "member"
        for entry in entries:
            if not self.has_one_kind(entry.spec, what, entry.name, possible):
                continue
            own = entry.editable if entry.editable is not None else editable
            hidden = secret or secrets.is_secret(entry.name)
            type_: Type | None
            if entry.spec.kind == "group":
                type_ = RecordType("", tuple(self.members(entry.spec.members, own, possible, secret=hidden)), entry.doc)
                self.group(entry, type_)
            else:
                type_ = self.type(entry.spec, entry.name)
            if type_ is None:
                continue
            type_ = self.secret(entry, type_) if entry.secret else _secret_by_name(type_) if hidden else type_
            if entry.optional and entry.default is not None:
                self.report(codes.DEFAULT_AND_OPTIONAL, entry.default_span or entry.span, name=entry.name)
            default = None if entry.default is None else Default(entry.default.data, entry.default)
            yield ResolvedMember(
                entry.name,
                type_,
                entry.doc,
                default,
                entry.optional,
                bool(own),
                entry.secret is not None,
                entry.code_name or entry.name,
                span=entry.span,
            )

    def group(self, entry: MemberSpec, type_: RecordType) -> None:
        limited(type_, entry.spec.limits, self.found)
        problem = "does not apply to a group; set it for the members of the group"
        if entry.default is not None:
            self.report(codes.LIMIT_MISFIT, entry.default_span or entry.span, key="default", problem=problem)
        if entry.optional:
            self.report(codes.LIMIT_MISFIT, entry.span, key="optional", problem=problem)

    def secret(self, entry: MemberSpec, type_: Type) -> Type:
        """The type of a parameter with `secret: true`."""
        assert entry.secret is not None
        if entry.default is not None:
            hint = "remove the default: set {env: NAME} or {file: PATH} in a values document"
            self.report(codes.SECRET_DEFAULT, entry.default_span or entry.span, name=entry.name, hint=hint)
        if _plain_of(type_) is None:
            words = "a group" if isinstance(type_, RecordType) and type_.is_group else kind_in_words(type_)
            words += " of values that are not plain" if isinstance(type_, ListType) else ""
            self.report(codes.SECRET_MISFIT, entry.secret, name=entry.name, words=words)
            return type_
        return _as_secret(type_)

    def constraints(self, rules: tuple[ConstraintSpec, ...]) -> Iterator[ResolvedConstraint]:
        if rules:
            from robocomp_yaml.parameters.specification import expression  # Python's parser is slow to import
        for rule in rules:
            assert isinstance(rule.that, Scalar)
            try:
                tree = expression.parse(rule.that.lexeme)
            except expression.ExpressionError as error:
                location = inside(rule.that, error.index)
                self.report(codes.BAD_EXPRESSION, location, problem=str(error), hint=error.hint)
                continue
            yield ResolvedConstraint(tree, rule.that.lexeme, rule.otherwise, rule.that, span=rule.span)


def _plain_of(type_: Type) -> ScalarType | None:
    """The plain type of the elements of lists, at any depth; None if the elements are not plain."""
    while isinstance(type_, ListType):
        type_ = type_.element
    return type_ if isinstance(type_, (BasicType, EnumType)) else None


def _as_secret(type_: Type) -> Type:
    if isinstance(type_, (ListType, MapType)):
        return replace(type_, element=_as_secret(type_.element))
    return replace(type_, secret=True) if isinstance(type_, (BasicType, EnumType)) else type_


def _secret_by_name(type_: Type) -> Type:
    """The type of a parameter with the name of a secret: texts and numbers, and lists and maps of these, are secret."""
    plain = innermost(type_)
    return _as_secret(type_) if isinstance(plain, BasicType) and plain.name != "bool" else type_


_FOREIGN = {
    "integer": "int", "boolean": "bool", "str": "string", "text": "string", "number": "double", "short": "int",
    "byte": "int", "real": "double", "float32": "float", "float64": "double", "int32": "int", "int64": "long",
    "duration": "int", "path": "string", "angle": "float",
}  # fmt: skip


def _size(type_: Type, known: dict[str, int]) -> int:
    """The number of plain values in a value of a type, where a list or map counts as one element. `known` are the
    numbers of structs, which are used more than once."""
    match type_:
        case RecordType(name=name, members=members):
            if name not in known:
                size = sum(_size(member.type, known) for member in members)
                return known.setdefault(name, size) if name else size
            return known[name]
        case ListType(element=element) | MapType(element=element):
            return _size(element, known)
        case _:
            return 1
