"""The components that the tests of the C++ target build: documents, and the user's part of each."""

from __future__ import annotations

from scenario import INTERFACES, cdsl

DOCUMENTS = {
    **INTERFACES,
    "server/server.cdsl.yaml": cdsl("Server", "cpp", implements=["Arm", "Hand"]),
    "client/client.cdsl.yaml": cdsl(
        "Client",
        "cpp",
        requires=[
            "Arm",
            {"Arm2": {"interface": "Arm", "absent": "fail"}},
            {"Hand": {"interface": "Hand", "absent": "ignore"}},
            {"Late": {"interface": "Arm", "timeout": "500 ms"}},
        ],
    ),
    "turns/turns.cdsl.yaml": cdsl("Turns", "cpp", period="40 ms"),
    "radio/radio.cdsl.yaml": cdsl("Radio", "cpp", publishes=["ArmEvents"], subscribes=["ArmEvents", "Arm"]),
    "mutual/mutual.cdsl.yaml": cdsl("Mutual", "cpp", implements=["Arm"], requires=["Hand"]),
}

SERVER = """
#include "specificworker.h"

#include <stdexcept>
#include <thread>

using RoboCompTypes::Side;

void SpecificWorker::initialize() {}
void SpecificWorker::compute() {}

int SpecificWorker::Arm_move(const RoboCompTypes::Path& path, bool fast)
{
    if (fast)
    {
        throw RoboCompArm::Blocked(path.at(0), 9.5F);
    }
    return static_cast<int>(path.size());
}

Side SpecificWorker::Arm_state(RoboCompTypes::Pose& pose, RoboCompTypes::Named& named)
{
    pose = {1, 2, Side::left};
    named["home"] = {3, 4, Side::left};
    return Side::right;
}

void SpecificWorker::Arm_breakDown()
{
    throw std::domain_error("division by zero");
}

void SpecificWorker::Arm_betray()
{
    throw RoboCompArm::Broken();
}

void SpecificWorker::Arm_block(float seconds)
{
    log.info("blocking");
    std::this_thread::sleep_for(std::chrono::duration<float>(seconds));
}

RoboCompTypes::Image SpecificWorker::Hand_grasp(const RoboCompTypes::Image& image)
{
    return {image.rbegin(), image.rend()};
}
"""

CLIENT = """
#include "specificworker.h"

#include <Ice/LocalException.h>
#include <iostream>

using RoboCompTypes::Side;

void SpecificWorker::initialize()
{
    RoboCompTypes::Path path(2);
    path[0] = {1, 2, Side::left};
    std::cout << "move " << arm_proxy->move(path, false) << ' ' << arm2_proxy->move({}, false) << std::endl;
    RoboCompTypes::Pose pose;
    RoboCompTypes::Named named;
    const auto side = arm_proxy->state(pose, named);
    std::cout << "state " << (side == Side::right ? "right" : "left") << ' ' << pose.y << ' ' << named.size() << ' '
              << named.at("home").x << std::endl;
    try
    {
        arm_proxy->move(path, true);
    }
    catch (const RoboCompArm::Blocked& blocked)
    {
        std::cout << "blocked at " << blocked.where.x << ' ' << blocked.force << std::endl;
    }
    for (const auto call : {&RoboCompArm::ArmPrx::breakDown, &RoboCompArm::ArmPrx::betray})
    {
        try
        {
            (*arm_proxy.*call)(Ice::noExplicitContext);
        }
        catch (const Ice::UnknownException& problem)
        {
            std::cout << "unknown: " << problem.unknown << std::endl;
        }
    }
    try
    {
        late_proxy->block(3);
    }
    catch (const Ice::TimeoutException&)
    {
        std::cout << "timed out" << std::endl;
    }
    try
    {
        const auto image = hand_proxy->grasp({'a', 'b', 'c'});
        std::cout << "grasp " << std::string(image.begin(), image.end()) << std::endl;
    }
    catch (const Ice::LocalException&)
    {
        std::cout << "nobody grasps" << std::endl;
    }
}

void SpecificWorker::compute() {}
"""

TURNS = """
#include "specificworker.h"

#include <iostream>
#include <stdexcept>
#include <thread>

using Clock = std::chrono::steady_clock;

namespace
{
Clock::time_point begin;
int turns = 0;
}

void SpecificWorker::initialize()
{
    begin = Clock::now();
}

void SpecificWorker::compute()
{
    ++turns;
    if (turns == 3)
    {
        throw std::runtime_error("the third one fails");
    }
    const auto now = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin).count();
    std::cout << "turn " << turns << ' ' << now << ' ' << getPeriod() << std::endl;
    if (turns == 5)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
}
"""

RADIO = """
#include "specificworker.h"

#include <iostream>
#include <vector>

namespace
{
std::vector<int> counted;
}

void SpecificWorker::initialize()
{
    armevents_pubproxy->moved({4, 2.5F, RoboCompTypes::Side::right});
    for (int n = 0; n < 100; ++n)
    {
        armevents_pubproxy->count(n);
    }
    std::cout << "published" << std::endl;
}

void SpecificWorker::compute() {}

void SpecificWorker::ArmEvents_moved(const RoboCompTypes::Pose& pose)
{
    std::cout << "moved to " << pose.x << ' ' << (pose.side == RoboCompTypes::Side::right ? "right" : "left") << std::endl;
}

void SpecificWorker::ArmEvents_count(int n)
{
    if (n != static_cast<int>(counted.size()))
    {
        std::cout << "expected " << counted.size() << ", got " << n << std::endl;
    }
    counted.push_back(n);
    if (counted.size() == 100)
    {
        std::cout << "all in order" << std::endl;
    }
}

void SpecificWorker::Arm_betray()
{
    std::cout << "heard" << std::endl;
}

void SpecificWorker::Arm_block(float seconds)
{
    std::cout << "heard " << seconds << std::endl;
}
"""

MUTUAL = """
#include "specificworker.h"

namespace
{
int value = 0;
}

void SpecificWorker::initialize()
{
    value = 1;
}

void SpecificWorker::compute() {}

int SpecificWorker::Arm_move(const RoboCompTypes::Path&, bool)
{
    return value;
}

RoboCompTypes::Side SpecificWorker::Arm_state(RoboCompTypes::Pose&, RoboCompTypes::Named&)
{
    return RoboCompTypes::Side::left;
}

void SpecificWorker::Arm_breakDown()
{
    killYourSelf();
}

void SpecificWorker::Arm_betray() {}
void SpecificWorker::Arm_block(float) {}
"""

# The user's part; a component without an entry keeps its skeleton.
SOURCES = {"Server": SERVER, "Client": CLIENT, "Turns": TURNS, "Radio": RADIO, "Mutual": MUTUAL}
