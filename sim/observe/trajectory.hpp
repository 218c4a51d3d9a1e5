// A trajectory stored as plain numbers: every accepted segment with its phase, every event, and the summaries that do
// not depend on a request. Any request that ends where it ends, or before, is answered from it with the bits of the
// direct run.
//
// The numbers are doubles in memory order, for this machine and this version of the program; the owner of the storage
// must ensure that nothing else reads them and that damage is detected.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

class RecorderSet;
enum class RecordKind : int;
struct RunStatistics;
struct SegmentSummary;

class TrajectoryWriter {
  public:
    // Takes the numbers in pieces, in order.
    using Sink = std::function<void(std::span<const double>)>;
    explicit TrajectoryWriter(Sink sink) : sink_(std::move(sink)) {}

    void begin(const Phase& phase, const std::vector<double>& y);
    void record(const Segment& segment, double from, double to, bool event, const RunStatistics& statistics,
                const SegmentSummary* summary);
    void touch(double t, const std::vector<double>& y, const ContactState& contact);
    void release(double t, const std::vector<double>& y, const ContactState& contact);
    void resume(double t, const std::vector<double>& y, const Phase& phase, const RunStatistics& statistics);
    void end(double t);

    // False once a segment could not be given by numbers: then nothing more is written and the rest is worthless.
    bool complete() const { return ended_ && !broken_; }
    long steps() const { return steps_; }
    double reached() const { return reached_; }  // where it ended [s]

  private:
    void put_event(RecordKind kind, double t, const std::vector<double>& y, const ContactState& contact);
    void flush();

    Sink sink_;
    std::vector<double> buffer_;
    long steps_ = 0;
    double reached_ = 0;
    bool broken_ = false, ended_ = false;
};

// Numbers in their order, in memory or in a file.
class NumberSource {
  public:
    virtual ~NumberSource() = default;
    virtual std::uint64_t size() const = 0;
    virtual void read(std::uint64_t from, std::span<double> into) const = 0;  // all of them, or throws
};

class Trajectory {
  public:
    // Throws std::invalid_argument when the numbers are no complete trajectory of this problem.
    Trajectory(const Problem& problem, std::shared_ptr<const NumberSource> numbers);
    double end() const { return end_; }
    // Replays it until the recorders are done. Throws std::invalid_argument where it ends before. Few of the numbers
    // are in memory at once.
    void play(const Problem& problem, RecorderSet& recorders) const;

  private:
    std::shared_ptr<const NumberSource> numbers_;
    double end_ = 0;
};

}  // namespace beamcam::sim
