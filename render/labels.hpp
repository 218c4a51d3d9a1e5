// The words of a picture: parameter line, clock, readings. Markup for Canvas::text; no drawing here.
#pragma once

#include <string>
#include <vector>

#include "sim/problem.hpp"

namespace beamcam::render {

// Pieces of the parameter line, most important first: "L = 1 m", "R = 100 mm", "2 modes", …
std::vector<std::string> parameter_pieces(const sim::Problem& problem);

// How instants are written: the unit and the decimals that tell neighbouring frames apart.
struct TimeFormat {
    double unit = 1;  // [s]
    const char* symbol = "s";
    int decimals = 3;
};
TimeFormat time_format(const std::vector<double>& frame_times);
std::string clock_text(const TimeFormat& format, double t);

// 1e8 → "10⁸", 2.5e7 → "2.5·10⁷", 1200 → "1200"; exponents as superscripts.
std::string power_text(double value, int digits = 3);

}  // namespace beamcam::render
