// The words of a picture: parameter line, clock, readings. Markup for Canvas::text; no drawing here.
#pragma once

#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::render {

// Pieces of the parameter line, most important first: "L = 1 m", "R = 100 mm", "2 modes", …
std::vector<std::string> parameter_pieces(const sim::Problem& problem, bool rpm = false);
// Those that several problems have in common.
std::vector<std::string> common_pieces(const std::vector<const sim::Problem*>& problems, bool rpm = false);

// "0.5 rad/s", "−300 rpm": without SI prefixes. `speed` in rad/s.
std::string turning_speed(double speed, bool rpm, int digits = 3);

// Of a frame: "1/50 speed", "2× speed", "0.524× speed", "frozen"; empty at the true speed. Speeds on the way from one
// to another are told by a round fraction.
std::string speed_text(double speed, bool steady);
// Whether a film runs at one speed, but where it stands.
bool steady_speed(const std::vector<double>& speeds);
// The longest of the texts, which a film keeps room for.
std::string widest_speed_text(const std::vector<double>& speeds);

// How instants are written: the unit and the decimals that tell neighbouring frames apart.
struct TimeFormat {
    double unit = 1;  // [s]
    const char* symbol = "s";
    int decimals = 3;
};
TimeFormat time_format(const std::vector<double>& frame_times);
// Room is left for as many digits as the last instant has, so that nothing moves when there is one more.
std::string clock_text(const TimeFormat& format, double t, double last);

std::string pango_power_of_ten(int exponent);  // with a superscript
// 1e8 → "10⁸", 2.5e7 → "2.5·10⁷", 1200 → "1200"; exponents as superscripts.
std::string power_text(double value, int digits = 3);

}  // namespace beamcam::render
