// The shots of a film of a sweep: at one value each, the motion of the beam there, while the diagram grows to it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "render/film/film.hpp"
#include "scenes/sweep/make_points.hpp"

namespace beamcam::scenes {

// The order in which the points come: up through the values, and down where motions were carried so.
struct SweepOrder {
    std::vector<std::uint64_t> beams;  // the point whose beam moves, at each place of the order
    std::vector<std::size_t> place;    // of each point
};
SweepOrder sweep_order(const SweepGrid& grid);

// Frames at one value.
struct SweepShot {
    int first = 0, end = 0;
    std::size_t from = 0, last = 0;  // places by which the diagram grows meanwhile
    std::uint64_t point = 0;         // whose beam is seen
    sim::Problem problem;
    std::vector<sim::Pose> poses;
    std::vector<sim::Impact> impacts;

    // How far the diagram has grown, by whole steps of `hold` frames, so that few diagrams are drawn.
    std::size_t grown(int frame, int hold) const;
};

int frames_of(const SweepFilmOutput& how);
std::vector<SweepShot> sweep_shots(const SweepFilmOutput& how, const SweepGrid& grid, const SweepOrder& order);
// Computes the shot's motion. The cam turns evenly through all shots: each begins where it stands then.
void follow(const SweepFilmOutput& how, const output::StoredPoint& point, SweepShot& shot);

// All poses of the film, by which scales and camera are chosen.
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
