// Collects what the outputs of a scene need of its one simulation. Each type of output adds its own (outputs/).
#pragma once

#include <string>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

class Planner {
  public:
    Planner(const Scene& scene, const Selection& selection, const ExistingWork& existing);
    Plan make();

    // ---- for the types of outputs ----

    const Scene& scene() const { return scene_; }
    const Selection& selection() const { return selection_; }
    // Where the run of all outputs ends, finished ones too.
    double run_end() const;
    // The scene's motion is needed until `t` [s], because of `file`.
    void simulate_until(double t, const std::string& file);
    void simulate_until(const Instant& event, const std::string& file);
    std::size_t add_table(std::vector<double> times, std::vector<sim::Channel> channels);  // its index
    sim::Request& request() { return simulation_.request; }
    void require_sweep(const std::string& file) {
        if (plan_.sweep.empty()) plan_.sweep = file;
    }
    void require_sweep_end_states() { plan_.sweep_end_states = true; }
    void skip(std::string what, std::string why) { plan_.skipped.push_back({std::move(what), std::move(why)}); }
    void require_horizon() { simulation_.request.horizon = simulation_.horizon = true; }

    void add(Pictures p, double ends);  // `ends`: the latest instant that the pictures can look at [s]
    void add(FigureFile figure);
    // Of what is not settled: its motion is searched for events; for `all` until then, or for those that it names.
    void find_events(double until, bool all);
    void add(DataFile data) { plan_.data.push_back(std::move(data)); }

  private:
    void finish_simulation();
    void resolve_cache_use(Simulation& simulation, std::optional<double> kept_until) const;
    void add_study(const Study& study, const FigureFile& figure);
    void add_own_motion(Pictures& p, double ends);
    void add_compared(Pictures& p);
    void note_left_frames(const Pictures& p, std::size_t count);
    void note_skipped();
    void note_unread_channels();

    const Scene& scene_;
    const Selection& selection_;
    const ExistingWork& existing_;
    Plan plan_;
    Simulation simulation_;
    std::vector<sim::Request> figures_ask_;  // of the scene's motion
    bool needed_ = false;
    int finished_ = 0;
};

}  // namespace beamcam::scenes
