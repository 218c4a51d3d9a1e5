#include "sim/observe/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "sim/observe/constants.hpp"

namespace beamcam::sim {
namespace {

// First number of every record; the second is the record's length, both included.
enum Record : int { kBegin = 1, kInterval, kTouch, kRelease, kResume, kEnd };

// ---- taking down ---------------------------------------------------------------------------------

void put(std::vector<double>& out, const Phase& p) {
    for (double value :
         {double(p.touching), double(p.held), p.approach, double(static_cast<int>(p.friction)), p.gap_offset})
        out.push_back(value);
}

void put(std::vector<double>& out, const RunStatistics& t) {
    const Counters& c = t.counters;
    const Fallbacks& f = t.fallbacks;
    for (long value : {c.steps, c.rejected, c.rhs_evaluations, c.gap_evaluations, c.jacobians, t.floored, t.chatters,
                       f.steps, f.handed_over, f.friction_changes, f.strikes, f.coarse, f.left_behind})
        out.push_back(static_cast<double>(value));
    out.push_back(f.gap);
    out.push_back(static_cast<int>(f.method));
}

void put(std::vector<double>& out, const SegmentSummary& n) {
    const std::optional<double> peak = n.force_peak;
    for (double value : {double(n.turning_points), double(peak.has_value()), peak.value_or(0), n.penetration_peak,
                         n.energy_scale, n.energy_residual_max, n.largest_elastic})
        out.push_back(value);
    out.push_back(static_cast<double>(n.apexes.size()));
    for (const Apex& a : n.apexes) out.push_back(a.t), out.push_back(a.theta);
    out.push_back(static_cast<double>(n.theta_zero.size()));
    for (const ZeroCrossing& z : n.theta_zero) out.push_back(z.t), out.push_back(z.theta_dot);
}

void put(std::vector<double>& out, const ContactState& c) {
    for (double value : {c.x, double(c.at_end), c.normal.x, c.normal.y, c.tangent.x, c.tangent.y, c.gap, c.gap_rate,
                         c.slip, c.force, c.friction, c.factor})
        out.push_back(value);
}

// A record that grows at the end of the buffer; its length is filled in when it is complete.
class Open {
  public:
    Open(std::vector<double>& buffer, Record kind) : buffer_(buffer), start_(buffer.size()) {
        buffer.push_back(static_cast<int>(kind));
        buffer.push_back(0);
    }
    ~Open() { buffer_[start_ + 1] = static_cast<double>(buffer_.size() - start_); }
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;

  private:
    std::vector<double>& buffer_;
    std::size_t start_;
};

// ---- reading -------------------------------------------------------------------------------------

// The numbers of one record, in the order they were put.
class Numbers {
  public:
    explicit Numbers(std::span<const double> all) : left_(all) {}
    double next() { return take(1).front(); }
    bool flag() { return next() != 0; }
    long whole() {
        const double value = next();
        if (!(std::fabs(value) < 9e15)) throw std::invalid_argument("a number of the trajectory is damaged");
        return static_cast<long>(value);
    }
    std::span<const double> take(std::size_t count) {
        if (count > left_.size()) throw std::invalid_argument("a record of the trajectory is too short");
        const std::span<const double> taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }
    std::span<const double> rest() { return take(left_.size()); }

  private:
    std::span<const double> left_;
};

Phase phase_of(Numbers& n) {
    Phase p;
    p.touching = n.flag();
    p.held = n.flag();
    p.approach = n.next();
    p.friction = static_cast<FrictionState>(n.whole());
    p.gap_offset = n.next();
    return p;
}

RunStatistics statistics_of(Numbers& n) {
    RunStatistics t;
    Counters& c = t.counters;
    Fallbacks& f = t.fallbacks;
    for (long* value :
         {&c.steps, &c.rejected, &c.rhs_evaluations, &c.gap_evaluations, &c.jacobians, &t.floored, &t.chatters,
          &f.steps, &f.handed_over, &f.friction_changes, &f.strikes, &f.coarse, &f.left_behind})
        *value = n.whole();
    f.gap = n.next();
    f.method = static_cast<Method>(n.whole());
    return t;
}

SegmentSummary summary_of(Numbers& n) {
    SegmentSummary summary;
    summary.turning_points = n.flag();
    const bool has_peak = n.flag();
    const double peak = n.next();
    if (has_peak) summary.force_peak = peak;
    for (double* value :
         {&summary.penetration_peak, &summary.energy_scale, &summary.energy_residual_max, &summary.largest_elastic})
        *value = n.next();
    for (long count = n.whole(); count > 0; --count) {
        const double t = n.next();
        summary.apexes.push_back({t, n.next()});
    }
    for (long count = n.whole(); count > 0; --count) {
        const double t = n.next();
        summary.theta_zero.push_back({t, n.next()});
    }
    return summary;
}

ContactState contact_of(Numbers& n) {
    ContactState c;
    c.x = n.next();
    c.at_end = n.flag();
    for (double* value : {&c.normal.x, &c.normal.y, &c.tangent.x, &c.tangent.y, &c.gap, &c.gap_rate, &c.slip, &c.force,
                          &c.friction, &c.factor})
        *value = n.next();
    return c;
}

struct StoredRecord {
    Record kind;
    Numbers numbers;
};

// Record after record, of which a window is held.
class Feed {
  public:
    explicit Feed(const NumberSource& source, std::uint64_t from = 0) : source_(source), read_(from) {}
    bool over() const { return left() == 0; }

