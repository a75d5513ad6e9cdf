"""The same state machine in a component of each language: the same handlers in the same order."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from components import Build
from cpp_programs import FAST, cmake, needs_cpp
from processes import Ports, Start, until

DOCUMENT = """
component: Door
language: LANGUAGE
period: 30 ms
statemachine:
  initial: closed
  events: [open, push]
  states:
    opened:
      initial: still
      entry: [ring, {send: tired, after: 100 ms}]
      states: {still: {}, moving: {}, last: {history: shallow}}
      transitions:
        still: {to: moving, event: push, if: pushed and not In('closed'), do: ring}
        last: still
    resting:
      parallel: true
      states: {left: {}, right: {entry: {raise: both}}}
    failing: {}
    gone: {}
  transitions:
    closed: {to: opened, event: open}
    opened: {to: resting, event: tired}
    left: {event: both, do: ring}
    resting: {to: last, if: rested}
    moving: {to: failing, event: push}
    failing: [{to: gone, event: error.execution}, {event: push, do: fail}]
    gone: {to: failing, event: push}
"""

# Fires an event whenever the machine has reached the state for the next one.
PYTHON = """
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    turns = 0
    rests = 0

    def compute(self):
        state = " ".join(self.statemachine.states)
        if state == "closed" and self.turns < 3:
            self.turns += 1
            if self.turns == 3:
                self.events.open({"by": "hand"})
        elif state == "opened still":
            self.events.push()
        elif state == "opened moving" and self.rests:
            self.events.push()
        elif state == "failing":
            self.events.push()

    def say(self, text):
        print(f"> {text}", flush=True)

    def ring(self):
        self.say(f"ring on {self.statemachine.event.name}")

    def fail(self):
        self.say("fail")
        raise ValueError("no")

    def pushed(self):
        return True

    def rested(self):
        return self.rests == 2

    def sm_opened(self):
        event = self.statemachine.event
        self.say("opened by " + event.data["by"] if event.data else "opened again")

    def sm_gone_exit(self):
        self.say("gone left")

    def sm_resting_period(self):
        self.rests += 1
        self.say("a rest")

for state in ("closed", "still", "moving", "left", "right", "resting", "failing", "gone"):
    setattr(SpecificWorker, f"sm_{state}", lambda self, state=state: self.say(state))
"""
HEADER = """
#pragma once
#include "genericworker.h"
#include <iostream>

class SpecificWorker : public GenericWorker
{
public:
    void compute() override
    {
        std::string state;
        for (const auto& name : statemachine.states())
            state += (state.empty() ? "" : " ") + name;
        if (state == "closed" && turns < 3)
        {
            if (++turns == 3)
                events.open({{"by", "hand"}});
        }
        else if (state == "opened still" || (state == "opened moving" && rests > 0) || state == "failing")
            events.push();
    }
    void say(const std::string& text) { std::cout << "> " << text << std::endl; }
    void ring() override { say("ring on " + statemachine.event().name); }
    void fail() override { say("fail"); throw std::runtime_error("no"); }
    bool pushed() override { return true; }
    bool rested() override { return rests == 2; }
    void sm_opened() override
    {
        const auto& data = statemachine.event().data;
        say(data.empty() ? "opened again" : "opened by " + data.at("by"));
    }
    void sm_gone_exit() override { say("gone left"); }
    void sm_resting_period() override { ++rests; say("a rest"); }
STATES
    int turns = 0;
    int rests = 0;
};
"""
STATES = ("closed", "still", "moving", "left", "right", "resting", "failing", "gone")
EXPECTED = [
    "closed", "ring on open", "opened by hand", "still", "ring on push", "moving", "resting", "left", "right",
    "ring on both", "a rest", "a rest", "ring on both", "opened again", "moving", "failing", "fail", "gone",
]  # fmt: skip


def make_python(build: Build, folder: Path) -> list[str | Path]:
    door = build({"door/door.cdsl.yaml": DOCUMENT.replace("LANGUAGE", "python")})["Door"]
    (door.root / "src" / "specificworker.py").write_text(PYTHON)
    return door.command


def make_cpp(build: Build, folder: Path) -> list[str | Path]:
    door = build({"door/door.cdsl.yaml": DOCUMENT.replace("LANGUAGE", "cpp")})["Door"]
    states = "".join(f'    void sm_{name}() override {{ say("{name}"); }}\n' for name in STATES)
    (door.root / "src" / "specificworker.h").write_text(HEADER.replace("STATES", states))
    (door.root / "src" / "specificworker.cpp").write_text('#include "specificworker.h"\n')
    cmake(door.root, *FAST)
    return door.command


@pytest.mark.parametrize(
    "make",
    [pytest.param(make_python, id="python"), pytest.param(make_cpp, id="cpp", marks=[pytest.mark.slow, needs_cpp])],
)
def test_handlers_events_and_introspection(
    make: Callable[[Build, Path], list[str | Path]], build: Build, start: Start, free_port: Ports,
    behavior: Callable[[int], Any], tmp_path: Path,
) -> None:  # fmt: skip
    command = make(build, tmp_path)
    port = free_port()
    (tmp_path / "config").write_text(f"CommonBehavior.Endpoints = tcp -h 127.0.0.1 -p {port}\n")
    running = start([*command, tmp_path / "config"])
    running.wait_for("> gone")
    asked = behavior(port)

    def state() -> bool:
        return asked.getParameterList()["statemachine.state"].value == "gone"

    until(state, lambda: f"{asked.getParameterList()}\n{running.output}")
    assert [line[2:] for line in running.output.splitlines() if line.startswith("> ")] == EXPECTED, running.output
    running.process.send_signal(signal.SIGTERM)
    assert running.process.wait(5) == 0
    assert "> gone left" in running.output
