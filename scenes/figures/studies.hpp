// What figures want of the mechanics: one simulation for each physics, however many figures look at it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/run/simulate.hpp"

namespace beamcam::output {
struct SweepData;
}

namespace beamcam::scenes {

struct Scene;

struct Study {
    sim::Problem problem;
    sim::Request request;
    std::string because;    // who looks furthest
    bool of_scene = false;  // the scene's own physics; told by the plan
    // A physics of the figure's own choosing: where it cannot be integrated to the end its result holds what was
    // reached, or nothing, and the figure does without the rest.
    bool may_fail = false;
};

// Equally spaced instants, both ends included.
struct Instants {
    double from = 0, to = 1;  // [s]
    int count = 2;            // >= 2
    bool operator==(const Instants&) const = default;
};
std::vector<double> instants(const Instants& wanted);

class Studies {
  public:
    // The study of this physics, at least until `end_time` [s]. Apexes and zero crossings only with `turning_points`.
    std::size_t of(const sim::Problem& problem, double end_time, const std::string& because);
    // A table of these instants in the study; tables of equal instants are one, with the channels of both.
    std::size_t table(std::size_t study, const Instants& at, const std::vector<sim::ChannelKind>& channels);
    // A table of its own for a curve: t, `x` and `y`, or t and `y` where x is t, with rows added where it bends, and
    // what `also` names at the same rows.
    std::size_t curve(std::size_t study, const Instants& at, sim::Channel x, sim::Channel y,
                      const std::vector<sim::ChannelKind>& also = {});
    std::size_t point(std::size_t study, double x, const Instants& at);
    void turning_points(std::size_t study) { request(study).turning_points = true; }
    void may_fail(std::size_t study) { all_[study].may_fail = true; }
    void horizon(std::size_t study) { request(study).horizon = true; }

    sim::Request& request(std::size_t i) { return all_[i].request; }
    std::vector<Study> take() { return std::move(all_); }

    // Equal for problems that move alike: every number of the physics.
    static std::string key(const sim::Problem& problem);

  private:
    std::vector<Study> all_;
    std::vector<std::string> keys_;  // of all
    std::vector<std::vector<std::pair<Instants, std::size_t>>> grids_;
};

// The points of a scene's sweep, the values of its tables written out.
struct Swept {
    const Scene* scene;
    const output::SweepData* data;
};

// By study. A figure reads only what it asked for, and of a study that may fail asks `is_there` first.
struct Results {
    std::vector<const sim::Result*> studies = {};
    std::optional<Swept> swept = {};  // for figures of sweeps

    const sim::Result* operator[](std::size_t study) const { return studies[study]; }
};
inline bool is_there(const sim::Result& result) { return result.counters.steps > 0 || !result.tables.empty(); }

// A channel of a table; std::logic_error when it was not asked for.
const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel);

}  // namespace beamcam::scenes
