// A sweep made to be compared: its points in a folder of their own that is gone afterwards.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "output/data/table_reader.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/regression/tolerance.hpp"
#include "scenes/sweep/sweep_run.hpp"

namespace beamcam::scenes {

class MadeSweep {
  public:
    // Throws SceneError for a sweep that cannot be made, sim::Interrupted, IoError.
    MadeSweep(const Scene& scene, int threads, Progress& progress);
    ~MadeSweep();
    MadeSweep(const MadeSweep&) = delete;
    MadeSweep& operator=(const MadeSweep&) = delete;

    output::NamedTable table() const;
    std::uint64_t points() const { return made_->grid().points(); }
    // Points that may be another one on another processor: unsettled ones, and those that are when the sweep is made
    // again with a little more gravity, speed and eccentricity of the cam.
    std::vector<bool> unsure(const Tolerance& tolerance, int threads, Progress& progress) const;
    // As `beamcam sweep -o` does, the unsure points without samples, as unsettled ones.
    void write(const output::Target& file, const std::vector<bool>& unsure) const;

  private:
    const std::filesystem::path folder_;
    std::unique_ptr<SweepRun> made_;
};

}  // namespace beamcam::scenes
