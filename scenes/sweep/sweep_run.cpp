#include "scenes/sweep/sweep_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "output/data/netcdf_library.hpp"
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
      store_(std::move(store), grid_.points(), grid_.identity(), replace),
      data_(data_of(grid_, store_, shard_)) {}

SweepRun::SweepRun(const Scene& scene) : SweepRun(scene, Shard(), temporary_store(), false) { store_.remove(); }

void SweepRun::reuse_points_of(const std::filesystem::path& file) try {
    if (file.extension() != ".nc" || !std::filesystem::is_regular_file(file)) return;
    const output::SweepData there = output::netcdf_library().open(file);
    for (const char* name : {"beamcam_sweep", "beamcam_program"}) {
        const std::string *one = data_.attribute(name), *other = there.attribute(name);
        if (!other || *one != *other) return;
    }
    for (std::uint64_t k = 0; k < there.points(); ++k)
        if (!store_.has(k) && there.has(k)) store_.add(there.read(k));
} catch (const output::IoError&) {  // points that cannot be read are computed again
}

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
        ++kinds[point.kind];
        ++count;
        if (!point.failure.empty() && failed++ == 0) why = point.failure;
    }
    std::string text = fmt::format("{} in {:.1f} s{}", counted(count, "point"), seconds_, count > 0 ? ":" : "");
    for (const auto& [kind, n] : kinds)
        text += fmt::format("{} {} {}", kind == kinds.begin()->first ? "" : ",", n,
                            name(static_cast<sim::AttractorClass>(kind)));
    if (failed > 0) text += fmt::format("\n{} failed; the first: {}", failed, why);
    return text;
}

}  // namespace beamcam::scenes
