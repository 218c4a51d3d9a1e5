// Layout of a label in one line: positions of the runs of a markup (markup.hpp).
// Figures and films use the same rules with different fonts (letters.hpp).
#pragma once

#include <functional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {

// What the rules need of the fonts; all but `smallest` relative to the size of the letters.
struct LetterRules {
    double cap_height = 0.72;                                  // of capitals and digits
    double smallest = 0;                                       // size of letters, scripts included
    double script_size = 0.72, raised = 0.36, lowered = 0.17;  // size and baseline offsets of scripts
    double behind_italic = 0.03;                               // space between an italic and an upright letter
};

struct SetRun {
    Run run;
    double x = 0, y = 0;  // of the baseline's start
    double size = 0, advance = 0, top = 0;
};
// Of the letters of a run.
struct RunExtent {
    double advance = 0;  // to the start of the next run
    double top = 0;      // height above the baseline, where dots are placed
    Box ink = {};        // relative to the baseline's start
};
struct SetLabel {
    std::vector<SetRun> runs;
    double width = 0, ascent = 0, descent = 0;
    Bounds ink = {};
    double smallest_letter = 1e9;
};
// `extent`: of a run with its place and size.
SetLabel set_label(const std::vector<Run>& runs, double size, const LetterRules& rules,
                   const std::function<RunExtent(const SetRun& run)>& extent);

}  // namespace beamcam::render
