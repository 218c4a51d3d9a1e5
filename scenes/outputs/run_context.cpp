#include "scenes/outputs/run_context.hpp"

#include "output/files/interrupt.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/plan/up_to_date.hpp"

namespace beamcam::scenes {

void stop_if_interrupted() {
    if (output::interrupted()) throw sim::Interrupted();
}

RunContext::RunContext(const RunOptions& run_options)
    : options(run_options),
      progress(resolve(run_options.progress)),
      manifest(run_options.force),
      cache(open_cache(run_options.no_cache)),
      history(cache ? History(cache->directory()) : History()),
      motions(cache_or_null(), &history, progress,
              {thread_count(run_options.threads), run_options.quiet, run_options.verbose}) {}

}  // namespace beamcam::scenes
