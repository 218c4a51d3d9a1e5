// Judges the motion of one entry, those that its picture compares, or its sweep, by the records among its references.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/motions/progress.hpp"
#include "scenes/regression/entry_references.hpp"
#include "scenes/regression/motion_record.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// A table of all channels; it would hold an error of the solver too, which no two solvers share.
bool asks_for_all_channels(const Baseline& entry);

class EntryMotion {
  public:
    // All references must outlive this.
    EntryMotion(const Baseline& entry, const Tolerance& tolerance, const EntryReferences& references,
                const EntryReport& report, EntryResult& result)
        : entry_(entry), tolerance_(tolerance), references_(references), report_(report), result_(result) {}

    // `until`: the last instant that the entry looks at [s].
    void judge(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until,
               std::optional<double> reproducible_until);

    // What is recorded of a motion that the picture compares: as far as it was reproducible when it was accepted.
    sim::TableRequest request_of_compared(std::size_t index, const sim::Problem& problem, double until) const;
    void judge_compared(std::size_t index, const std::string& label, sim::Table table,
                        const std::vector<sim::Impact>& impacts, std::optional<double> reproducible_until);

    // Makes its points. Throws sim::Interrupted, SceneError for one that cannot be made.
    void judge_sweep(int threads, Progress& progress);

  private:
    using Files = std::function<output::Target(const std::string& name)>;

    Files fresh_files() const;
    void report(const std::vector<std::string>& names, const std::function<void(const Files&)>& write);
    void judge_record(const RecordNames& names, const std::string& label, const MotionRecord& actual, double horizon);
    void take(const MotionVerdict& found, const std::string& label, const std::vector<std::string>& names);
    void miss(const std::string& label);

    const Baseline& entry_;
    const Tolerance& tolerance_;
    const EntryReferences& references_;
    const EntryReport& report_;
    EntryResult& result_;
};

}  // namespace beamcam::scenes
