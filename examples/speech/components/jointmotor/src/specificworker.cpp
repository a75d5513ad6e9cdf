// JointMotorComp: simulated motors, whose ways are drawn when all of them rest.
#include "specificworker.h"

#include <algorithm>

void SpecificWorker::initialize()
{
    for (const auto& motor : *parameters.motors())
        joints[motor.name] = {motor};
    last = std::chrono::steady_clock::now();
}

void SpecificWorker::compute()
{
    const std::lock_guard lock(mutex);
    const auto now = std::chrono::steady_clock::now();
    const float passed = std::chrono::duration<float>(now - last).count();
    last = now;
    bool moves = false;
    for (auto& [name, joint] : joints)
    {
        const float most = joint.motor.vel * passed;
        const float step = std::clamp(joint.goal - joint.position, -most, most);
        joint.position += step;
        moves = moves || step != 0;
    }
    if (moves)
        for (const auto& [name, joint] : joints)
            ways.add(name, now, joint.position);
    else if (ways.isNew() && ways.draw(parameters.picture()))
        log.info("the ways are drawn in " + parameters.picture());
}

void SpecificWorker::JointMotor_setPosition(const std::string& motor, float position)
{
    const std::lock_guard lock(mutex);
    const auto joint = joints.find(motor);
    if (joint == joints.end())
        throw RoboCompJointMotor::UnknownMotor("there is no motor '" + motor + "'");
    joint->second.goal = std::clamp(position, joint->second.motor.min, joint->second.motor.max);
}

RoboCompJointMotor::Positions SpecificWorker::JointMotor_getPositions()
{
    const std::lock_guard lock(mutex);
    RoboCompJointMotor::Positions positions;
    for (const auto& [name, joint] : joints)
        positions[name] = joint.position;
    return positions;
}
