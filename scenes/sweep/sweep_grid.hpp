// The points of a sweep: which problem each has, where it starts, and which of them are made one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

class SweepGrid {
  public:
    // Of a scene with a sweep, whose tables are read. Throws SceneError: an impossible problem at one of the values,
    // too many points; what write_out_tables throws.
    explicit SweepGrid(const Scene& scene);

    // Motions that are made one after the other: a row of carried starts, or a single one.
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

    // The scene with nothing but what decides about the points, values of tables written out.
    const Scene& scene() const { return scene_; }
    std::string digest() const;    // of it
    std::string identity() const;  // the same with this program

  private:
    void judge() const;
    void set(sim::Problem& problem, const std::string& key, double value) const;

    Scene scene_;
    std::vector<output::SweepAxis> axes_;
    std::vector<SeedKind> seeds_;
    std::vector<RandomKey> random_;
    std::uint64_t cells_ = 1;
    std::vector<std::uint64_t> single_, carried_;  // seeds by whether they carry
};

}  // namespace beamcam::scenes
