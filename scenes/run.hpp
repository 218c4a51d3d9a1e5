// Carries out a plan: one simulation, then every file, pictures on several threads with the same
// pixels whatever their number, each file whole or not at all.
#pragma once

#include <stdexcept>
#include <string>

#include "scenes/capture.hpp"
#include "scenes/plan.hpp"
#include "scenes/progress.hpp"

namespace beamcam::scenes {

struct RunOptions {
    // Where the outputs' file names begin; empty: they are paths of the command line, taken as they are.
    std::string directory = ".";
    int threads = 0;     // that draw; 0: one for each core
    bool force = false;  // replace files that beamcam did not make
    bool quiet = false;  // no word about what was written
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
    Capture* capture = nullptr;  // absent: simulate, and write files
};

// Signals asked to stop: nothing half-written is left.
struct Stopped : std::runtime_error {
    Stopped() : std::runtime_error("interrupted") {}
};

// "-" as a file name is standard output. Throws what sim, render and output throw, and Stopped.
void run(const Plan& plan, const Scene& scene, const RunOptions& options);

}  // namespace beamcam::scenes
