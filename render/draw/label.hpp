// Labels set in one line: where the runs of a markup (markup.hpp) stand, and the lines of fractions and roots. Figures
// and the formulas of films are set by the same rules; only their letters differ.
#pragma once

#include <functional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {

// What setting needs to know of the letters that a label is written in.
struct LetterMetrics {
    struct Extent {
        double advance = 0;  // to where the next run begins
        double top = 0;      // of its letters, above the baseline: dots stand over it
    };
    std::function<Extent(const Run& run, double size)> measure;
    double cap_height = 0.72;  // of capitals and digits, by the size
    double smallest = 0;       // no letter is smaller, scripts included
};

struct SetRun {
    Run run;
    double x = 0, y = 0;  // of the baseline's start
    double size = 0, advance = 0, top = 0;
};
struct SetLabel {
    std::vector<SetRun> runs;
    std::vector<std::vector<Vec2>> rules;  // of fractions and roots
    double width = 0, ascent = 0, descent = 0;
    double smallest_letter = 1e9;
};
SetLabel set_label(const std::vector<Run>& runs, double size, const LetterMetrics& letters);

inline constexpr double kRuleWidth = 0.055;  // of the lines of fractions and roots, by the size of the letters

}  // namespace beamcam::render
