"""Interfaces of IDSL as Ice has them: what a client calls, and what a servant answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import Ice
import IcePy

from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import ExceptionType, Interface, Method
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.source import tree
from robocomp_yaml.wire.composites import Members
from robocomp_yaml.wire.types import Types, id_of
from robocomp_yaml.wire.values import Data, Report, Shape, WireType, kept

RETURNS = "returns"


class Throwable:
    """An exception that a method declares. `kind` is its Python class."""

    def __init__(self, id_: str, name: str, members: Members) -> None:
        self.name, self.members = name, members
        self.kind: type[Exception] = kept(type(name, (Ice.UserException,), {"_ice_id": id_}))
        self.ice = IcePy.defineException(id_, self.kind, (), False, None, members.described(False, 0))
        self.kind._ice_type = self.ice  # type: ignore[attr-defined]

    def make(self, node: tree.Mapping, path: Path, report: Report) -> Exception:
        """The exception with the members that a mapping spells."""
        raised = self.kind()
        self.members.fill(raised, node, path, report)
        return raised


_THROWABLES: dict[Shape, Throwable] = {}


def throwable(scope: LinkedModule, definition: ExceptionType, types: Types) -> Throwable:
    """The exception of a definition. In a process, Ice knows the first exception of each type id, and no other one: so
    equal definitions share it."""
    id_, members = id_of(scope, definition.name), types.members(scope, definition.members)
    shape = (id_, members.shape)
    if shape not in _THROWABLES:
        _THROWABLES[shape] = Throwable(id_, definition.name, members)
    return _THROWABLES[shape]


class Operation:
    """A method. `results` are what it returns, under the name RETURNS, and its out parameters, in Ice's order."""

    def __init__(self, scope: LinkedModule, method: Method, types: Types, throwables: Mapping[str, Throwable]) -> None:
        self.method, self.name = method, method.name
        self.inputs = types.members(scope, method.inputs)
        outputs = types.members(scope, method.outputs)
        returns = types.of(scope, method.returns) if method.returns else None
        self.results: dict[str, WireType] = {**({RETURNS: returns} if returns else {}), **outputs.types}
        self.throws = throwables
        mode = Ice.OperationMode.Idempotent if method.idempotent else Ice.OperationMode.Normal
        plain = ((), False, 0)
        self.ice = IcePy.Operation(
            method.name, mode, mode, False, None, (),
            tuple((plain[0], one.ice, *plain[1:]) for one in self.inputs.types.values()),
            tuple((plain[0], one.ice, *plain[1:]) for one in outputs.types.values()),
            (plain[0], returns.ice, *plain[1:]) if returns else None,
            tuple(one.ice for one in throwables.values()),
        )  # fmt: skip

    def arguments(self, node: tree.Mapping, report: Report) -> tuple[Any, ...]:
        """What is passed to Ice: the inputs that a mapping spells, in their order."""
        made = _Bag()
        self.inputs.fill(made, node, (), report)
        return tuple(vars(made).values())

    def inputs_as_data(self, arguments: tuple[Any, ...]) -> dict[str, Data]:
        pairs = zip(self.inputs.types.items(), arguments, strict=True)
        return {name: type_.to_data(value) for (name, type_), value in pairs}

    def results_as_data(self, result: Any) -> dict[str, Data]:
        """What Ice returns: nothing, one value, or a tuple of them."""
        values = () if not self.results else (result,) if len(self.results) == 1 else result
        pairs = zip(self.results.items(), values, strict=True)
        return {name: type_.to_data(value) for (name, type_), value in pairs}

    def as_result(self, values: Mapping[str, Any]) -> Any:
        """What a servant returns to Ice, from Ice values by name."""
        in_order = tuple(values[name] for name in self.results)
        return None if not in_order else in_order[0] if len(in_order) == 1 else in_order

    def examples(self) -> dict[str, Any]:
        """Results to try a program with, by name."""
        return {name: type_.example(self.name if name == RETURNS else name) for name, type_ in self.results.items()}

    def example_arguments(self) -> tuple[Any, ...]:
        return tuple(type_.example(name) for name, type_ in self.inputs.types.items())


class _Bag:
    """Anything with attributes, in the order in which they were set."""


class Answer(Protocol):
    def __call__(self, operation: Operation, arguments: tuple[Any, ...]) -> Any:
        """What Ice is to return for a call; raises a declared exception."""


class WireInterface:
    """An interface or topic of a checked module, with its operations by name."""

    def __init__(self, scope: LinkedModule, interface: Interface, types: Types) -> None:
        self.scope, self.interface, self.id = scope, interface, id_of(scope, interface.name)
        found: dict[str, Throwable] = {}
        self.operations: dict[str, Operation] = {}
        for method in interface.methods:
            thrown = {}
            for ref in method.throws:
                owner = scope.find(ref)
                assert owner is not None and isinstance(owner[1], ExceptionType), ref.text
                key = id_of(owner[0], owner[1].name)
                if key not in found:
                    found[key] = throwable(owner[0], owner[1], types)
                thrown[owner[1].name] = found[key]
            self.operations[method.name] = Operation(scope, method, types, thrown)

    def servant(self, answer: Answer) -> Ice.Object:
        """An Ice object with this interface; `answer` is asked for each call, in Ice's threads."""
        ids = ("::Ice::Object", self.id)
        parts: dict[str, Any] = {
            "ice_ids": lambda self, current=None: ids,
            "ice_id": lambda self, current=None: ids[-1],
            "ice_staticId": staticmethod(lambda: ids[-1]),
        }
        for name, operation in self.operations.items():
            parts[f"_op_{name}"] = operation.ice
            parts[name] = parts[f"_{name}"] = _dispatched(operation, answer)  # Ice puts `_` before words of Python
        kind = kept(type(self.interface.name, (Ice.Object,), parts))
        kind._ice_type = IcePy.defineClass(self.id, kind, (), None, ())  # type: ignore[attr-defined]
        servant: Ice.Object = kind()
        return servant


def _dispatched(operation: Operation, answer: Answer) -> Callable[..., Any]:
    def dispatch(self: object, *arguments: Any) -> Any:
        return answer(operation, arguments[:-1])  # the last one is Ice's `current`

    return dispatch
