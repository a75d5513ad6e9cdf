// This file is yours: rcyaml wrote it once, and will not touch it again.
#include "specificworker.h"

void SpecificWorker::initialize()
{
    log.info("initializing");
}

void SpecificWorker::compute()
{
}

bool SpecificWorker::Mouth_open(float /*width*/, RoboCompMouth::Shape /*shape*/)
{
    log.info("Mouth_open() is still to be written");
    return {};
}

RoboCompMouth::Shape SpecificWorker::Mouth_status(RoboCompTypes::Pose& pose, RoboCompMouth::Shapes& shapes)
{
    log.info("Mouth_status() is still to be written");
    pose = {};
    shapes = {};
    return RoboCompMouth::Shape::closed;
}

void SpecificWorker::Mouth_stop()
{
    log.info("Mouth_stop() is still to be written");
}

void SpecificWorker::Mouth_sing(
    const std::string& /*text*/,
    const RoboCompMouth::Samples& /*samples*/,
    long long int /*this_*/,
    Ice::Byte /*register_*/)
{
    log.info("Mouth_sing() is still to be written");
}

void SpecificWorker::Mouth_whereIsTheMouthThatSaysAllThis(
    const RoboCompTypes::Pose& /*relativeToThisPose*/,
    const RoboCompMouth::Shapes& /*shapesOfTheLips*/,
    RoboCompTypes::Pose& poseOfTheMouthInTheImage,
    bool& found)
{
    log.info("Mouth_whereIsTheMouthThatSaysAllThis() is still to be written");
    poseOfTheMouthInTheImage = {};
    found = {};
}

void SpecificWorker::MouthEvents_moved(RoboCompMouth::Shape /*shape*/, const RoboCompTypes::Pose& /*at*/)
{
    log.info("MouthEvents_moved() is still to be written");
}
