#include "ways.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace
{
constexpr float WIDTH = 800, HEIGHT = 300, MARGIN = 40;
const char* const COLORS[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf"};

float seconds(Ways::Time from, Ways::Time to)
{
    return std::chrono::duration<float>(to - from).count();
}
}

void Ways::add(const std::string& motor, Time time, float position)
{
    auto& way = ways_[motor];
    way.push_back({time, position});
    const auto old = [time](const Point& point) { return seconds(point.time, time) > 60; };
    way.erase(way.begin(), std::find_if_not(way.begin(), way.end(), old));
    isNew_ = true;
}

bool Ways::draw(const std::string& file)
{
    isNew_ = false;
    Time first = Time::max(), last = Time::min();
    float low = 0, high = 0;
    for (const auto& [motor, way] : ways_)
        for (const auto& point : way)
        {
            first = std::min(first, point.time);
            last = std::max(last, point.time);
            low = std::min(low, point.position);
            high = std::max(high, point.position);
        }
    const float length = std::max(seconds(first, last), 0.1f), range = std::max(high - low, 0.01f);
    const std::string part = file + ".part";
    std::ofstream out(part);
    out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << WIDTH << ' ' << HEIGHT << "'>\n"
        << "<rect width='100%' height='100%' fill='white'/>\n"
        << "<g font-family='sans-serif' font-size='14' fill='none' stroke-width='1.5'>\n";
    int number = 0;
    for (const auto& [motor, way] : ways_)
    {
        const char* color = COLORS[number % std::size(COLORS)];
        out << "<polyline stroke='" << color << "' points='";
        for (const auto& point : way)
            out << MARGIN + (WIDTH - 2 * MARGIN) * seconds(first, point.time) / length << ','
                << HEIGHT - MARGIN - (HEIGHT - 2 * MARGIN) * (point.position - low) / range << ' ';
        out << "'/>\n<text x='" << MARGIN + 100 * number++ << "' y='20' fill='" << color << "'>" << motor << "</text>\n";
    }
    out << "<text x='" << MARGIN << "' y='" << HEIGHT - 10 << "' fill='black'>" << length << " s; " << low << " to "
        << high << " rad</text>\n</g>\n</svg>\n";
    out.close();
    return out && std::rename(part.c_str(), file.c_str()) == 0;
}
