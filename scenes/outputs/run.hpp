// Writes the outputs of scenes: one simulation for each motion, then all files; pictures on several threads with the
// same pixels whatever their number. Every file appears complete or not at all. Up-to-date files are kept.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/draw/image.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/plan/plan.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

struct RunOptions {
    // Folder of the outputs; empty: the file names are paths of the command line.
    std::string directory = ".";
    int threads = 0;     // for drawing; 0: one for each core
    bool force = false;  // replace foreign files, and write up-to-date files again
    bool quiet = false;  // do not report written files
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
};

// Some outputs could not be written, as reported; all others were written. Nested in it: the first error.
struct Incomplete : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Two scenes would write one file.
struct NameClash : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The file name "-" is standard output. Throws what sim, render and output throw, NameClash and, at the end,
// Incomplete.
void run(std::span<const Scene> scenes, const RunOptions& options);
void run(const Scene& scene, const RunOptions& options);

// Receives images, for commands that compare pictures.
struct DrawCallbacks {
    // A frame, numbered from 0 in each output. Several threads call this concurrently, in any order.
    std::function<void(const PlannedPictures&, long frame, const render::Image&)> picture;
    std::function<void(const render::Image&)> figure;  // in pixels, whatever the ending of its file
};
// Draws the pictures and figures of a plan. `results`: of its motions.
void draw(const PlanWithFigures& plan, const Scene& scene, std::vector<sim::Result> results, DrawCallbacks& callbacks,
          const RunOptions& options);

// The plan that `run` would carry out now, made without integrating: outputs whose times depend on events wait.
Plan plan_for(const Scene& scene, const RunOptions& options);

}  // namespace beamcam::scenes
