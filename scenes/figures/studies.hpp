// What figures want of the mechanics: one simulation for each physics, however many figures look at it.
#pragma once

#include <string>
#include <vector>

#include "sim/simulate.hpp"

namespace beamcam::scenes {

struct Study {
    sim::Problem problem;
    sim::Request request;
    std::string because;  // who looks furthest
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
    Studies() = default;
    // With a main physics: its request is the caller's, as study 0, and grows with what figures add.
    Studies(const sim::Problem& main, sim::Request& request) : main_(&request) { keys_.push_back(key(main)); }

    // The study of this physics, at least until `end_time` [s].
    std::size_t of(const sim::Problem& problem, double end_time, const std::string& because);
    // A table of these instants in the study; tables of equal instants are one, with the channels of both.
    std::size_t table(std::size_t study, const Instants& at, const std::vector<sim::ChannelKind>& channels);
    std::size_t point(std::size_t study, double x, const Instants& at);
    void horizon(std::size_t study) { request(study).horizon = true; }

    sim::Request& request(std::size_t i) { return main_ ? (i == 0 ? *main_ : own_[i - 1].request) : own_[i].request; }
    // Who needs the main physics longest, and until when; nothing when nobody does.
    const std::string& main_because() const { return main_because_; }
    double main_until() const { return main_until_; }
    // Those that are not the caller's.
    std::vector<Study> take() { return std::move(own_); }

    // Equal for problems that move alike: every number of the physics.
    static std::string key(const sim::Problem& problem);

  private:
    sim::Request* main_ = nullptr;
    std::string main_because_;
    double main_until_ = 0;
    std::vector<Study> own_;
    std::vector<std::string> keys_;  // of all, main first
    std::vector<std::vector<std::pair<Instants, std::size_t>>> grids_;
};

// By study. A figure reads only what it asked for.
using Results = std::vector<const sim::Result*>;

// A channel of a table; std::logic_error when it was not asked for.
const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel);

}  // namespace beamcam::scenes
