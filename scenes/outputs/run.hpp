// Makes the outputs of scenes: one simulation for each motion, then every file, pictures on several threads with the
// same pixels whatever their number, each file whole or not at all. What is there already is left alone.
#pragma once

#include <span>
#include <stdexcept>
#include <string>

#include "scenes/motions/progress.hpp"
#include "scenes/outputs/draw_callbacks.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

struct RunOptions {
    // Where the outputs' file names begin; empty: they are paths of the command line, taken as they are.
    std::string directory = ".";
    int threads = 0;        // that draw; 0: one for each core
    bool force = false;     // replace files that beamcam did not make, and make all of them anew
    bool no_cache = false;  // neither read nor keep trajectories
    Selection selection;    // a part of the work
    bool quiet = false;     // no word about what was written
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
};

// Some outputs could not be made, which was told; all others were.
struct Incomplete : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Two scenes would write one file.
struct NameClash : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// "-" as a file name is standard output. Throws what sim, render and output throw, NameClash and, at
// the end, Incomplete.
void run(std::span<const Scene> scenes, const RunOptions& options);
void run(const Scene& scene, const RunOptions& options);

// Hands the pictures of a plan, settled and simulated, to whoever compares them.
void draw(const Plan& plan, const Scene& scene, DrawCallbacks& capture, const RunOptions& options);

// What `run` would do, in the light of what is there already.
Plan plan_for(const Scene& scene, const RunOptions& options);

}  // namespace beamcam::scenes
