// The simulations that figures need: one for each physics, shared by all figures.
#pragma once

#include <optional>
#include <string>
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
    bool operator==(const Instants&) const = default;
};
std::vector<double> instants(const Instants& grid);

class Studies {
  public:
    // The study of this motion, at least until `end_time` [s]. Apexes and zero crossings of θ only where `apexes` and
    // `zero_crossings` are called.
    std::size_t of(const sim::Problem& problem, double end_time);
    // A table of these instants in the study; tables of equal instants are one, with the channels of both.
    std::size_t table(std::size_t study, const Instants& at, const std::vector<sim::ChannelKind>& channels);
    // A separate table for a curve: t, `x` and `y`, or t and `y` where x is t, with rows added where the curve bends,
    // and the channels `also` at the same rows. `drawn`: ends of the drawn part of x.
    std::size_t curve(std::size_t study, const Instants& at, sim::Channel x, sim::Channel y,
                      const std::vector<sim::Channel>& also = {},
                      const std::pair<double, double>& drawn = sim::TableRequest().drawn);
    std::size_t add_table(std::size_t study, sim::TableRequest table);
    std::size_t point(std::size_t study, double x, const Instants& at);
    void apexes(std::size_t study) { request(study).apexes = true; }
    void zero_crossings(std::size_t study) { request(study).zero_crossings = true; }
    void horizon(std::size_t study) { request(study).horizon = true; }

    sim::Request& request(std::size_t i) { return all_[i].request; }
    std::vector<MotionRequest> take() { return std::move(all_); }

  private:
    std::vector<MotionRequest> all_;
    std::vector<std::vector<std::pair<Instants, std::size_t>>> grids_;
};

// The points of a scene's sweep, the values of its tables written out.
struct Swept {
    const Scene* scene;
    const output::SweepData* data;
};

// By study. A figure reads only what it requested.
struct Results {
    std::vector<const sim::Result*> studies = {};
    std::optional<Swept> swept = {};  // for figures of sweeps

    const sim::Result* operator[](std::size_t study) const { return studies[study]; }
};

// A channel of a table; throws std::logic_error if it was not requested.
const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel);

}  // namespace beamcam::scenes
