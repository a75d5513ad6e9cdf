// This file is yours: rcyaml wrote it once, and will not touch it again.
#pragma once

#include "genericworker.h"

/// MouthComp: Moves the lips.
///
/// Beside the methods below it has:
/// - twin_proxy: calls Twin
/// - backup_proxy: calls Backup
/// - mouthevents_pubproxy: publishes MouthEvents: moved(shape, at)
/// - log, mutex, communicator, getPeriod(), setPeriod(ms), killYourSelf()
class SpecificWorker : public GenericWorker
{
public:
    /// Called once: all proxies are there, and calls from other components wait until this is done.
    void initialize() override;

    /// Called every period (50 ms, unless etc/config says otherwise).
    void compute() override;

    // Mouth: other components call these.
    bool Mouth_open(float width, RoboCompMouth::Shape shape) override;
    RoboCompMouth::Shape Mouth_status(RoboCompTypes::Pose& pose, RoboCompMouth::Shapes& shapes) override;
    void Mouth_stop() override;
    void Mouth_sing(
        const std::string& text,
        const RoboCompMouth::Samples& samples,
        long long int this_,
        Ice::Byte register_) override;
    void Mouth_whereIsTheMouthThatSaysAllThis(
        const RoboCompTypes::Pose& relativeToThisPose,
        const RoboCompMouth::Shapes& shapesOfTheLips,
        RoboCompTypes::Pose& poseOfTheMouthInTheImage,
        bool& found) override;

    // MouthEvents: events that others publish.
    void MouthEvents_moved(RoboCompMouth::Shape shape, const RoboCompTypes::Pose& at) override;
};
