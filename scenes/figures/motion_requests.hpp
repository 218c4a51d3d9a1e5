// The motions that a figure needs, and their results.
#pragma once

#include <optional>
#include <vector>

#include "scenes/motions/motion_request.hpp"

namespace beamcam::output {
struct SweepData;
}

namespace beamcam::scenes {

struct Scene;

// Equally spaced instants, both ends included.
struct Instants {
    double from = 0, to = 1;  // [s]
    int count = 2;            // >= 2
};
std::vector<double> instants(const Instants& grid);

// Motions are named by their index; so are the tables and points of each. Equal motions share one integration later.
class MotionRequests {
  public:
    // A motion until `end_time` [s]. Its zero crossings of θ are found only where `zero_crossings` is called.
    std::size_t motion(const sim::Problem& problem, double end_time);
    std::size_t table(std::size_t motion, const Instants& at, const std::vector<sim::ChannelKind>& channels);
    // A table for a curve: t, `x` and `y`, or t and `y` where x is t, with rows added where the curve bends, and the
    // channels `also` at the same rows. `drawn`: ends of the drawn part of x.
    std::size_t curve(std::size_t motion, const Instants& at, sim::Channel x, sim::Channel y,
                      const std::vector<sim::Channel>& also = {},
                      const std::pair<double, double>& drawn = sim::TableRequest().drawn);
    std::size_t add_table(std::size_t motion, sim::TableRequest table);
    std::size_t point(std::size_t motion, double x, const Instants& at);
    void zero_crossings(std::size_t motion) { request(motion).zero_crossings = true; }
    void horizon(std::size_t motion) { request(motion).horizon = true; }

    sim::Request& request(std::size_t motion) { return all_[motion].request; }
    std::vector<MotionRequest> take() { return std::move(all_); }

  private:
    std::vector<MotionRequest> all_;
};

// The points of a scene's sweep, the values of its tables written out.
struct SweepResult {
    const Scene* scene;
    const output::SweepData* data;
};

// The results of the requests, by motion. A figure reads only what it requested.
struct MotionResults {
    std::vector<const sim::Result*> motions = {};
    std::optional<SweepResult> sweep = {};  // for figures of sweeps

    const sim::Result* operator[](std::size_t motion) const { return motions[motion]; }
};

// A channel of a table; throws std::logic_error if it was not requested.
const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel);

}  // namespace beamcam::scenes
