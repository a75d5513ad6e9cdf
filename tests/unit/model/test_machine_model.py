"""State machines in the CDSL and in SCXML have the same model."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

from conftest import ROOT, write_tree
from robocomp_yaml.emit.machines.lower import lower
from robocomp_yaml.model.machine_index import MachineIndex
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.semantics import tables

INLINE = """
  initial: initialize
  final: finalize
  events: [stop, door.open]
  states:
    compute:
      initial: sense
      entry: [wake, {raise: ready}]
      exit: {cancel: nap}
      states:
        sense: {}
        act: {entry: {send: tired, after: 1.5 s, id: nap}}
        last: {history: deep}
      transitions:
        sense: {to: act, event: door.open, if: near and not In('act'), do: [wave, beep]}
        act: {event: "ready tired.*", do: {send: stop}}
        last: act
    both: {parallel: true, states: {left: {}, right: {}}}
  transitions:
    initialize: compute
    compute: [compute, {to: finalize, event: stop, internal: true}, {to: [left, right], if: low}]
    both: {to: last, event: "*"}
"""
SCXML = """<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" name="C" initial="initialize">
  <state id="initialize"><transition event="t_initialize_to_compute" target="compute"/></state>
  <state id="compute" initial="sense">
    <onentry><script>wake</script><raise event="ready"/></onentry>
    <onexit><cancel sendid="nap"/></onexit>
    <transition event="t_compute_to_compute" target="compute"/>
    <transition event="stop" target="finalize" type="internal"/>
    <transition cond="low" target="left right"/>
    <state id="sense">
      <transition event="door.open" cond="near and not In('act')" target="act"><script>wave; beep</script></transition>
    </state>
    <state id="act">
      <onentry><send event="tired" delay="1.5s" id="nap"/></onentry>
      <transition event="ready tired.*"><send event="stop" delay="0ms"/></transition>
    </state>
    <history id="last" type="deep"><transition target="act"/></history>
  </state>
  <parallel id="both">
    <transition event="*" target="last"/>
    <state id="left"/><state id="right"/>
  </parallel>
  <final id="finalize"/>
</scxml>
"""


def machine_of(folder: Path, statemachine: str, scxml: str = "", *, is_faulty: bool = False) -> StateMachine:
    document = f"component: C\nlanguage: python\nstatemachine:{statemachine}"
    write_tree(folder, {"c/c.cdsl.yaml": document, "c/c.scxml": scxml or "<a/>"})
    analysis = analyse([str(folder)])
    assert is_faulty or not analysis.diagnostics
    [component] = analysis.program.components.values()
    assert component.machine is not None
    return component.machine


def test_both_formats_have_the_same_tables(tmp_path: Path) -> None:
    inline = lower(machine_of(tmp_path / "inline", INLINE))
    file = lower(machine_of(tmp_path / "file", " c.scxml\n", SCXML))
    assert _sorted(inline) == _sorted(file)
    assert len(inline.states) == 10 and len(inline.transitions) == 10


def _sorted(machine: tables.Machine) -> tables.Machine:
    """Without the numbers of transitions, which follow the order of the document."""
    states = tuple(replace(state, transitions=(), initial=0) for state in machine.states)
    return replace(machine, states=states, transitions=tuple(sorted(machine.transitions, key=repr)))


def test_the_run_time_of_cpp_has_the_same_tables() -> None:
    header = (ROOT / "robocomp_yaml/languages/cpp/templates/machine/tables.h").read_text(encoding="utf-8")
    for table in vars(tables).values():
        if isinstance(table, type) and table.__module__ == tables.__name__:
            own = [field.name for field in fields(table)]
            body = header.partition(f"\nstruct {table.__name__}\n")[2].partition("\n};")[0]
            members = [line.split("=")[0].rstrip("; ").split()[-1] for line in body.splitlines()[1:] if line.strip()]
            assert members == own


def test_equal_states_are_distinguished(tmp_path: Path) -> None:
    twins = "<parallel><state><state/></state><state><state/></state></parallel><state><state/></state>"
    scxml = f'<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0">{twins}</scxml>'
    machine = machine_of(tmp_path, " c.scxml\n", scxml, is_faulty=True)
    index = MachineIndex(machine)
    assert [state.number for state in index.states] == list(range(8))
    homes = [index.parent(state) for state in index.states]
    assert [home.number if home else None for home in homes] == [None, 0, 1, 2, 1, 4, 0, 6]
    assert [one.number for one in index.ancestors(list(machine.states)[4])] == [4, 1, 0]
