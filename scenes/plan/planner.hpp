// Collects what the outputs of a scene need from its simulation. Each output type adds its part (outputs/).
#pragma once

#include <string>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

class Planner {
  public:
    Planner(const Scene& scene, const Selection& selection, const ExistingWork& existing);
    Plan make();

    // ---- called by the output types ----

    const Scene& scene() const { return scene_; }
    const Selection& selection() const { return selection_; }
    // End of a run for all outputs, up-to-date ones included [s].
    double run_end() const;
    // `file` needs the scene's motion until `t` [s] or until an event.
    void simulate_until(double t, const std::string& file);
    void simulate_until(const Instant& event, const std::string& file);
    std::size_t add_table(std::vector<double> times, std::vector<sim::Channel> channels);  // returns its index
    sim::Request& request() { return simulation_.request; }
    void require_sweep(const std::string& file) {
        if (plan_.sweep.empty()) plan_.sweep = file;
    }
    void skip(std::string what, std::string why) { plan_.skipped.push_back({std::move(what), std::move(why)}); }
    void require_horizon() { simulation_.request.horizon = simulation_.horizon = true; }

    void add(Pictures p, double end);  // `end`: the last time that the pictures can need [s]
    void add(FigureFile figure);
    // A first run until `until` [s] finds events: all of them, or at least those that outputs name.
    void find_events(double until, bool all);
    void add(DataFile data) { plan_.data.push_back(std::move(data)); }

  private:
    void add_study(const Study& study, const std::string& file, const std::optional<Instant>& ends_at,
                   const std::string& label = {});
    void add_requests(const Pictures& p, Study& motion) const;
    void add_skipped_frames(const Pictures& p, std::size_t count);
    void add_skipped_stages();
    void add_unread_channels();

    const Scene& scene_;
    const Selection& selection_;
    const ExistingWork& existing_;
    Plan plan_;
    Simulation simulation_;
    std::vector<sim::Request> study_requests_;  // of pictures and figures, for the scene's motion
    bool needed_ = false;
    int finished_ = 0;
};

}  // namespace beamcam::scenes
