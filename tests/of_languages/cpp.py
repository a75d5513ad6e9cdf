"""C++: built with CMake, without optimization."""

from __future__ import annotations

import pytest

from cpp_accessors import Program
from cpp_programs import FAST, cmake, needs_cpp
from of_languages import Spoken

PARAMETERS = """\
#include "specificworker.h"

#include <atomic>
#include <iostream>
#include <set>
#include <sstream>
#include <thread>

namespace
{

void race(Parameters& parameters)
{
    const auto write = [&](float value)
    {
        parameters.change(
            [value](parameters::Values& values)
            {
                values.gains.assign(3, value);
                values.motors.at(0).vel = value;
            });
    };
    write(1);
    std::atomic<bool> isDone = false;
    std::thread writer(
        [&]
        {
            for (int number = 0; number < 2000; ++number)
            {
                write(number % 2 == 0 ? 1.0F : 0.5F);
            }
            isDone = true;
        });
    std::set<std::string> seen;
    while (!isDone)
    {
        const auto now = parameters.now();
        std::ostringstream text;
        for (const auto gain : now->gains)
        {
            text << gain << " ";
        }
        text << now->motors.at(0).vel;
        seen.insert(text.str());
    }
    writer.join();
    std::cout << "seen:";
    for (const auto& text : seen)
    {
        std::cout << " | " << text;
    }
    std::cout << std::endl;
}

void show(Parameters& parameters, const runtime::Change& change)
{
    const auto now = parameters.now();
    std::string paths;
    for (const auto& path : change.paths)
    {
        paths += (paths.empty() ? "" : ",") + path;
    }
    std::cout << "[" << (paths.empty() ? "-" : paths) << "] "
              << (now->mode == parameters::Mode::slow ? "slow" : "fast") << " " << parameters.device() << " "
              << parameters.basicPeriod() << " " << parameters.token().value_or("None") << " " << parameters.gains().size();
    for (const auto& motor : parameters.motors())
    {
        std::cout << " " << motor.name << ":" << motor.vel;
    }
    float sum = 0;
    for (const auto& [name, value] : now->offsets)
    {
        sum += value;
    }
    std::cout << " " << sum << " " << parameters.Yolo()->useGpu << " " << now->period.compute << std::endl;
    if (parameters.device() == "/dev/safe")
    {
        std::cout << "safe: " << parameters.pin().value_or(0);
        for (const auto& lock : now->locks.value_or(std::vector<std::string>{}))
        {
            std::cout << " " << lock;
        }
        std::cout << " " << now->password.value_or("None") << " " << now->server.value_or("None") << std::endl;
    }
    if (now->basicPeriod == 7)
    {
        try
        {
            parameters.change(
                [](parameters::Values& values)
                {
                    values.basicPeriod = 8;
                    values.motors.at(0).vel = 9;
                });
        }
        catch (const std::invalid_argument& error)
        {
            std::cout << "refused: " << error.what() << std::endl;
        }
    }
    if (now->basicPeriod == 9)
    {
        parameters.set("basicPeriod", now->gains.size() + 8);
    }
}

}

void SpecificWorker::initialize()
{
    if (parameters.device() == "/dev/race")
    {
        race(parameters);
    }
    parameters.listen([this](const runtime::Change& change) { show(parameters, change); });
    show(parameters, {});
}

void SpecificWorker::compute()
{
}
"""
PAPER = """\
#include "specificworker.h"

#include <iostream>

void SpecificWorker::initialize()
{
    std::cout << (parameters.handler() == parameters::Handler::Dunkermotoren ? "Dunkermotoren" : "?") << " "
              << parameters.device() << " " << parameters.baudRate() << " " << parameters.basicPeriod() << " "
              << parameters.motors().size() << std::endl;
    for (const auto& m : parameters.motors())
    {
        std::cout << m.name << " " << m.id << " " << m.invertedSign << " " << m.min << " " << m.max << " " << m.zero
                  << " " << m.vel << std::endl;
    }
}

void SpecificWorker::compute()
{
}
"""


def _stubs(skeleton: str) -> str:
    _, brace, stubs = skeleton.partition("void SpecificWorker::compute()\n{\n}\n")
    assert brace
    return stubs


SPOKEN = Spoken(
    "cpp",
    "src/specificworker.cpp",
    lambda root: cmake(root, *FAST),
    PARAMETERS,
    PAPER,
    _stubs,
    marks=(pytest.mark.slow, needs_cpp),
    judge=Program,
)
