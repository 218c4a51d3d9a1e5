// What the scenes of one call of `run` share: options, the record of files, motions, counts and times.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "output/data/manifest.hpp"
#include "output/files/standard_output.hpp"
#include "output/files/work.hpp"
#include "scenes/motions/motion_store.hpp"
#include "scenes/outputs/run.hpp"
#include "sim/base/clock.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

void stop_if_interrupted();  // throws sim::Interrupted
inline bool is_stdout(const std::string& file) { return file == "-"; }

// Where the time went [s], for -v; drawing is summed over threads.
struct Times {
    double simulate = 0, draw = 0, read_back = 0, convert = 0, encode = 0, write = 0;
    int threads = 0;  // that drew
};

struct RunContext {
    explicit RunContext(const RunOptions& options);

    const Cache* kept() const { return cache ? &*cache : nullptr; }
    // A message, unless the run is quiet.
    template <class... Values>
    void say(fmt::format_string<Values...> words, Values&&... values) const {
        if (!options.quiet) output::print_message(words, std::forward<Values>(values)...);
    }

    const RunOptions& options;
    Progress progress;
    output::Manifest manifest;
    std::optional<Cache> cache;
    History history;
    MotionStore motions;
    output::Work work;
    Times times;
    std::size_t refused = 0;  // outputs that cannot be made
    Clock::time_point started = Clock::now();
};

}  // namespace beamcam::scenes
