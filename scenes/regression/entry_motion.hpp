// Judges the motion of one entry, the motions that its picture compares, or its sweep, by comparison with the records
// among its references.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/motions/progress.hpp"
#include "scenes/regression/entry_context.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

// The entry is a table of all channels. Its energy residual, an error of the solver, is not compared.
bool records_all_channels(const Baseline& entry);

class SweepRun;

class EntryMotion {
  public:
    explicit EntryMotion(EntryContext& test) : test_(test) {}

    // A motion by its number (RecordNames). `until`: the last instant that the entry shows [s]. `label` begins the
    // messages.
    void judge(std::size_t number, const std::string& label, const sim::Table& table,
               const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until);

    // Computes its points. Throws sim::Interrupted, SceneError if the sweep is impossible.
    void judge_sweep(int threads, Progress& progress);

  private:
    // Adds a message on unsettled points. Throws SceneError if there are no others.
    void require_settled(const SweepRun& sweep);
    void add(const MotionVerdict& verdict, const std::string& label);
    void add_missing(const std::string& label);
    // Runs `work`, which reads references. An update replaces damaged ones, which are no error then.
    void read(const std::function<void()>& work, const std::string& label);

    EntryContext& test_;
};

}  // namespace beamcam::scenes
