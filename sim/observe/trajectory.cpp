#include "sim/observe/trajectory.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "sim/observe/constants.hpp"
#include "sim/observe/recorder_set.hpp"
#include "sim/observe/trajectory_records.hpp"

namespace beamcam::sim {
namespace {

// ---- writing -------------------------------------------------------------------------------------

// A record that grows at the end of the buffer; its length is filled in when it is complete.
class OpenRecord {
  public:
    OpenRecord(std::vector<double>& buffer, RecordKind kind) : buffer_(buffer), start_(buffer.size()) {
        buffer.push_back(static_cast<double>(kind));
        buffer.push_back(0);
    }
    ~OpenRecord() { buffer_[start_ + 1] = static_cast<double>(buffer_.size() - start_); }
    OpenRecord(const OpenRecord&) = delete;
    OpenRecord& operator=(const OpenRecord&) = delete;

  private:
    std::vector<double>& buffer_;
    std::size_t start_;
};

// ---- reading -------------------------------------------------------------------------------------

struct StoredRecord {
    RecordKind kind;
    NumberReader numbers;
};

// Record after record, through a window of the numbers.
class RecordReader {
  public:
    explicit RecordReader(const NumberSource& source, std::uint64_t from = 0) : source_(source), read_(from) {}
    bool over() const { return left() == 0; }

    // The numbers of a record are valid until the next call.
    StoredRecord next() {
        if (left() < kRecordHead) throw std::invalid_argument("the trajectory ends within a record");
        const std::span<const double> head = first(kRecordHead);
        const double kind = head[0], length = head[1];
        if (!(kind >= static_cast<int>(RecordKind::begin) && kind <= static_cast<int>(RecordKind::end)) ||
            !(length >= kRecordHead && length <= static_cast<double>(left())))
            throw std::invalid_argument("a record of the trajectory is damaged");
        const auto count = static_cast<std::size_t>(length);
        const NumberReader numbers(first(count).subspan(kRecordHead));
        used_ += count;
        return {static_cast<RecordKind>(static_cast<int>(kind)), numbers};
    }

  private:
    std::uint64_t left() const { return source_.size() - read_ + (window_.size() - used_); }
    std::span<const double> first(std::size_t count) {
        if (window_.size() - used_ < count) {
            window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(used_));
            used_ = 0;
            const std::size_t present = window_.size();
            const std::uint64_t more =
                std::min<std::uint64_t>(std::max(kReadAtOnce, count) - present, source_.size() - read_);
            window_.resize(present + static_cast<std::size_t>(more));
            source_.read(read_, std::span(window_).subspan(present));
            read_ += more;
        }
        return std::span(window_).subspan(used_, count);
    }

    const NumberSource& source_;
    std::uint64_t read_;          // of the source
    std::vector<double> window_;  // its last numbers
    std::size_t used_ = 0;        // of the window
};

// Hands records to the recorders.
class Player {
  public:
    Player(const Problem& problem, RecorderSet& recorders) : system_(problem), recorders_(recorders) {}

    // False after the last record that matters to the recorders.
    bool play(RecordKind kind, NumberReader& in) {
        switch (kind) {
            case RecordKind::begin: {
                const auto phase = read<Phase>(in);
                recorders_.begin(phase, state(in));
                return true;
            }
            case RecordKind::interval:
                return play_interval(in);
            case RecordKind::touch:
            case RecordKind::release: {
                const auto t = in.next<double>();
                const auto contact = read<ContactState>(in);
                const double* y = in.rest().data();
                kind == RecordKind::touch ? recorders_.touch(t, y, contact) : recorders_.release(t, y, contact);
                return true;
            }
            case RecordKind::resume: {
                const auto t = in.next<double>();
                const auto phase = read<Phase>(in);
                statistics_ = read<RunStatistics>(in);
                recorders_.resume(t, state(in), phase, source_);
                return !(recorders_.end() <= t || recorders_.done());
            }
            case RecordKind::end:
                return false;
        }
        return false;
    }

  private:
    bool play_interval(NumberReader& in) {
        const auto from = in.next<double>(), to = in.next<double>();
        const bool event = in.next<bool>();
        const auto t0 = in.next<double>(), t1 = in.next<double>();
        const bool has_summary = in.next<bool>();
        statistics_ = read<RunStatistics>(in);
        const auto summary = has_summary ? read<SegmentSummary>(in) : SegmentSummary{};
        const auto kind = in.next<SegmentKind>();
        std::unique_ptr<StoredSegment>& segment = segments_[kind];
        if (!segment) segment = make_stored_segment(kind, system_);
        segment->load(t0, t1, in.rest());
        recorders_.record(*segment, from, to, event, source_, has_summary ? &summary : nullptr);
        // Events at the same instant still belong to a request that ends here.
        return !(recorders_.end() < to || (recorders_.end() == to && !event));
    }

