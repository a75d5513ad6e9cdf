"""State machines: the data model, and the syntax of conditions, values and scripts in it. Nothing is executed."""

from __future__ import annotations

import ast
import textwrap
import warnings
from collections.abc import Callable, Iterator

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.languages.record import STATEMACHINE, TargetLanguage
from robocomp_yaml.link.program import Program
from robocomp_yaml.model import conditions
from robocomp_yaml.model import statemachine as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.machine_index import MachineIndex, indexes
from robocomp_yaml.model.statemachine import NULL, PYTHON

_VALUE, _CONDITION, _SCRIPT = "the value", "the condition", "the script"
_Expression = tuple[str, Text | None]


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        language = linked.component.language.target
        for index in indexes(linked.machine) if STATEMACHINE in language.has else ():
            yield from _machine(index, language)


def _machine(index: MachineIndex, language: TargetLanguage) -> Iterator[Diagnostic]:
    """Checks a machine of a component in this language."""
    name = index.machine.datamodel or NULL
    if name not in language.datamodels:
        others = [other for other in language.datamodels if other != NULL]
        hint = f'write "{others[0]}"' if others else "remove it; then conditions consist of guards of the worker"
        yield codes.DATAMODEL.at(index.machine.datamodel_span, name=name, language=language.title, hint=hint)
    else:
        faults = _faults_in_python if name == PYTHON else _faults_in_null
        for what, text in _expressions(index):
            yield from faults(index, what, text) if text is not None else ()


def _expressions(index: MachineIndex) -> Iterator[_Expression]:
    """Every expression of a machine, with its kind: a value, a condition, a script, or the element that names a
    variable."""
    for state in index.states:
        for data in state.data:
            yield "<data>", data.id
            yield _VALUE, data.value.expr
        for invoke in state.invokes:
            yield from ((_VALUE, invoke.type.expr), (_VALUE, invoke.source.expr), ("idlocation", invoke.id_location))
            yield from _of_payload(invoke.payload)
        yield from _of_payload(state.done)
    yield from ((_CONDITION, transition.condition) for _, transition in index.transitions())
    for action in index.actions():
        yield from _of_action(action)


def _of_action(action: model.Action) -> Iterator[_Expression]:
    match action:
        case model.Send():
            for value in (action.event, action.target, action.type, action.delay):
                yield _VALUE, value.expr
            yield "idlocation", action.id_location
            yield from _of_payload(action.payload)
        case model.Cancel(id=value):
            yield _VALUE, value.expr
        case model.Log(value=value) if value is not None:
            yield _VALUE, value.expr
        case model.Assign(location=location, value=value):
            yield from (("<assign>", location), (_VALUE, value.expr))
        case model.Foreach(array=array):
            yield "<foreach>", array
        case model.Script(code=code):
            yield _SCRIPT, code
        case model.If(branches=branches):
            yield from ((_CONDITION, condition) for condition, _ in branches)


def _of_payload(payload: model.Payload) -> Iterator[_Expression]:
    yield from ((_VALUE, param.value.expr) for param in payload.params)
    if payload.content is not None:
        yield _VALUE, payload.content.expr


_READERS: dict[str, Callable[[str], object]] = {
    _VALUE: conditions.literal, _CONDITION: conditions.condition, _SCRIPT: conditions.script
}  # fmt: skip


def _faults_in_null(index: MachineIndex, what: str, text: Text) -> Iterator[Diagnostic]:
    """Checks an expression of the data model `null`, and the states in its conditions."""
    if what not in _READERS:
        yield codes.NEEDS_DATAMODEL.at(text.span, what=what)
        return
    try:
        read = _READERS[what](text.text)
    except conditions.NullSyntaxError as error:
        shown = " ".join(text.text.split())
        shown = shown if len(shown) <= 40 else f"{shown[:39]}…"
        yield codes.NOT_IN_LANGUAGE.at(text.span, what=what, text=shown, reason=str(error))
        return
    for name in conditions.names(read, conditions.IN) if isinstance(read, conditions.Condition) else ():
        if name not in index.by_id:
            yield codes.UNKNOWN_STATE.at(text.span, id=name, hint=index.similar(name))


def _faults_in_python(_: MachineIndex, what: str, text: Text) -> Iterator[Diagnostic]:
    """Checks the syntax of an expression in Python."""
    if what not in _READERS:
        return
    is_script = what == _SCRIPT
    code = textwrap.dedent(text.text.strip("\n")) if is_script else text.text.strip()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ast.parse(code, mode="exec" if is_script else "eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        reason = error.msg if isinstance(error, SyntaxError) else str(error) or "it is too deeply nested"
        yield codes.PYTHON_SYNTAX.at(text.span, what=what, reason=reason)
