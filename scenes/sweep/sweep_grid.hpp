// The points of a sweep: the problem and the start of each, and the tasks that can run in parallel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

class SweepGrid {
  public:
    // Throws SceneError for an impossible problem at one of the values and for too many points.
    explicit SweepGrid(const Scene& scene);

    // Motions in sequence: a row of carried starts, or a single motion.
    struct Task {
        std::vector<std::uint64_t> points;
        bool carries = false;
    };

    const std::vector<output::SweepAxis>& axes() const { return axes_; }
    std::uint64_t seeds() const { return seeds_.size(); }
    SeedKind seed(std::uint64_t point) const { return seeds_[point % seeds_.size()]; }
    std::uint64_t points() const { return cells_ * seeds_.size(); }
    std::uint64_t tasks() const;
    Task task(std::uint64_t index) const;
    sim::Problem problem(std::uint64_t point) const;
    const sim::Sampling& sampling() const { return scene_.sweep->sampling; }
    const Sweep& sweep() const { return *scene_.sweep; }

    // The scene reduced to what determines the points.
    const Scene& scene() const { return scene_; }
    std::string digest() const;    // of scene()
    std::string identity() const;  // of scene() and this program

  private:
    void check() const;
    void set(sim::Problem& problem, const std::string& key, double value) const;

    Scene scene_;
    std::vector<output::SweepAxis> axes_;
    std::vector<SeedKind> seeds_;
    std::vector<RandomKey> random_;
    std::uint64_t cells_ = 1;
    std::vector<std::uint64_t> single_, carried_;  // seeds without and with carried starts
};

}  // namespace beamcam::scenes
