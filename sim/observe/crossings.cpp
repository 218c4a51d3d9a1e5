#include "sim/observe/crossings.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {
namespace {

// The points of the channel above the level, in the order of time: its samples, and the turning points beyond the level
// between samples on one side of it. Values below rounding of the samples are zero at the start of the motion: no
// earlier step determines the sign of a start from rest.
std::vector<Vec2> points_of(StepSamples& step, const SegmentInterval& s, Channel channel, double level) {
    const auto may_pass = [&](std::size_t, double low, double high, double stray) {
        return low - stray < level && level < high + stray;
    };
    const StepSamples::Series& series = step.sample(s, {&channel, 1}, may_pass).front();
    std::vector<Vec2> points;
    double largest = std::fabs(level);
    for (std::size_t k = 0; k < series.t.size(); ++k) {
        points.push_back({series.t[k], series.value[k] - level});
        largest = std::max(largest, std::fabs(points.back().y));
    }
    if (s.from == 0 && std::fabs(points.front().y) <= kRounding * largest) points.front().y = 0;
    std::vector<Vec2> turns;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        const double side = points[k].y > 0 ? -1 : 1;
        const auto turned = [&](std::size_t i) { return Vec2{points[i].x, side * points[i].y}; };
        if (turned(k - 1).y > 0 || turned(k + 1).y > 0) continue;
        const auto top = vertex(turned(k - 1), turned(k), turned(k + 1));
        if (!top || !(top->y > -kParabolaError * (top->y - turned(k).y))) continue;
        const auto f = [&](double t) { return side * (step.value(channel, t) - level); };
        const Vec2 turn = climb(f, turned(k - 1), turned(k), turned(k + 1), 0, kRounding * largest);
        if (turn.y > kRounding * largest) turns.push_back({turn.x, side * turn.y});
    }
    points.insert(points.end(), turns.begin(), turns.end());
    std::ranges::sort(points, {}, &Vec2::x);
    return points;
}

}  // namespace

void find_crossings(StepSamples& step, const SegmentInterval& s, Channel channel, double level,
                    std::vector<LevelCrossing>& found) {
    const std::vector<Vec2> points = points_of(step, s, channel, level);
    const auto above = [&](double t) { return step.value(channel, t) - level; };
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec2 &a = points[k], &b = points[k + 1];
        // A zero belongs to the interval that it ends. Where the beam bends beyond its model, there may be no value.
        if ((a.y < 0 && b.y >= 0) || (a.y > 0 && b.y <= 0))
            found.push_back({find_root(above, a.x, b.x, a.y, b.y), a.y < 0});
    }
}

void find_apexes(StepSamples& step, const SegmentInterval& s, std::vector<Apex>& found) {
    std::vector<LevelCrossing> crossings;
    find_crossings(step, s, {ChannelKind::theta_dot}, 0, crossings);
    for (const LevelCrossing& crossing : crossings)
        if (!crossing.rises) found.push_back({crossing.t, step.value({ChannelKind::theta}, crossing.t)});
}

void find_zero_crossings(StepSamples& step, const SegmentInterval& s, std::vector<ZeroCrossing>& found) {
    std::vector<LevelCrossing> crossings;
    find_crossings(step, s, {ChannelKind::theta}, 0, crossings);
    for (const LevelCrossing& crossing : crossings)
        found.push_back({crossing.t, step.value({ChannelKind::theta_dot}, crossing.t)});
}

}  // namespace beamcam::sim
