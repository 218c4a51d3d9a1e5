// Layout of a label in one line: positions of the runs of a markup (markup.hpp), and the lines of fractions and roots.
// Figures and films use the same rules with different fonts.
#pragma once

#include <functional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {

// Metrics of the font of a label.
struct LetterMetrics {
    struct Extent {
        double advance = 0;  // to the start of the next run
        double top = 0;      // height above the baseline, where dots are placed
    };
    std::function<Extent(const Run& run, double size)> measure;
    double cap_height = 0.72;  // of capitals and digits, relative to the size
    double smallest = 0;       // smallest size of letters, scripts included
};

struct SetRun {
    Run run;
    double x = 0, y = 0;  // of the baseline's start
    double size = 0, advance = 0, top = 0;
};
struct SetLabel {
    std::vector<SetRun> runs;
    std::vector<std::vector<Vec2>> rules;  // lines of fractions and roots
    double width = 0, ascent = 0, descent = 0;
    double smallest_letter = 1e9;
};
SetLabel set_label(const std::vector<Run>& runs, double size, const LetterMetrics& letters);

inline constexpr double kRuleWidth =
    0.055;  // width of the lines of fractions and roots, relative to the size of the letters

}  // namespace beamcam::render
