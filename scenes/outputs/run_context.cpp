#include "scenes/outputs/run_context.hpp"

#include "output/files/interrupt.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/plan/up_to_date.hpp"

namespace beamcam::scenes {

void stop_if_interrupted() {
    if (output::interrupted()) throw sim::Interrupted();
}

RunContext::RunContext(const RunOptions& wanted)
    : options(wanted),
      progress(resolve(wanted.progress)),
      manifest(wanted.force),
      cache(open_cache(wanted.no_cache)),
      history(cache ? History(cache->directory()) : History()),
      motions(kept(), &history, progress, {thread_count(wanted.threads), wanted.quiet, wanted.verbose}) {}

}  // namespace beamcam::scenes
