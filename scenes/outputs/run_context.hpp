// The scenes of one `run` share this: options, list of files, motions, counts and times.
#pragma once

#include <exception>
#include <utility>

#include "output/data/file_list.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/motions/motion_pool.hpp"
#include "scenes/outputs/run.hpp"
#include "sim/base/clock.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

// Times of the stages [s], for -v; drawing is summed over threads.
struct Times {
    double simulate = 0, draw = 0, convert = 0, encode = 0, write = 0;
    int threads = 0;  // for drawing
};

// Counts of the work, by which tests prove that nothing unnecessary is done.
struct Work {
    long integrations = 0;  // of equations of motion, except for sweeps; a horizon takes two
    long steps = 0, rhs_evaluations = 0, gap_evaluations = 0;
    long sweep_points = 0;                                                   // computed
    long font_sets = 0, gl_contexts = 0, encoder_modules = 0, encoders = 0;  // loaded or opened
    long frames_drawn = 0, figures_drawn = 0;
    long bodies_drawn = 0;     // drawn by OpenGL; a frame whose mechanism is unchanged reuses the last one
    long frames_repeated = 0;  // of films: equal to the previous frame, neither drawn nor converted
    long frames_encoded = 0;
    long frames_left = 0;  // of sequences: up to date
    long files_written = 0, files_left = 0;
    long bytes_written = 0;
};

struct RunContext {
    explicit RunContext(const RunOptions& options);

    // Prints a message unless the run is quiet.
    template <class... Values>
    void print(fmt::format_string<Values...> text, Values&&... values) const {
        if (!options.quiet) output::print_message(text, std::forward<Values>(values)...);
    }

    const RunOptions& options;
    Progress progress;
    output::FileList file_list;
    MotionPool motions;
    Work work;
    Times times;
    std::size_t rejected = 0;        // outputs that could not be written
    std::exception_ptr first_error;  // of them
    Clock::time_point started = Clock::now();
};

}  // namespace beamcam::scenes
