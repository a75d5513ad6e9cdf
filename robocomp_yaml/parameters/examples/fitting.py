"""Examples that satisfy the constraints of a document, and in which elements that must differ are different.

The search tries few values of each parameter: the simplest ones, and those that occur in the constraints. It stops
after a limited number of steps; then there is no example, and the user has to choose one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import msgspec

from robocomp_yaml.parameters.specification.expression import Each, Expression, LiteralExpression, parts
from robocomp_yaml.parameters.types import (
    BasicType,
    ResolvedConstraint,
    EnumType,
    ListType,
    MapType,
    ResolvedMember,
    Parameters,
    RecordType,
    ScalarType,
    Type,
    leaves,
    nested,
)
from robocomp_yaml.parameters.expressions import evaluate
from robocomp_yaml.parameters.defaults import defaults, with_defaults
from robocomp_yaml.parameters.examples.example import count_of, example, reference, simplest
from robocomp_yaml.parameters.verdict.plain import wrong

_STEPS = 3000  # of one search
_MOST_STEPS = 12_000  # of all, with up to ten parameters; with more, each step takes longer
_MOST_SLOTS = 200
_VALUES = 14  # tried for one slot
_UNKNOWN = {"env": "UNKNOWN"}  # a value that is not chosen yet; constraints skip references
_COUNTS = (None, 2, 3, 0, 1, 4, 6)  # numbers of elements of lists and maps to try; None: the default of `count_of`

Path = tuple[str, ...]


class Fitted(msgspec.Struct, frozen=True):
    """Examples by path. `present` are in the document, so that it is valid. `possible` may be added to it, alone or
    together. `unknown` are the parameters without an example."""

    present: dict[Path, Any] = {}
    possible: dict[Path, Any] = {}
    unknown: set[Path] = set()


def fitted(parameters: Parameters, carried: Mapping[str, Any] | None = None) -> Fitted:
    """Examples of all parameters. `carried` are values that are already set."""
    found = Fitted()
    members = {tuple(path.split(".")): member for path, member in leaves(parameters.root)}
    carried_ = {path: value for path in members if (value := _at(carried or {}, path)) is not None}
    required = [path for path, member in members.items() if member.required and path not in carried_]
    optional = [path for path, member in members.items() if not member.required and path not in carried_]
    search = _Search(parameters, members, {**carried_})
    # First the required ones; then, if these alone have no solution, together with optional ones.
    some = [path for path in optional if search.concerns(path)]
    chosen = search.solve(required) or (search.solve([*required, *some], some) if some else None)
    if chosen is None:
        found.present.update(carried_)
        for path in required:
            alone = search.solve([path], others=False)
            if alone is None or search.concerns(path):
                found.unknown.add(path)
            else:
                found.present[path] = alone[path]
        chosen = {}
    else:
        found.present.update({**carried_, **chosen})
    together = dict(found.present)
    for path in (path for path in optional if path not in found.present):
        if members[path].default is not None:
            found.possible[path] = example(members[path])
            continue
        search.base = together
        fit = search.solve([path], both=found.present)
        if fit is None:
            found.unknown.add(path)
        else:
            found.possible[path] = together[path] = fit[path]
    return found


class _Form(msgspec.Struct, frozen=True):
    """The form of lists, maps and records: their number of elements, whether they have optional members, and names of
    maps."""

    count: int | None = None
    is_full: bool = False
    keys: tuple[str, ...] = ()


class _Slot(msgspec.Struct):
    """A plain value of an example, by the path of its parameter and the steps inside its value. `first` are tried
    first."""

    path: Path
    inside: tuple[str | int, ...]
    type: ScalarType
    first: list[Any] = []
    is_optional: bool = False

    @property
    def steps(self) -> tuple[Any, ...]:
        return (self.path, *self.inside)

    @property
    def column(self) -> tuple[Any, ...]:
        """The steps without indexes: slots of one column are in different elements of a list."""
        return tuple("" if isinstance(step, int) else step for step in self.steps)


class _Search:
    """`base` are the values that are already set, by path."""

    def __init__(self, parameters: Parameters, members: Mapping[Path, ResolvedMember], base: dict[Path, Any]) -> None:
        self.parameters, self.members, self.base = parameters, members, base
        constants = [literal for each in parameters.constraints for literal in _literals(each.expression)]
        constants += [member.default.data for member in members.values() if member.default is not None]
        self.texts = list(dict.fromkeys(each for each in constants if isinstance(each, str)))
        numbers = [each for each in constants if isinstance(each, (int, float)) and not isinstance(each, bool)]
        self.numbers = list(dict.fromkeys(numbers))
        named = [code for each in parameters.constraints for code in evaluate.paths(each.expression)]
        self.named = {path for path in members if _is_named(_code_path(parameters.root, path), named)}
        self.steps = 0
        self.left = _MOST_STEPS // max(1, len(members) // 10)
        self.is_careful = False

    def concerns(self, path: Path) -> bool:
        """Whether a constraint names a parameter."""
        return path in self.named

    def solve(
        self,
        paths: Sequence[Path],
        optional: Sequence[Path] = (),
        *,
        both: Mapping[Path, Any] | None = None,
        others: bool = True,
    ) -> dict[Path, Any] | None:
        """Values of these parameters that satisfy the constraints, together with the values in `base`, and also
        together with those in `both` alone. Parameters in `optional` have a value only if it is needed. `others`:
        constraints apply; else each value is only valid by itself. None if there is no solution."""
        constraints = self.parameters.constraints if others else ()
        self.steps = 0
        for self.is_careful in (False, True):
            for form in self._forms():
                shapes = {path: _shape(self.members[path].type, form) for path in paths}
                found = self._fill(shapes, optional, constraints, both)
                if found is not None:
                    return found
                if not constraints or self.steps >= _STEPS or self.left <= 0:
                    break
            self.steps = 0
        return None

    def _forms(self) -> Iterator[_Form]:
        for count in _COUNTS:
            for is_full in (False, True):
                yield _Form(count, is_full)
                if self.texts:
                    yield _Form(count, is_full, tuple(self.texts))

    def _fill(
        self,
        shapes: dict[Path, Any],
        optional: Sequence[Path],
        constraints: Sequence[ResolvedConstraint],
        both: Mapping[Path, Any] | None,
    ) -> dict[Path, Any] | None:
        data = {path: shape for path, shape in shapes.items() if path not in optional}
        slots = []
        for path, shape in shapes.items():
            member = self.members[path]
            found = list(_slots(member.type, shape, path, (), path in optional))
            if (constraints and self.concerns(path)) or _is_unique(member.type):
                slots += found
                continue
            for slot in found:
                value = next(iter(self._values(slot)), None)
                if value is None:
                    return None
                _put(data, slot.steps, value)
        if len(slots) > _MOST_SLOTS:
            return None
        columns = list(dict.fromkeys(slot.column for slot in slots))
        # Optional parameters decide most, so they come first. Slots that are compared with each other are neighbours.
        slots.sort(key=lambda slot: (not slot.is_optional, columns.index(slot.column)))

        def is_consistent() -> bool:
            self.steps += 1
            self.left -= 1
            return all(
                self._hold(constraints, base, data) for base in ([self.base] if both is None else [self.base, both])
            ) and all(_differs(self.members[path].type, value) for path, value in data.items())

        def search(at: int) -> bool:
            if at == len(slots):
                return is_consistent()
            slot = slots[at]
            can_be_absent = slot.is_optional and not slot.inside
            if can_be_absent:
                data.pop(slot.path, None)
                if search(at + 1):
                    return True
            for value in self._values(slot):
                if self.steps >= _STEPS or (constraints and self.left <= 0):
                    return False
                data.setdefault(slot.path, shapes[slot.path])
                _put(data, slot.steps, value)
                if is_consistent() and search(at + 1):
                    return True
            if can_be_absent:
                data.pop(slot.path, None)
            else:
                _put(data, slot.steps, _UNKNOWN)
            return False

        return dict(data) if search(0) else None

    def _hold(self, constraints: Sequence[ResolvedConstraint], base: Mapping[Path, Any], more: Mapping[Path, Any]) -> bool:
        if not constraints:
            return True
        root = self.parameters.root
        data = defaults(root)
        for path, value in {**base, **more}.items():
            _put(data, path, with_defaults(self.members[path].type, value))
        for path, member in self.members.items():  # not chosen yet
            if member.required and _at(data, path) is None:
                _put(data, path, _UNKNOWN)
        named = evaluate.by_code_names(root, data)
        return all(
            evaluate.holds(each.expression, named)
            for each in constraints
            if not self.is_careful or not any(_is_open(_at(named, path)) for path in evaluate.paths(each.expression))
        )

    def _values(self, slot: _Slot) -> list[Any]:
        """The values to try in a slot, the simplest first."""
        type_ = slot.type
        if type_.secret:
            steps = (*slot.path, *slot.inside)
            named = max(at for at, step in enumerate(steps) if isinstance(step, str))
            return [reference("_".join(map(str, steps[named:])))]
        found = [*slot.first, *islice(simplest(type_), _VALUES)]
        if isinstance(type_, BasicType) and type_.is_number:
            near = [each for each in simplest(type_) if isinstance(each, (int, float))]
            whole = sorted((each for each in near if float(each).is_integer()), key=abs)
            found = [*slot.first, *near[:1], *whole[:_VALUES], *near[-4:]]
            for number in self.numbers:
                found += [_plain(each) for each in (number, number + 1, number - 1, number / 2, number * 2, -number)]
            if type_.range is not None:
                found += [end.value for end in (type_.range.low, type_.range.high) if end is not None]
        elif isinstance(type_, BasicType) and type_.name == "string":
            found += self.texts
        return list({repr(each): each for each in found if not wrong(type_, each)}.values())


def _plain(number: float) -> int | float:
    return int(number) if float(number).is_integer() else number


def _shape(type_: Type, form: _Form) -> Any:
    """A value in which no plain value is chosen."""
    match type_:
        case ListType(element=element, size=size):
            return [_shape(element, form) for _ in range(count_of(size, form.count))]
        case MapType(element=element, size=size):
            names = [*form.keys, "name", *(f"name{n}" for n in range(1, size.least + 8))]
            return {name: _shape(element, form) for name in names[: count_of(size, form.count)]}
        case RecordType(members=members):
            return {
                m.name: _shape(m.type, form) if m.default is None else m.default.data
                for m in members
                if form.is_full or not m.optional
            }
        case _:
            return dict(_UNKNOWN)


def _slots(
    type_: Type, shape: Any, path: Path, inside: tuple[str | int, ...], is_optional: bool, first: Sequence[Any] = ()
) -> Iterator[_Slot]:
    match type_:
        case ListType(element=element) | MapType(element=element):
            for name, item in shape.items() if isinstance(shape, dict) else enumerate(shape):
                yield from _slots(element, item, path, (*inside, name), is_optional)
        case RecordType(members=members):
            for member in members:
                if member.name in shape and (member.default is None or isinstance(member.type, ScalarType)):
                    first = () if member.default is None else (member.default.data,)
                    yield from _slots(
                        member.type, shape[member.name], path, (*inside, member.name), is_optional, first
                    )
        case BasicType() | EnumType():
            yield _Slot(path, inside, type_, list(first), is_optional)


def _is_unique(type_: Type) -> bool:
    return any(isinstance(each, ListType) and each.unique for each in nested(type_))


def _is_open(data: Any) -> bool:
    """Whether data has a value that is not chosen."""
    if isinstance(data, dict):
        return data == _UNKNOWN or any(map(_is_open, data.values()))
    return isinstance(data, list) and any(map(_is_open, data))


def _put(data: Any, steps: Sequence[str | int], value: Any) -> None:
    for step in steps[:-1]:
        data = data[step]
    data[steps[-1]] = value


def _at(data: Any, path: Path) -> Any:
    for step in path:
        data = data.get(step) if isinstance(data, dict) else None
    return data


def _differs(type_: Type, value: Any) -> bool:
    """Whether the chosen elements of unique lists differ."""
    match type_:
        case ListType(element=element, unique=unique) if isinstance(value, list):
            known = [repr(item) for item in value if item != _UNKNOWN]
            return (not unique or len(set(known)) == len(known)) and all(_differs(element, item) for item in value)
        case MapType(element=element) if isinstance(value, dict):
            return all(_differs(element, item) for item in value.values())
        case RecordType(members=members) if isinstance(value, dict):
            return all(_differs(m.type, value[m.name]) for m in members if m.name in value)
        case _:
            return True


def _code_path(record: RecordType, path: Path) -> Path:
    found: list[str] = []
    for step in path:
        member = record.member(step)
        assert member is not None
        found.append(member.code_name)
        if isinstance(member.type, RecordType):
            record = member.type
    return tuple(found)


def _is_named(code: Path, named: Sequence[Path]) -> bool:
    """Whether expressions name a parameter, a value inside it, or a group around it."""
    return any(each[: len(code)] == code[: len(each)] for each in named)


def _literals(expression: Expression | Each) -> Iterator[object]:
    """The constants in an expression."""
    if isinstance(expression, LiteralExpression):
        yield expression.value
    for part in parts(expression):
        yield from _literals(part)