    // The numbers of a record last until the next.
    StoredRecord next() {
        if (left() < 2) throw std::invalid_argument("the trajectory ends within a record");
        const std::span<const double> head = first(2);
        const double kind = head[0], length = head[1];
        if (!(kind >= static_cast<int>(kBegin) && kind <= static_cast<int>(kEnd)) ||
            !(length >= 2 && length <= static_cast<double>(left())))
            throw std::invalid_argument("a record of the trajectory is damaged");
        const auto count = static_cast<std::size_t>(length);
        const StoredRecord piece{static_cast<Record>(static_cast<int>(kind)), Numbers(first(count).subspan(2))};
        used_ += count;
        return piece;
    }

  private:
    std::uint64_t left() const { return source_.size() - read_ + (window_.size() - used_); }
    std::span<const double> first(std::size_t count) {
        if (window_.size() - used_ < count) {
            window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(used_));
            used_ = 0;
            const std::size_t known = window_.size();
            const std::uint64_t more =
                std::min<std::uint64_t>(std::max(kReadAtOnce, count) - known, source_.size() - read_);
            window_.resize(known + static_cast<std::size_t>(more));
            source_.read(read_, std::span(window_).subspan(known));
            read_ += more;
        }
        return std::span(window_).subspan(used_, count);
    }

    const NumberSource& source_;
    std::uint64_t read_;          // of the source
    std::vector<double> window_;  // its last numbers
    std::size_t used_ = 0;        // of the window
};

class Held final : public NumberSource {
  public:
    explicit Held(std::span<const double> numbers) : numbers_(numbers) {}
    std::uint64_t size() const override { return numbers_.size(); }
    void read(std::uint64_t from, std::span<double> into) const override {
        std::ranges::copy(numbers_.subspan(static_cast<std::size_t>(from), into.size()), into.begin());
    }

  private:
    std::span<const double> numbers_;
};

}  // namespace

// ---- writer --------------------------------------------------------------------------------------

void TrajectoryWriter::flush() {
    if (!buffer_.empty()) sink_(buffer_);
    buffer_.clear();
}

