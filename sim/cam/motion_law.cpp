#include "sim/cam/motion_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::sim {
namespace {

using std::numbers::pi;

LawValue cycloidal(double u) {
    const double w = 2 * pi;
    return {u - std::sin(w * u) / w, 1 - std::cos(w * u), w * std::sin(w * u), w * w * std::cos(w * u)};
}

LawValue harmonic(double u) {
    const double c = std::cos(pi * u), s = std::sin(pi * u);
    return {0.5 * (1 - c), 0.5 * pi * s, 0.5 * pi * pi * c, -0.5 * pi * pi * pi * s};
}

LawValue polynomial_345(double u) {
    return {u * u * u * (10 + u * (-15 + 6 * u)), 30 * u * u * (1 - u) * (1 - u), 60 * u * (1 - u) * (1 - 2 * u),
            60 + u * (-360 + 360 * u)};
}

LawValue polynomial_4567(double u) {
    const double v = u * (1 - u);
    return {u * u * u * u * (35 + u * (-84 + u * (70 - 20 * u))), 140 * v * v * v, 420 * v * v * (1 - 2 * u),
            840 * v * (1 - 5 * v)};
}

// A linear motion and a sine: a quarter period over each of the ends, half a period of a slower one between them.
LawValue modified_sine(double u) {
    const double scale = 1 / (4 + pi);
    const bool start = u <= 0.125, end = u >= 0.875;
    const double w = start || end ? 4 * pi : 4 * pi / 3, phase = start || end ? 0 : pi / 3;
    const double amplitude = start || end ? 0.25 : 2.25, level = start ? 0 : end ? 4 : 2;
    const double s = std::sin(w * u + phase), c = std::cos(w * u + phase);
    return {scale * (level + pi * u - amplitude * s), scale * (pi - amplitude * w * c), scale * amplitude * w * w * s,
            scale * amplitude * w * w * w * c};
}

// The acceleration rises by a sine up to 1/8, is constant up to 3/8, and falls by a cosine. u <= 1/2.
LawValue first_half_of_modified_trapezoid(double u) {
    const double peak = 8 * pi / (2 + pi), w = 4 * pi, c = std::cos(w * u), s = std::sin(w * u);
    if (u <= 0.125) return {peak / w * (u - s / w), peak / w * (1 - c), peak * s, peak * w * c};
    const double v1 = peak / w, s1 = peak / w * (0.125 - 1 / w), past = u - 0.125;
    if (u <= 0.375) return {s1 + v1 * past + 0.5 * peak * past * past, v1 + peak * past, peak, 0};
    const double v2 = v1 + 0.25 * peak, s2 = s1 + 0.25 * v1 + peak / 32, late = u - 0.375;
    const double cl = std::cos(w * late), sl = std::sin(w * late);
    return {s2 + v2 * late + peak / (w * w) * (1 - cl), v2 + peak / w * sl, peak * cl, -peak * w * sl};
}

LawValue modified_trapezoid(double u) {
    if (u <= 0.5) return first_half_of_modified_trapezoid(u);
    const LawValue mirrored = first_half_of_modified_trapezoid(1 - u);
    return {1 - mirrored.s, mirrored.velocity, -mirrored.acceleration, mirrored.jerk};
}

}  // namespace

std::span<const Named<MotionLaw>> names(MotionLaw) {
    using enum MotionLaw;
    static constexpr Named<MotionLaw> all[] = {{dwell, "dwell"},
                                               {cycloidal, "cycloidal"},
                                               {harmonic, "harmonic"},
                                               {polynomial_345, "3-4-5"},
                                               {polynomial_4567, "4-5-6-7"},
                                               {modified_sine, "modified-sine"},
                                               {modified_trapezoid, "modified-trapezoid"}};
    return all;
}

// (S100)
LawValue law_value(MotionLaw law, double u) {
    switch (law) {
        case MotionLaw::dwell:
            return {};
        case MotionLaw::cycloidal:
            return cycloidal(u);
        case MotionLaw::harmonic:
            return harmonic(u);
        case MotionLaw::polynomial_345:
            return polynomial_345(u);
        case MotionLaw::polynomial_4567:
            return polynomial_4567(u);
        case MotionLaw::modified_sine:
            return modified_sine(u);
        case MotionLaw::modified_trapezoid:
            return modified_trapezoid(u);
    }
    return {};
}

std::span<const double> law_breaks(MotionLaw law) {
    static constexpr double kSine[] = {0.125, 0.875}, kTrapezoid[] = {0.125, 0.375, 0.625, 0.875};
    if (law == MotionLaw::modified_sine) return kSine;
    if (law == MotionLaw::modified_trapezoid) return kTrapezoid;
    return {};
}

// The last segment takes up what rounding leaves of the turn, the last rise what it leaves of the sum of the rises.
ProgrammedMotion::ProgrammedMotion(const LawProfile& profile) {
    double start = 0, theta = profile.lowest;
    for (const LawSegment& each : profile.segments) {
        const bool last = segments_.size() + 1 == profile.segments.size();
        const double over = last ? kFullTurn - start : each.over.value_or(0);
        segments_.push_back({each.law, start, over, theta, each.law == MotionLaw::dwell ? 0 : each.rise});
        start += over;
        theta += segments_.back().rise;
    }
    const auto last_rise =
        std::find_if(segments_.rbegin(), segments_.rend(), [](const Segment& s) { return s.rise != 0; });
    if (last_rise == segments_.rend()) return;
    last_rise->rise = profile.lowest - last_rise->theta;
    for (auto later = last_rise.base(); later != segments_.end(); ++later) later->theta = profile.lowest;
}

// (S101)
LeverMotion ProgrammedMotion::at(const Segment& segment, double phi) {
    const double u = (phi - segment.start) / segment.over, b = segment.over;
    const LawValue v = law_value(segment.law, u);
    return {segment.theta + segment.rise * v.s, segment.rise * v.velocity / b, segment.rise * v.acceleration / (b * b),
            segment.rise * v.jerk / (b * b * b)};
}

LeverMotion ProgrammedMotion::at(double phi) const {
    const double turn = phi - kFullTurn * std::floor(phi / kFullTurn);
    const auto after = std::upper_bound(segments_.begin() + 1, segments_.end(), turn,
                                        [](double x, const Segment& s) { return x < s.start; });
    return at(*(after - 1), turn);
}

}  // namespace beamcam::sim
