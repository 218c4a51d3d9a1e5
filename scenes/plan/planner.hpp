// Collects what the outputs of a scene need from its simulation. Each output type adds its part (outputs/).
#pragma once

#include <string>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

class Planner {
  public:
    Planner(const Scene& scene, const Shard& shard, const ExistingWork& existing);
    Plan make();

    // ---- called by the output types ----

    const Scene& scene() const { return scene_; }
    const Shard& shard() const { return shard_; }
    // End of a run for all outputs, up-to-date ones included [s].
    double run_end() const;
    // The scene's motion is needed until `t` [s], or until an event that has to be found first.
    void simulate_until(double t);
    void simulate_until_event();
    std::size_t add_table(std::vector<double> times, std::vector<sim::Channel> channels);  // returns its index
    sim::Request& request() { return simulation_.request; }
    void require_sweep(const std::string& file) {
        if (plan_.sweep.empty()) plan_.sweep = file;
    }
    void require_horizon() { simulation_.request.horizon = simulation_.horizon = true; }

    void add(Pictures p, double end);  // `end`: the last time that the pictures can need [s]
    void add(FigureFile figure);
    // A first run until `until` [s] finds events: all of them, or at least those that outputs name.
    void find_events(double until, bool all);
    void add(DataFile data) { plan_.data.push_back(std::move(data)); }

  private:
    void add_study(const Study& study, bool ends_at_event, const std::string& label = {});
    void add_requests(const Pictures& p, Study& motion) const;

    const Scene& scene_;
    const Shard& shard_;
    const ExistingWork& existing_;
    Plan plan_;
    PlannedMotion simulation_;
    bool needed_ = false;
};

}  // namespace beamcam::scenes
