// MouthComp: the louder the voice, the wider the mouth; it closes when the voice is silent.
#include "specificworker.h"

#include <algorithm>

void SpecificWorker::initialize()
{
    open(0);
}

void SpecificWorker::compute()
{
    const std::lock_guard lock(mutex);
    const auto silence = std::chrono::steady_clock::now() - heard;
    if (opening > 0 && silence > std::chrono::milliseconds(parameters.rest()))
        open(0);
}

void SpecificWorker::open(float width)
{
    opening = width;
    for (const auto& lip : *parameters.lips())
        jointmotor_proxy->setPosition(lip.motor, opening * lip.ratio);
}

void SpecificWorker::Mouth_setLoudness(float loudness)
{
    const std::lock_guard lock(mutex);
    heard = std::chrono::steady_clock::now();
    open(parameters.widest() * std::clamp(loudness, 0.0f, 1.0f));
}

float SpecificWorker::Mouth_getOpening()
{
    const std::lock_guard lock(mutex);
    return opening;
}
