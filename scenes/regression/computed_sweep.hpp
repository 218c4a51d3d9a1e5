// A sweep that is computed for comparison; its points are in a temporary folder.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "output/data/table_reader.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/regression/tolerance.hpp"
#include "scenes/sweep/sweep_run.hpp"

namespace beamcam::scenes {

class ComputedSweep {
  public:
    // Throws SceneError if the sweep is impossible, sim::Interrupted, IoError.
    ComputedSweep(const Scene& scene, int threads, Progress& progress);

    output::NamedTable table() const;
    std::uint64_t points() const { return run_->grid().points(); }
    // Points that may differ on another processor: unsettled points, and points that change if the sweep is repeated
    // with slightly more gravity, speed and eccentricity of the cam.
    std::vector<bool> uncertain(const Tolerance& tolerance, int threads, Progress& progress) const;
    // As `beamcam sweep -o` writes it; uncertain points are unsettled and have no samples.
    void write(const output::Target& file, const std::vector<bool>& uncertain) const;

  private:
    struct TemporaryFolder {
        TemporaryFolder();
        ~TemporaryFolder();
        TemporaryFolder(const TemporaryFolder&) = delete;
        TemporaryFolder& operator=(const TemporaryFolder&) = delete;
        const std::filesystem::path path;
    };
    const TemporaryFolder folder_;
    std::unique_ptr<SweepRun> run_;
};

}  // namespace beamcam::scenes
