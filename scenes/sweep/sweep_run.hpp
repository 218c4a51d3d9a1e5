// A sweep in progress: its points, in a file that keeps them until all output files are complete.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/figures/motion_requests.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

class SweepRun {
  public:
    // `store`: file of the points until `remove`; it may contain points of an interrupted run, which `replace` discards
    // if they are of another sweep. Throws what SweepGrid and PointStore throw.
    SweepRun(const Scene& scene, const Shard& shard, std::filesystem::path store, bool replace);
    // The whole sweep, with a temporary store.
    explicit SweepRun(const Scene& scene);

    std::uint64_t points_there() const { return store_.count(); }
    void make(int threads, Progress& progress);  // see make_points
    const SweepGrid& grid() const { return grid_; }
    const output::SweepData& data() const { return data_; }          // valid during the lifetime of this
    SweepResult result() const { return {&grid_.scene(), &data_}; }  // for figures
    output::StoredPoint read(std::uint64_t point) const { return store_.read(point); }
    // "601 points in 1.2 s: 24 following, 577 periodic", and the failures.
    std::string summary() const;
    void remove() { store_.remove(); }

  private:
    const SweepGrid grid_;
    const Shard shard_;
    output::PointStore store_;
    output::SweepData data_;
    double seconds_ = 0;
};

}  // namespace beamcam::scenes