void TrajectoryWriter::begin(const Phase& phase, const std::vector<double>& y) {
    const Open record(buffer_, kBegin);
    put(buffer_, phase);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::record(const Segment& segment, double from, double to, bool event,
                              const RunStatistics& statistics, const SegmentSummary* summary) {
    if (broken_) return;
    ++steps_;
    {
        const Open record(buffer_, kInterval);
        for (double value : {from, to, double(event), segment.t0, segment.t1, double(summary != nullptr)})
            buffer_.push_back(value);
        put(buffer_, statistics);
        if (summary) put(buffer_, *summary);
        const std::size_t kind = buffer_.size();
        buffer_.push_back(0);
        buffer_[kind] = static_cast<double>(segment.numbers(buffer_));
        broken_ = buffer_[kind] == static_cast<double>(SegmentKind::none);
    }
    if (broken_)
        buffer_.clear();
    else if (buffer_.size() > kWrittenAtOnce)
        flush();
}

void TrajectoryWriter::put_event(int kind, double t, const std::vector<double>& y, const ContactState& contact) {
    if (broken_) return;
    const Open record(buffer_, static_cast<Record>(kind));
    buffer_.push_back(t);
    put(buffer_, contact);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::touch(double t, const std::vector<double>& y, const ContactState& contact) {
    put_event(kTouch, t, y, contact);
}
void TrajectoryWriter::release(double t, const std::vector<double>& y, const ContactState& contact) {
    put_event(kRelease, t, y, contact);
}

void TrajectoryWriter::resume(double t, const std::vector<double>& y, const Phase& phase,
                              const RunStatistics& statistics) {
    if (broken_) return;
    const Open record(buffer_, kResume);
    buffer_.push_back(t);
    put(buffer_, phase);
    put(buffer_, statistics);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::end(double t) {
    if (broken_) return;
    {
        const Open record(buffer_, kEnd);
        buffer_.push_back(t);
    }
    flush();
    ended_ = true;
    reached_ = t;
}

// ---- reader --------------------------------------------------------------------------------------

Trajectory::Trajectory(const Problem& problem, std::span<const double> numbers)
    : Trajectory(problem, std::make_shared<Held>(numbers)) {}

Trajectory::Trajectory(const Problem& problem, std::shared_ptr<const NumberSource> numbers)
    : numbers_(std::move(numbers)) {
    constexpr std::size_t kLast = 3;  // the numbers of the record that ends it
    const std::size_t size = static_cast<std::size_t>(System(problem).size);
    constexpr std::size_t kPhase = 5;
    Feed head(*numbers_);
    StoredRecord begin = head.next();
    const std::size_t begins = kPhase + size;
    if (begin.kind != kBegin || begin.numbers.rest().size() != begins)
        throw std::invalid_argument("this is no trajectory of this problem");
    if (numbers_->size() < 2 + begins + kLast) throw std::invalid_argument("the trajectory has no end");
    Feed tail(*numbers_, numbers_->size() - kLast);
    StoredRecord end = tail.next();
    if (end.kind != kEnd) throw std::invalid_argument("the trajectory has no end");
    end_ = end.numbers.next();
}

void Trajectory::play(const Problem& problem, RecorderSet& recorders) const {
    std::map<SegmentKind, std::unique_ptr<StoredSegment>> segments;
    const auto segment_of = [&](SegmentKind kind) -> StoredSegment& {
        std::unique_ptr<StoredSegment>& made = segments[kind];
        if (!made) made = make_stored_segment(kind, problem);
        return *made;
    };
    RunStatistics statistics;
    const RecorderSet::StatisticsSource so_far = [&] { return statistics; };
    std::vector<double> y;
    Feed feed(*numbers_);
    for (bool over = false; !over && !feed.over();) {
        auto [kind, n] = feed.next();
        switch (kind) {
            case kBegin: {
                const Phase phase = phase_of(n);
                const std::span<const double> state = n.rest();
                y.assign(state.begin(), state.end());
                recorders.begin(phase, y);
                break;
            }
            case kInterval: {
                const double from = n.next(), to = n.next();
                const bool event = n.flag();
                const double t0 = n.next(), t1 = n.next();
                const bool has_summary = n.flag();
                statistics = statistics_of(n);
                const SegmentSummary summary = has_summary ? summary_of(n) : SegmentSummary{};
                StoredSegment& segment = segment_of(static_cast<SegmentKind>(n.whole()));
                segment.load(t0, t1, n.rest());
                recorders.record(segment, from, to, event, so_far, has_summary ? &summary : nullptr);
                // What follows at the same instant still belongs to a request that ends here.
                over = recorders.end() < to || (recorders.end() == to && !event);
                break;
            }
            case kTouch:
            case kRelease: {
                const double t = n.next();
                const ContactState contact = contact_of(n);
                const double* state = n.rest().data();
                kind == kTouch ? recorders.touch(t, state, contact) : recorders.release(t, state, contact);
                break;
            }
            case kResume: {
                const double t = n.next();
                const Phase phase = phase_of(n);
                statistics = statistics_of(n);
                const std::span<const double> state = n.rest();
                y.assign(state.begin(), state.end());
                recorders.resume(t, y, phase, so_far);
                over = recorders.end() <= t || recorders.done();
                break;
            }
            case kEnd:
                over = true;
                break;
        }
    }
    if (!recorders.done()) throw std::invalid_argument("the trajectory ends before the request");
}

std::unique_ptr<StoredSegment> make_stored_segment(SegmentKind kind, const Problem& problem) {
    const int size = System(problem).size;
    switch (kind) {
        case SegmentKind::none:
            break;
        case SegmentKind::rk8:
            return make_stored_rk8(size);
        case SegmentKind::taylor:
            return make_stored_taylor(size);
        case SegmentKind::exponential:
            return make_stored_exponential(problem);
    }
    throw std::invalid_argument("the trajectory has a segment of unknown kind");
}

}  // namespace beamcam::sim
