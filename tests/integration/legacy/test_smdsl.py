"""SMDSL files as SCXML: blocks in any order, and faults."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.draft import MachineDraft

Run = Callable[..., Result]


def converted(folder: Path, text: str) -> tuple[str, list[str]]:
    """Return the document ('' without one), and the diagnostics with line and column."""
    (folder / "x.smdsl").write_text(text, encoding="utf-8")
    result = convert(str(folder / "x.smdsl"))
    said = [f"{d.span.line}:{d.span.column} {d.message}" for d in result.diagnostics]
    return result.draft.text if isinstance(result.draft, MachineDraft) else "", said


HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
OPEN = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" name="{}" initial="{}">\n'


def test_nested_parallel_and_in_any_order(tmp_path: Path) -> None:
    """A block's parent may be a state of another block, before or after it."""
    text, said = converted(tmp_path, """
        // The game.
        game {
            transitions { intro => round; round => won, lost; round => round; };
            end_state won;   // at last
            states round, lost;
            initial_state intro;
        };
        :player { Initial_State wait; states think; transitions { wait => think, wait; } }
        :round PARALLEL { STATES player, board; };
        :board { states clean; initial_state clean; end_state broken; };
    """)  # fmt: skip
    assert said == ["11:25 'clean' is the first or last state, and need not be listed"]
    assert (
        text
        == HEAD
        + "<!-- The game. -->\n"
        + OPEN.format("game", "intro")
        + """\
  <state id="intro">
    <transition event="t_intro_to_round" target="round"/>
  </state>
  <parallel id="round">
    <transition event="t_round_to_won" target="won"/>
    <transition event="t_round_to_lost" target="lost"/>
    <transition event="t_round_to_round" target="round"/>
    <state id="player" initial="wait">
      <state id="wait">
        <transition event="t_wait_to_think" target="think"/>
        <transition event="t_wait_to_wait" target="wait"/>
      </state>
      <state id="think"/>
    </state>
    <state id="board" initial="clean">
      <state id="clean"/>
      <final id="broken"/>
    </state>
  </parallel>
  <state id="lost"/>
  <!-- at last -->
  <final id="won"/>
</scxml>
"""
    )


@pytest.mark.parametrize(("text", "said"), [
    ("m { initial_state a; transition { a => a; }; };", ["1:22 'transition' is spelled 'transitions'"]),
    ("m { states b, b; initial_state a; };", ["1:15 'b' is listed already"]),
    ("m { initial_state a; transitions { a => a; a => a; }; };", ["1:49 this transition to 'a' is repeated"]),
    ("m { initial_state a };", ["1:19 a ';' is missing here"]),
    ("m { initial_state a; states b,; };", ["1:30 nothing follows the last ',' of this list"]),
    ("m { initial_state a; };;", ["1:24 a superfluous ';' is omitted"]),
    ("m { initial_state a; end_state b; transitions { b => a; }; };",
     ["1:49 an end state cannot have transitions, so that this one of 'b' is omitted"]),
    ("m { initial_state a; };\n:a parallel { states b; initial_state c; };",
     ["2:39 all states of a parallel block are active at once, so that 'c' is neither first nor last"]),
])  # fmt: skip
def test_repairs_and_losses(tmp_path: Path, text: str, said: list[str]) -> None:
    document, told = converted(tmp_path, text)
    assert document.startswith(HEAD)
    assert told == said


