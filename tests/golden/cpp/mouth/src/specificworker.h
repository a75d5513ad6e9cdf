// This file is yours: rcyaml wrote it once, and will not touch it again.
#pragma once

#include "genericworker.h"

/// MouthComp: Moves the lips.
///
/// Besides the methods below, it has:
/// - twin_proxy: calls Twin
/// - backup_proxy: calls Backup
/// - mouthevents_pubproxy: publishes MouthEvents: moved(shape, at)
/// - parameters: the values of etc/config, as generated/parameters.h declares them
/// - log, mutex, communicator, getPeriod(), setPeriod(ms), killYourSelf()
class SpecificWorker : public GenericWorker
{
public:
    /// Called once: all proxies exist, and calls from other components wait until it returns.
    void initialize();

    /// Called every period (50 ms, unless etc/config sets another one).
    void compute();

    // Mouth: other components call these.
    bool Mouth_open(float width, RoboCompMouth::Shape shape);
    RoboCompMouth::Shape Mouth_status(RoboCompTypes::Pose& pose, RoboCompMouth::Shapes& shapes);
    void Mouth_stop();
    void Mouth_sing(
        const std::string& text, const RoboCompMouth::Samples& samples, long long int this_, Ice::Byte register_);
    void Mouth_whereIsTheMouthThatSaysAllThis(
        const RoboCompTypes::Pose& relativeToThisPose,
        const RoboCompMouth::Shapes& shapesOfTheLips,
        RoboCompTypes::Pose& poseOfTheMouthInTheImage,
        bool& found);

    // MouthEvents: events that others publish.
    void MouthEvents_moved(RoboCompMouth::Shape shape, const RoboCompTypes::Pose& at);
};
