// The progress line on standard error: stage, rate and remaining time; and whether the user lets the work go on. One
// stage at a time; several threads may report to it.
#pragma once

#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "output/files/interrupt.hpp"
#include "sim/base/clock.hpp"
#include "sim/base/named.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

enum class ProgressStyle {
    automatic,  // bar on a terminal, plain elsewhere
    bar,        // one line, rewritten in place
    plain,      // a line every few seconds, for logs
    json,       // an object per line, for programs
    none
};
inline constexpr sim::Named<ProgressStyle> kProgressStyles[] = {{ProgressStyle::automatic, "auto"},
                                                                {ProgressStyle::bar, "bar"},
                                                                {ProgressStyle::plain, "plain"},
                                                                {ProgressStyle::json, "json"},
                                                                {ProgressStyle::none, "none"}};
// Replaces `automatic`: a bar on a terminal that can rewrite lines, outside CI; else plain.
ProgressStyle resolve(ProgressStyle style);

inline void stop_if_interrupted() {
    if (output::interrupted()) throw sim::Interrupted();
}
// The progress of a simulation that reports it nowhere.
inline bool until_interrupted(double) { return !output::interrupted(); }

class Progress {
  public:
    // `resolved` is never `automatic`.
    explicit Progress(ProgressStyle resolved, std::FILE* out = stderr) : style_(resolved), out_(out) {}
    ~Progress() { end(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Begins a stage of `total` units ("frames", "s"), or of a number that is not known before, and ends the previous
    // one.
    void begin(std::string stage, std::optional<double> total, std::string unit);
    bool reach(double done);  // sets the completed units; false if the user has interrupted the work
    void end();               // ends the line on a terminal

  private:
    std::string amount(double done) const;                          // "12/50 frames"
    std::optional<double> left(double done, double elapsed) const;  // [s]
    void show(double done, bool last);
    void show_bar(double done, double elapsed, bool last);
    void show_plain(double done, double elapsed);
    void show_json(double done, double elapsed, bool last);

    ProgressStyle style_;
    std::FILE* out_;
    std::mutex mutex_;
    std::string stage_, unit_;
    std::optional<double> total_;
    double done_ = 0;
    bool open_ = false, line_is_open_ = false;
    Clock::time_point started_, shown_;
};

}  // namespace beamcam::scenes