@pytest.mark.parametrize(("text", "said"), [
    ("m { states a; };", ["1:1 'm' has no 'initial_state'"]),
    ("m { };", ["1:1 'm' has no state"]),
    ("m { initial_state a; transitions { a => b; }; };", ["1:41 unknown state 'b': list it under 'states'"]),
    ("m { initial_state a; initial_state b; };", ["1:22 'initial_state' is set twice"]),
    ("m { initial_state a; };\n:b { initial_state c; };", ["2:2 unknown parent state 'b'"]),
    ("m { initial_state a; };\n:a { initial_state a; };", ["2:20 the state 'a' is defined twice"]),
    ("m { initial_state a; };\n:a { initial_state b; };\n:a { initial_state c; };",
     ["3:2 the states inside of 'a' are defined twice"]),
    ("m { initial_state a; };\n:b { initial_state c; };\n:c { initial_state b; };",
     ["2:2 'b' contains itself", "3:2 'c' contains itself"]),
    ("m { initial_state a; end_state b; };\n:b { initial_state c; };", ["2:2 'b' is an end state, which cannot contain states"]),
    ("m { initial_state ä; };", ["1:19 'ä' is not a legal name"]),
    ("m { [states a;] };", ["1:5 '[' is not allowed here"]),
])  # fmt: skip
def test_rejections(tmp_path: Path, text: str, said: list[str]) -> None:
    document, told = converted(tmp_path, text)
    assert document == ""
    assert told[: len(said)] == said


CDSL = 'Component C\n{{\n    Communications\n    {{\n    }};\n    language python;\n    statemachine "{}";\n}};\n'
SMDSL = "m { initial_state a; end_state b; transitions { a => b; }; };\n"


def test_a_component_refers_to_its_migrated_machine(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"old/c/c.cdsl": CDSL.format("sm/Door.SMDSL"), "old/c/sm/Door.SMDSL": SMDSL})
    result = rcyaml("migrate", "old", "-o", "new", "--report", "ledger.json")
    assert result.exit_code == 0, result.output
    assert "statemachine: sm/Door.scxml\n" in (tmp_path / "new/c/c.cdsl.yaml").read_text()
    assert rcyaml("check", "new").stdout == "1 document: nothing wrong\n"
    assert "generated" in rcyaml("compile", "new").stdout
    ledger = json.loads((tmp_path / "ledger.json").read_text())
    assert {(f["format"], f["status"], f["lines"]["converted"]) for f in ledger["files"]} == {
        ("cdsl", "converted", 8), ("smdsl", "converted", 1),
    }  # fmt: skip
    assert rcyaml("migrate", "old", "-o", "new").exit_code == 0
    assert "statemachine: sm/Door.scxml\n" in (tmp_path / "new/c/c.cdsl.yaml").read_text()


@pytest.mark.parametrize(("named", "there", "warned"), [
    ("c.smdsl", "c.scxml", False), ("c.scxml", "c.scxml", False), ("c.smdsl", "", True), ("c.scxml", "", True),
])  # fmt: skip
def test_a_machine_that_is_not_migrated_must_exist(
    rcyaml: Run, tmp_path: Path, named: str, there: str, warned: bool
) -> None:
    write_tree(tmp_path, {"c.cdsl": CDSL.format(named), **({there: "<scxml/>"} if there else {})})
    result = rcyaml("migrate", "c.cdsl", "--format", "json")
    assert [d["code"] for d in json.loads(result.stdout)["diagnostics"]] == ["RC5019"] * warned
    assert "statemachine: c.scxml\n" in (tmp_path / "c.cdsl.yaml").read_text()


@pytest.mark.parametrize("goes", [lambda n: "s0 => " + ", ".join(f"s{i}" for i in range(n)),
                                  lambda n: "; ".join(f"s{i} => s{i + 1}" for i in range(n - 1))])  # fmt: skip
def test_many_states_are_converted_quickly(rcyaml: Run, tmp_path: Path, goes: Callable[[int], str]) -> None:
    count = 20_000
    states = ", ".join(f"s{i}" for i in range(count))
    write_tree(
        tmp_path, {"m.smdsl": f"m {{ states {states}; initial_state s0; transitions {{ {goes(count)}; }}; }};\n"}
    )
    begin = time.process_time()
    assert rcyaml("migrate", ".").exit_code == 0
    assert time.process_time() - begin < 8
