#include "scenes/sweep/sweep_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "output/files/text_safety.hpp"
#include "sim/base/clock.hpp"
#include "sim/base/counted.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

// A new empty file with a random name.
std::filesystem::path temporary_store() {
    std::string name = (std::filesystem::temp_directory_path() / "beamcam-sweep-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0)
        throw output::IoError(name + ": this temporary file for the points of the sweep cannot be created");
    close(descriptor);
    return name;
}

}  // namespace

SweepRun::SweepRun(const Scene& scene, const Shard& shard, std::filesystem::path store, bool replace)
    : grid_(scene),
      shard_(shard),
      store_(std::move(store), shape_of(grid_), head_of(grid_, shard_), replace),
      data_(data_of(grid_, store_, shard_)) {}

SweepRun::SweepRun(const Scene& scene) : SweepRun(scene, Shard(), temporary_store(), false) { store_.remove(); }

void SweepRun::make(int threads, Progress& progress) {
    const auto started = Clock::now();
    make_points(grid_, shard_, threads, progress, store_);
    seconds_ += seconds_since(started);
}

std::string SweepRun::summary() const {
    std::map<int, std::uint64_t> kinds;
    std::uint64_t failed = 0, count = 0;
    std::string why;
    for (std::uint64_t k = 0; k < grid_.points(); ++k) {
        if (!data_.has(k)) continue;
        const output::StoredPoint point = store_.read(k);
        ++count;
        if (point.failure.empty())
            ++kinds[point.kind];
        else if (failed++ == 0)
            why = point.failure;
    }
    std::string text = fmt::format("{} in {:.1f} s{}", counted(count, "point"), seconds_,
                                   count > 0 ? ":" : ": the sweep has at most " + counted(grid_.tasks(), "part"));
    for (const auto& [kind, n] : kinds)
        text += fmt::format("{} {} {}", kind == kinds.begin()->first ? "" : ",", n,
                            name(static_cast<sim::AttractorClass>(kind)));
    if (failed > 0) text += fmt::format("\n{} failed; the first: {}", failed, output::one_line(why));
    return text;
}

}  // namespace beamcam::scenes
