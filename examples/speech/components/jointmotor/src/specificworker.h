#pragma once

#include "genericworker.h"
#include "ways.h"

#include <chrono>
#include <map>
#include <string>

/// JointMotorComp: simulated motors, which move at most at their speed and within their limits.
class SpecificWorker : public GenericWorker
{
public:
    void initialize();
    void compute();

    // JointMotor: other components call these.
    void JointMotor_setPosition(const std::string& motor, float position);
    RoboCompJointMotor::Positions JointMotor_getPositions();

private:
    struct Joint
    {
        parameters::Motor motor;
        float position = 0, goal = 0;
    };

    std::map<std::string, Joint> joints;
    Ways ways;
    std::chrono::steady_clock::time_point last;
};
