// A sweep that is made: its points, in a file that keeps them until what is written from them is whole.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "scenes/figures/studies.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

class SweepRun {
  public:
    // `store`: where the points stand until `remove`; what an earlier run left there is not made again. Throws what
    // SweepGrid and PointStore throw.
    SweepRun(const Scene& scene, const SweepPart& part, std::filesystem::path store);
    // The whole sweep, whose points no file keeps beyond this.
    explicit SweepRun(const Scene& scene);

    bool dropped_others() const { return store_.dropped_others(); }  // points of another sweep or version in the store
    std::uint64_t points_there() const { return store_.count(); }
    // The points of a finished .nc file of the same sweep by the same program; none of another or a damaged one.
    void take_from(const std::filesystem::path& file);
    void make(int threads, Progress& progress);  // as make_points
    const SweepGrid& grid() const { return grid_; }
    const output::SweepData& data() const { return data_; }   // as long as this lives
    Swept swept() const { return {&grid_.scene(), &data_}; }  // for figures
    output::StoredPoint read(std::uint64_t point) const { return store_.read(point); }
    // "601 points in 1.2 s: 24 following, 577 periodic", and what could not be followed.
    std::string summary() const;
    void remove() { store_.remove(); }

  private:
    const SweepGrid grid_;
    const SweepPart part_;
    output::PointStore store_;
    output::SweepData data_;
    double seconds_ = 0;
};

}  // namespace beamcam::scenes
