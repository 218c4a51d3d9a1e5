// Texts of films: parameter line, speed, clock. As markup (render/draw/markup.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/plot/lang.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

enum class SpeedUnit { automatic, radians, degrees, rpm };  // of angular speeds; automatic: rad/s
double factor_of(SpeedUnit unit);                           // from rad/s
const char* name_of(SpeedUnit unit);                        // "°/s"

// Pieces of the parameter line, most important first: "L = 1 m", "R = 100 mm", "2 modes", …
std::vector<std::string> parameter_pieces(const sim::Problem& problem, Lang lang = {}, SpeedUnit unit = {});
// The pieces that all problems share, then for each problem its label and the other pieces that the label does not
// have: "rigid: rigid beam".
std::vector<std::string> compared_pieces(const std::vector<const sim::Problem*>& problems,
                                         const std::vector<std::string>& labels, Lang lang, SpeedUnit unit);

// "0.5 rad/s", "−300 rpm": without SI prefixes, with three digits. `speed` in rad/s.
std::string turning_speed(double speed, SpeedUnit unit);

// Of a frame: "1/50 speed", "2× speed", "0.524× speed", "frozen"; empty at real time. `steady`: of a film at one speed;
// otherwise changing speeds are rounded to simple fractions.
std::string speed_text(double speed, bool steady, Lang lang = {});
// Whether a film runs at one speed, apart from freezes.
bool steady_speed(const std::vector<double>& speeds);
// The longest of the texts, for which a film reserves room.
std::string widest_speed_text(const std::vector<double>& speeds, Lang lang);

// The format of instants: unit, and enough decimals to distinguish neighbouring frames.
struct TimeFormat {
    double unit = 1;  // [s]
    const char* symbol = "s";
    int decimals = 3;
};
// Seconds, or a smaller unit if all frames and `latest` are below 0.2 s.
TimeFormat time_format(const std::vector<double>& frame_times, double latest = 0);
std::string clock_text(const TimeFormat& format, double t);

// 1e8 → "10⁸", 2.5e7 → "2.5·10⁷", 1200 → "1200"; exponents as superscripts.
std::string power_text(double value);

}  // namespace beamcam::render
