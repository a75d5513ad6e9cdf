"""One component in each language that describes itself: all behave alike."""

from __future__ import annotations

from scenario import INTERFACES, cdsl

PERIOD = 50  # milliseconds

_PORTS = {
    "implements": ["Arm"],
    "requires": ["Hand"],
    "publishes": ["ArmEvents"],
    "subscribes": ["ArmEvents"],
    "period": f"{PERIOD} ms",
}
DOCUMENTS = {
    **INTERFACES,
    **{f"{language}/{language}.cdsl.yaml": cdsl("Vital", language, **_PORTS) for language in ("cpp", "java", "python")},
}

PYTHON = """
import time
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompArm

class SpecificWorker(GenericWorker):
    stuck = patience = 0.0

    def initialize(self):
        time.sleep(1)

    def compute(self):
        self.armevents_proxy.count(1)
        seconds, self.stuck = self.stuck, 0.0
        if seconds:
            if self.patience:
                self.mayTake(self.patience)
            time.sleep(seconds)

    def Arm_move(self, path, fast):
        if fast:
            raise RoboCompArm.Blocked()
        time.sleep(0.02)
        return 0

    def Arm_breakDown(self):
        raise ValueError("broken")

    def Arm_block(self, seconds):
        self.patience = 30.0 if seconds < 0 else 0.0
        self.stuck = abs(seconds)

    def ArmEvents_count(self, n):
        pass
"""

CPP = """
#include "specificworker.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace
{

void rest(double seconds)
{
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

std::atomic<float> stuck{0};
std::atomic<bool> patient{false};

}

void SpecificWorker::initialize()
{
    rest(1);
}

void SpecificWorker::compute()
{
    armevents_pubproxy->count(1);
    const double seconds = stuck.exchange(0);
    if (seconds > 0)
    {
        if (patient)
        {
            mayTake(30);
        }
        rest(seconds);
    }
}

int SpecificWorker::Arm_move(const RoboCompTypes::Path&, bool fast)
{
    if (fast)
    {
        throw RoboCompArm::Blocked();
    }
    rest(0.02);
    return 0;
}

RoboCompTypes::Side SpecificWorker::Arm_state(RoboCompTypes::Pose&, RoboCompTypes::Named&)
{
    return RoboCompTypes::Side::left;
}

void SpecificWorker::Arm_breakDown()
{
    throw std::domain_error("broken");
}

void SpecificWorker::Arm_betray()
{
}

void SpecificWorker::Arm_block(float seconds)
{
    patient = seconds < 0;
    stuck = std::abs(seconds);
}

void SpecificWorker::ArmEvents_moved(const RoboCompTypes::Pose&)
{
}

void SpecificWorker::ArmEvents_count(int)
{
}
"""

JAVA = """
import generated.GenericWorker;
import java.util.Map;
import slice.RoboCompArm.Arm;
import slice.RoboCompArm.Blocked;
import slice.RoboCompTypes.Pose;
import slice.RoboCompTypes.Side;

public class SpecificWorker extends GenericWorker {
    private volatile float stuck;
    private volatile boolean patient;

    private static void rest(double seconds) {
        try {
            Thread.sleep((long) (seconds * 1000));
        } catch (InterruptedException error) {
            Thread.currentThread().interrupt();
        }
    }

    @Override
    public void initialize() {
        rest(1);
    }

    @Override
    public void compute() {
        armevents_pubproxy.count(1);
        float seconds = stuck;
        stuck = 0;
        if (seconds > 0) {
            if (patient) {
                mayTake(30);
            }
            rest(seconds);
        }
    }

    @Override
    public int Arm_move(Pose[] path, boolean fast) throws Blocked {
        if (fast) {
            throw new Blocked(new Pose(1, 2, Side.left), 9.5f);
        }
        rest(0.02);
        return 0;
    }

    @Override
    public Arm.StateResult Arm_state() {
        return new Arm.StateResult(Side.right, new Pose(1, 2, Side.left), Map.of());
    }

    @Override
    public void Arm_breakDown() {
        throw new IllegalStateException("broken");
    }

    @Override
    public void Arm_betray() {
    }

    @Override
    public void Arm_block(float seconds) {
        patient = seconds < 0;
        stuck = Math.abs(seconds);
    }

    @Override
    public void ArmEvents_moved(Pose pose) {
    }

    @Override
    public void ArmEvents_count(int n) {
    }
}
"""

FILES = {
    "python": ("src/specificworker.py", PYTHON),
    "cpp": ("src/specificworker.cpp", CPP),
    "java": ("src/SpecificWorker.java", JAVA),
}