    const std::vector<double>& state(NumberReader& in) {
        const std::span<const double> numbers = in.rest();
        y_.assign(numbers.begin(), numbers.end());
        return y_;
    }

    const System system_;
    RecorderSet& recorders_;
    std::map<SegmentKind, std::unique_ptr<StoredSegment>> segments_;
    RunStatistics statistics_;
    const RecorderSet::StatisticsSource source_ = [this] { return statistics_; };
    std::vector<double> y_;
};

}  // namespace

// ---- writer --------------------------------------------------------------------------------------

void TrajectoryWriter::flush() {
    if (!buffer_.empty()) sink_(buffer_);
    buffer_.clear();
}

void TrajectoryWriter::begin(const Phase& phase, const std::vector<double>& y) {
    const OpenRecord record(buffer_, RecordKind::begin);
    put(buffer_, phase);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::record(const Segment& segment, double from, double to, bool event,
                              const RunStatistics& statistics, const SegmentSummary* summary) {
    if (broken_) return;
    if (summary && !summary->impact) summary = nullptr;  // only complete ones are kept
    ++steps_;
    {
        const OpenRecord record(buffer_, RecordKind::interval);
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

void TrajectoryWriter::put_event(RecordKind kind, double t, const std::vector<double>& y, const ContactState& contact) {
    if (broken_) return;
    const OpenRecord record(buffer_, kind);
    buffer_.push_back(t);
    put(buffer_, contact);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::touch(double t, const std::vector<double>& y, const ContactState& contact) {
    put_event(RecordKind::touch, t, y, contact);
}
void TrajectoryWriter::release(double t, const std::vector<double>& y, const ContactState& contact) {
    put_event(RecordKind::release, t, y, contact);
}

void TrajectoryWriter::resume(double t, const std::vector<double>& y, const Phase& phase,
                              const RunStatistics& statistics) {
    if (broken_) return;
    const OpenRecord record(buffer_, RecordKind::resume);
    buffer_.push_back(t);
    put(buffer_, phase);
    put(buffer_, statistics);
    buffer_.insert(buffer_.end(), y.begin(), y.end());
}

void TrajectoryWriter::end(double t) {
    if (broken_) return;
    {
        const OpenRecord record(buffer_, RecordKind::end);
        buffer_.push_back(t);
    }
    flush();
    ended_ = true;
    reached_ = t;
}

// ---- reader --------------------------------------------------------------------------------------

Trajectory::Trajectory(const Problem& problem, std::shared_ptr<const NumberSource> numbers)
    : numbers_(std::move(numbers)) {
    constexpr std::size_t kLast = kRecordHead + 1;  // the numbers of the record that ends it
    RecordReader head(*numbers_);
    StoredRecord begin = head.next();
    if (begin.kind != RecordKind::begin) throw std::invalid_argument("this is no trajectory of this problem");
    read<Phase>(begin.numbers);
    if (begin.numbers.rest().size() != static_cast<std::size_t>(System(problem).size))
        throw std::invalid_argument("this is no trajectory of this problem");
    if (numbers_->size() < kLast) throw std::invalid_argument("the trajectory has no end");
    RecordReader tail(*numbers_, numbers_->size() - kLast);
    StoredRecord end = tail.next();
    if (end.kind != RecordKind::end) throw std::invalid_argument("the trajectory has no end");
    end_ = end.numbers.next<double>();
}

void Trajectory::play(const Problem& problem, RecorderSet& recorders) const {
    Player player(problem, recorders);
    RecordReader records(*numbers_);
    long count = 0;
    while (!records.over()) {
        if (++count % kRecordsPerPoll == 0) recorders.poll();
        auto [kind, numbers] = records.next();
        if (!player.play(kind, numbers)) break;
    }
    if (!recorders.done()) throw std::invalid_argument("the trajectory ends before the request");
}

std::unique_ptr<StoredSegment> make_stored_segment(SegmentKind kind, const System& system) {
    switch (kind) {
        case SegmentKind::none:
            break;
        case SegmentKind::rk8:
            return make_stored_rk8(system.size);
        case SegmentKind::taylor:
            return make_stored_taylor(system.size);
        case SegmentKind::exponential:
            return make_stored_exponential(system);
    }
    throw std::invalid_argument("the trajectory has a segment of unknown kind");
}

}  // namespace beamcam::sim
