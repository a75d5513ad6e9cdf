"""A window and a state machine in one component: buttons fire events, and handlers, in the worker's thread, pass jobs to
the window."""

from __future__ import annotations

from typing import Any

import pytest

from components import Build
from cpp_programs import FAST, cmake, in_all_builds, needs_cpp, needs_qt
from forms import FORM
from processes import Running, Start
from scenario import INTERFACES, cdsl
from test_python_gui import OFFSCREEN

KEYS: dict[str, Any] = {
    "gui": {"toolkit": "qt", "base": "QDialog"},
    "period": "20 ms",
    "statemachine": {
        "initial": "waiting",
        "states": {"working": {"entry": [{"send": "done", "after": "50 ms"}]}, "leaving": {}},
        "transitions": {
            "waiting": {"to": "working", "event": "pressed"},
            "working": {"to": "leaving", "event": "done"},
        },
    },
}

PYTHON = """
import threading

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initializeGui(self):
        self.main = threading.current_thread()
        self.ui.button.clicked.connect(lambda: self.events.pressed())

    def say(self, text):
        where = "in main" if threading.current_thread() is self.main else ""
        print(f"> {text} {where}\\n", end="", flush=True)

    def sm_waiting(self):
        self.say("waiting")
        self.runInGui(self.ui.button.click)

    def sm_working(self):
        self.say("working")
        self.runInGui(self.ui.label.setText, "working")

    def sm_leaving(self):
        self.runInGui(lambda: self.say("label says " + self.ui.label.text()))
        self.runInGui(self.window.reject)

    def sm_leaving_exit(self):
        self.say("left")
"""
HEADER = """
#pragma once
#include "genericworker.h"
#include <QLabel>
#include <QPushButton>
#include <iostream>
#include <thread>

class SpecificWorker : public GenericWorker
{
public:
    void initializeGui() override
    {
        QObject::connect(ui.button, &QPushButton::clicked, [this] { events.pressed(); });
    }
    void say(const std::string& text)
    {
        std::cout << "> " << text << (std::this_thread::get_id() != main ? " " : " in main") << std::endl;
    }
    void sm_waiting() override { say("waiting"); runInGui([this] { ui.button->click(); }); }
    void sm_working() override { say("working"); runInGui([this] { ui.label->setText("working"); }); }
    void sm_leaving() override
    {
        runInGui([this] { say("label says " + ui.label->text().toStdString()); });
        runInGui([this] { window.reject(); });
    }
    void sm_leaving_exit() override { say("left"); }

private:
    const std::thread::id main = std::this_thread::get_id();
};
"""


def assert_each_in_its_thread(running: Running) -> None:
    assert running.exit_code() == 0
    said = [line for line in running.output.splitlines() if line.startswith("> ")]
    assert said == ["> waiting ", "> working ", "> label says working in main", "> left "], running.output
    assert "the process ends anyway" not in running.output and "Traceback" not in running.output


def test_python(build: Build, start: Start) -> None:
    pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    any_ = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", **KEYS)})["Any"].configure({})
    (any_.root / "src" / "specificworker.py").write_text(PYTHON)
    (any_.root / "src" / "mainUI.ui").write_text(FORM.format(base="QDialog"))
    assert_each_in_its_thread(start(any_.command, env=OFFSCREEN))


@needs_cpp
@needs_qt
@in_all_builds
@pytest.mark.slow
def test_cpp(build: Build, start: Start) -> None:
    any_ = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", "cpp", **KEYS)})["Any"].configure({})
    (any_.root / "src" / "specificworker.h").write_text(HEADER)
    (any_.root / "src" / "specificworker.cpp").write_text('#include "specificworker.h"\n')
    (any_.root / "src" / "mainUI.ui").write_text(FORM.format(base="QDialog"))
    cmake(any_.root, *FAST)
    assert_each_in_its_thread(start(any_.command, env=OFFSCREEN))
