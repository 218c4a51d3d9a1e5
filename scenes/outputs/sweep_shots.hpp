// The shots of a film of a sweep. Each shows the motion at one value while the diagram grows to it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "render/film/film.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

// The order of the points: increasing values, then decreasing ones for motions that were carried down.
struct SweepOrder {
    std::vector<std::uint64_t> beams;  // the point whose motion is shown, at each place of the order
    std::vector<std::size_t> place;    // of each point
};
SweepOrder sweep_order(const SweepGrid& grid);

// Frames at one value.
struct SweepShot {
    int first = 0, end = 0;
    std::size_t from = 0, last = 0;  // places by which the diagram grows
    std::uint64_t point = 0;         // whose motion is shown
    sim::Problem problem;
    std::vector<sim::Pose> poses;
    std::vector<sim::Impact> impacts;

    // The place that the diagram has reached; it changes every `hold` frames, so that few diagrams are drawn.
    std::size_t grown(int frame, int hold) const;
};

int frames_of(const SweepFilmOutput& how);
std::vector<SweepShot> sweep_shots(const SweepFilmOutput& how, const SweepGrid& grid, const SweepOrder& order);
// Computes the shot's motion. The cam angle is continuous from shot to shot.
void follow(const SweepFilmOutput& how, const output::StoredPoint& point, SweepShot& shot);

// All poses of the film, for the choice of scales and camera.
class SweepPoses final : public render::PoseStore {
  public:
    explicit SweepPoses(const std::vector<SweepShot>& shots);
    std::size_t size() const override { return places_.size(); }
    double time(std::size_t k) const override { return pose(k).t; }
    sim::Pose pose(std::size_t k) const override { return shots_[places_[k].first].poses[places_[k].second]; }

  private:
    const std::vector<SweepShot>& shots_;
    std::vector<std::pair<std::size_t, std::size_t>> places_;
};

}  // namespace beamcam::scenes
