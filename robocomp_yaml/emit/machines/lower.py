"""Lowers the model of a state machine, which has no errors, to tables."""

from __future__ import annotations

from robocomp_yaml.model import conditions
from robocomp_yaml.model import statemachine as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.semantics import tables


def lower(machine: model.StateMachine) -> tables.Machine:
    """The tables of a state machine."""
    return _Lowering(machine).run()


class _Lowering:
    def __init__(self, machine: model.StateMachine) -> None:
        self.machine = machine
        self.is_python = machine.datamodel == model.PYTHON
        self.flat: list[tuple[model.State, int]] = []  # with the number of the parent
        self.children: list[list[int]] = []
        self._flatten(machine.root, tables.NOWHERE)
        self.numbers = {state.id: number for number, (state, _) in enumerate(self.flat) if state.id}
        self.transitions: list[tables.Transition] = []
        self.machines: list[tables.Machine] = []

    def run(self) -> tables.Machine:
        states = tuple(self._state(number) for number in range(len(self.flat)))
        return tables.Machine(
            self.machine.name,
            self.machine.datamodel or model.NULL,
            self.machine.late,
            states,
            tuple(self.transitions),
            self._actions(self.machine.scripts),
            tuple(self.machines),
        )

    def _flatten(self, state: model.State, parent: int) -> None:
        number = len(self.flat)
        self.flat.append((state, parent))
        self.children.append([])
        if parent >= 0:
            self.children[parent].append(number)
        for child in state.states:
            self._flatten(child, number)

    def _state(self, number: int) -> tables.State:
        state, parent = self.flat[number]
        transitions = tuple(self._transition(transition, number) for transition in state.transitions)
        initial = self._transition(state.initial, number) if state.initial else tables.NOWHERE
        return tables.State(
            state.id,
            state.kind,
            parent,
            tuple(self.children[number]),
            transitions,
            initial,
            state.deep,
            tuple(tables.Block(self._actions(block)) for block in state.entry),
            tuple(tables.Block(self._actions(block)) for block in state.exit),
            tuple(tables.Param(data.id.text, self._value(data.value)) for data in state.data),
            tuple(self._invoke(invoke) for invoke in state.invokes),
            self._params(state.done),
            self._value(state.done.content),
        )

    def _transition(self, transition: model.Transition, source: int) -> int:
        self.transitions.append(
            tables.Transition(
                source,
                tuple(event.text for event in transition.events),
                self._condition(transition.condition),
                tuple(self.numbers[target.text] for target in transition.targets),
                transition.internal,
                self._actions(transition.actions),
            )
        )
        return len(self.transitions) - 1

    def _condition(self, text: Text | None) -> tables.Condition:
        if text is None:
            return tables.Condition()
        if self.is_python:
            return tables.Condition("expr", text.text)
        return self._lowered(conditions.condition(text.text))

    def _lowered(self, condition: conditions.Condition) -> tables.Condition:
        if condition.kind == conditions.IN:
            return tables.Condition("in", condition.name, self.numbers.get(condition.name, tables.NOWHERE))
        parts = tuple(self._lowered(part) for part in condition.parts)
        return tables.Condition(condition.kind, condition.name, parts=parts)

    def _value(self, value: model.Value | None, attribute: bool = False) -> tables.Value:
        """`attribute`: a literal is a text, not an expression."""
        if value is None:
            return tables.Value()
        if value.expr is not None:
            if self.is_python:
                return tables.Value("expr", value.expr.text)
            return tables.Value("literal", conditions.literal(value.expr.text))
        if value.machine is not None:
            self.machines.append(lower(value.machine))
            return tables.Value("machine", machine=len(self.machines) - 1)
        if value.literal is None:
            return tables.Value()
        if attribute:
            return tables.Value("literal", conditions.quoted(value.literal))
        return tables.Value("text", value.literal)

    def _params(self, payload: model.Payload) -> tuple[tables.Param, ...]:
        return tuple(tables.Param(param.name, self._value(param.value)) for param in payload.params)

    def _invoke(self, invoke: model.Invoke) -> tables.Invoke:
        return tables.Invoke(
            self._value(invoke.type, True),
            self._value(invoke.source, True),
            invoke.id,
            _name(invoke.id_location),
            self._params(invoke.payload),
            self._value(invoke.payload.content),
            invoke.autoforward,
            self._actions(invoke.finalize or ()),
        )

    def _actions(self, block: model.Block) -> tuple[tables.Action, ...]:
        return tuple(lowered for action in block for lowered in self._action(action))

    def _action(self, action: model.Action) -> list[tables.Action]:
        match action:
            case model.Raise(event=event):
                return [tables.Action("raise", event.text)]
            case model.Send():
                send = tables.Send(
                    self._value(action.event, True), self._value(action.target, True), self._value(action.type, True),
                    self._value(action.delay, True), action.id, _name(action.id_location),
                    self._params(action.payload), self._value(action.payload.content),
                )  # fmt: skip
                return [tables.Action("send", send=(send,))]
            case model.Cancel(id=value):
                return [tables.Action("cancel", value=self._value(value, True))]
            case model.Log(label=label, value=value):
                return [tables.Action("log", label, self._value(value))]
            case model.Assign(location=location, value=value):
                return [tables.Action("assign", location.text, self._value(value))]
            case model.Script(code=code):
                if self.is_python:
                    return [tables.Action("script", code.text)]
                return [tables.Action("call", name) for name in conditions.script(code.text)]
            case model.If(branches=branches):
                lowered = (tables.Branch(self._condition(text), self._actions(inner)) for text, inner in branches)
                return [tables.Action("if", branches=tuple(lowered))]
            case model.Foreach(array=array, item=item, index=index, actions=inner):
                body = tables.Branch(tables.Condition(), self._actions(inner))
                over = tables.Value("expr", array.text)
                return [tables.Action("foreach", item.text, over, _name(index), branches=(body,))]


def _name(text: Text | None) -> str:
    return text.text if text else ""
