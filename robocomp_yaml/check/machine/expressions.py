"""State machines: the data model, and what conditions, values and scripts say in it. Nothing is run."""

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
from robocomp_yaml.model.machine_index import MachineIndex
from robocomp_yaml.model.statemachine import (
    NULL,
    PYTHON,
    Action,
    Assign,
    Cancel,
    Foreach,
    If,
    Log,
    Param,
    Payload,
    Script,
    Send,
    StateMachine,
    Text,
    Value,
)


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        if linked.machine is not None and STATEMACHINE in linked.component.language.target.has:
            yield from of(linked.machine, linked.component.language.target)


def of(machine: StateMachine, language: TargetLanguage) -> Iterator[Diagnostic]:
    """What a machine says in a data model that a component in this language does not have."""
    index = MachineIndex(machine)
    name = machine.datamodel or NULL
    if name not in language.datamodels:
        others = [other for other in language.datamodels if other != NULL]
        hint = f'write "{others[0]}"' if others else "leave it out: then conditions are guards of the worker"
        yield codes.DATAMODEL.at(machine.datamodel_span, name=name, language=language.title, hint=hint)
    elif name == PYTHON:
        yield from _Python(index).run()
    else:
        yield from _Null(index).run()
    for invoked in index.invoked():
        yield from of(invoked, language)


class _Visitor:
    """Walks over every expression of a machine; what is wrong with each kind, the data models say."""

    def __init__(self, index: MachineIndex) -> None:
        self.index = index

    def run(self) -> Iterator[Diagnostic]:
        for state in self.index.states:
            for data in state.data:
                yield from self.variable("<data>", data.id)
                yield from self.value(data.value)
            for invoke in state.invokes:
                yield from self.value(invoke.type)
                yield from self.value(invoke.source)
                yield from self.place("idlocation", invoke.id_location)
                yield from self.payload(invoke.payload)
            yield from self.payload(state.done)
        for _, transition in self.index.transitions():
            yield from self.condition(transition.condition)
        for action in self.index.actions():
            yield from self.action(action)

    def action(self, action: Action) -> Iterator[Diagnostic]:
        match action:
            case Send():
                for value in (action.event, action.target, action.type, action.delay):
                    yield from self.value(value)
                yield from self.place("idlocation", action.id_location)
                yield from self.payload(action.payload)
            case Cancel(id=value):
                yield from self.value(value)
            case Log(value=value) if value is not None:
                yield from self.value(value)
            case Assign(location=location, value=value):
                yield from self.place("<assign>", location)
                yield from self.value(value)
            case Foreach(array=array):
                yield from self.place("<foreach>", array)
            case Script(code=code):
                yield from self.script(code)
            case If(branches=branches):
                for condition, _ in branches:
                    yield from self.condition(condition)

    def payload(self, payload: Payload) -> Iterator[Diagnostic]:
        for param in payload.params:
            yield from self.param(param)
        if payload.content is not None:
            yield from self.value(payload.content)

    def param(self, param: Param) -> Iterator[Diagnostic]:
        yield from self.value(param.value)

    def place(self, what: str, text: Text | None) -> Iterator[Diagnostic]:
        if text is not None:
            yield from self.variable(what, text)

    def variable(self, what: str, text: Text) -> Iterator[Diagnostic]:
        raise NotImplementedError

    def value(self, value: Value) -> Iterator[Diagnostic]:
        raise NotImplementedError

    def condition(self, text: Text | None) -> Iterator[Diagnostic]:
        raise NotImplementedError

    def script(self, code: Text) -> Iterator[Diagnostic]:
        raise NotImplementedError


class _Null(_Visitor):
    """Literals, guards and actions."""

    def variable(self, what: str, text: Text) -> Iterator[Diagnostic]:
        yield codes.NEEDS_DATAMODEL.at(text.span, what=what)

    def value(self, value: Value) -> Iterator[Diagnostic]:
        if value.expr is not None:
            yield from self._fits("the value", value.expr, conditions.literal)

    def script(self, code: Text) -> Iterator[Diagnostic]:
        yield from self._fits("the script", code, conditions.script)

    def condition(self, text: Text | None) -> Iterator[Diagnostic]:
        if text is None:
            return
        wrong = list(self._fits("the condition", text, conditions.condition))
        yield from wrong
        if not wrong:
            for name in conditions.names(conditions.condition(text.text), conditions.IN):
                if name not in self.index.by_id:
                    yield codes.UNKNOWN_STATE.at(text.span, id=name, hint=self.index.similar(name))

    def _fits(self, what: str, text: Text, read: Callable[[str], object]) -> Iterator[Diagnostic]:
        try:
            read(text.text)
        except conditions.NotInLanguage as error:
            shown = " ".join(text.text.split())
            shown = shown if len(shown) <= 40 else f"{shown[:39]}…"
            yield codes.NOT_IN_LANGUAGE.at(text.span, what=what, text=shown, reason=str(error))


class _Python(_Visitor):
    """Python's syntax."""

    def variable(self, what: str, text: Text) -> Iterator[Diagnostic]:
        return iter(())

    def value(self, value: Value) -> Iterator[Diagnostic]:
        if value.expr is not None:
            yield from self._parses("the value", value.expr, "eval")

    def condition(self, text: Text | None) -> Iterator[Diagnostic]:
        if text is not None:
            yield from self._parses("the condition", text, "eval")

    def script(self, code: Text) -> Iterator[Diagnostic]:
        yield from self._parses("the script", Text(textwrap.dedent(code.text.strip("\n")), code.span), "exec")

    def _parses(self, what: str, text: Text, mode: str) -> Iterator[Diagnostic]:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                ast.parse(text.text.strip() if mode == "eval" else text.text, mode=mode)
        except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
            reason = error.msg if isinstance(error, SyntaxError) else str(error) or "it is too deeply nested"
            yield codes.PYTHON_SYNTAX.at(text.span, what=what, reason=reason)
