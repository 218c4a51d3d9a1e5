// Judges the motion of one entry, the motions that its picture compares, or its sweep, by comparison with the records
// among its references.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/motions/progress.hpp"
#include "scenes/regression/entry_files.hpp"
#include "scenes/regression/motion_record.hpp"

namespace beamcam::scenes {

// The entry is a table of all channels. Its energy residual, an error of the solver, is not compared.
bool records_all_channels(const Baseline& entry);

class EntryMotion {
  public:
    explicit EntryMotion(const EntryContext& test) : test_(test) {}

    // `until`: the last instant that the entry shows [s].
    void judge(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
               std::optional<double> reproducible_until);

    // The table that is recorded of a motion that the picture compares; it ends where the accepted motion ceases to be
    // reproducible.
    sim::TableRequest compared_table(std::size_t index, const sim::Problem& problem, double until) const;
    void judge_compared(std::size_t index, const std::string& label, sim::Table table,
                        const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until);

    // Computes its points. Throws sim::Interrupted, SceneError if the sweep is impossible.
    void judge_sweep(int threads, Progress& progress);

  private:
    using Files = std::function<output::Target(const std::string& name)>;

    bool is_stored() const {
        return test_.tested.folder && (test_.tested.all || *test_.result.motion > Verdict::equivalent);
    }
    void store(const std::vector<std::string>& names, const std::function<void(const Files&)>& write);
    void judge_record(const RecordNames& names, const std::string& label, const sim::Table& table,
                      const std::vector<sim::Impact>& impacts, double until, double horizon);
    void add(const MotionVerdict& verdict, const std::string& label, const std::vector<std::string>& names);
    void add_missing(const std::string& label);

    const EntryContext& test_;
};

}  // namespace beamcam::scenes
