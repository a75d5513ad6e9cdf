#pragma once

#include "genericworker.h"

#include <chrono>

/// MouthComp: opens a mouth with the loudness of a voice.
class SpecificWorker : public GenericWorker
{
public:
    void initialize();
    void compute();

    // Mouth: other components call these.
    void Mouth_setLoudness(float loudness);
    float Mouth_getOpening();

private:
    /// Moves the lips, so that the mouth is open by so many millimetres.
    void open(float width);

    float opening = 0;
    std::chrono::steady_clock::time_point heard;
};
