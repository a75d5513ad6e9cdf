#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

/// The ways of motors in time, as a picture.
class Ways
{
public:
    using Time = std::chrono::steady_clock::time_point;

    /// Where a motor (position in rad) is at a time. Only the last minute is kept.
    void add(const std::string& motor, Time time, float position);

    /// Whether a motor moved since the last picture.
    bool isNew() const { return isNew_; }

    /// Writes an SVG file: time to the right, positions upwards, a line for each motor. Returns whether it was written.
    bool draw(const std::string& file);

private:
    struct Point
    {
        Time time;
        float position;
    };

    std::map<std::string, std::vector<Point>> ways_;
    bool isNew_ = false;
};
