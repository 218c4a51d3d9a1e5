#include "scenes/sweep/make_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "output/json/tree.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/version.hpp"
#include "sim/sweep/sweep_point.hpp"

namespace beamcam::scenes {
namespace {

// Some columns belong to one kind of samples.
std::vector<std::size_t> kept_columns(const sim::Sampling& sampling) {
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < sim::kSampleColumns; ++c)
        if (sim::sample_columns()[c].is_of(sampling.kind)) kept.push_back(c);
    return kept;
}

// The end state as numbers; end_of is the inverse.
std::vector<double> numbers_of(const sim::InitialState& s) {
    std::vector<double> out{double(s.phase.touching), double(s.phase.held), s.phase.approach,
                            double(int(s.phase.friction)), s.phase.gap_offset};
    out.insert(out.end(), s.y.begin(), s.y.end());
    return out;
}

output::StoredPoint stored(std::uint64_t index, const sim::SweepPoint& made, const sim::Sampling& sampling) {
    output::StoredPoint out;
    out.point = index;
    out.kind = static_cast<int>(made.attractor.kind);
    out.period = made.attractor.period;
    out.impacts_per_period = made.attractor.impacts_per_period;
    out.exponent = made.attractor.exponent;
    out.exponent_error = made.attractor.exponent_error;
    out.failure = made.motion.failure;
    const std::vector<std::size_t> columns = kept_columns(sampling);
    out.samples.reserve(made.motion.samples.size() * columns.size());
    for (const sim::MotionSample& sample : made.motion.samples)
        for (const std::size_t c : columns) out.samples.push_back(sample[c]);
    // A motion over the top or with an error has no end state.
    if (!made.motion.over_the_top && out.failure.empty()) out.state = numbers_of(made.motion.end);
    return out;
}

class PointMaker {
  public:
    PointMaker(const SweepGrid& grid, output::PointStore& store, Progress& progress)
        : grid_(grid), store_(store), progress_(progress) {}

    void make(const SweepGrid::Task& task) {
        std::optional<sim::InitialState> end;
        for (const std::uint64_t index : task.points) {
            stop_if_interrupted();
            if (store_.has(index)) {
                if (task.carries) end = end_of(store_.read(index));
                continue;
            }
            const output::StoredPoint point = made(index, task.carries ? end : std::nullopt);
            end = end_of(point);
            store_.add(point);
            const std::lock_guard lock(mutex_);
            progress_.reach(static_cast<double>(++done_));
        }
    }

  private:
    output::StoredPoint made(std::uint64_t index, const std::optional<sim::InitialState>& start) {
        const auto go_on = [&](double) { return progress_.reach(0); };  // within a long point the number stays
        try {
            return stored(index,
                          sim::sweep_point(grid_.problem(index), grid_.sampling(), start ? &*start : nullptr, go_on),
                          grid_.sampling());
        } catch (const std::invalid_argument& impossible) {  // a start inside the cam
            sim::SweepPoint none;
            none.motion.failure = impossible.what();
            return stored(index, none, grid_.sampling());
        }
    }

    const SweepGrid& grid_;
    output::PointStore& store_;
    Progress& progress_;
    std::mutex mutex_;  // guards done_
    std::uint64_t done_ = 0;
};

std::vector<std::uint64_t> tasks_of(const SweepGrid& grid, const Shard& shard) {
    std::vector<std::uint64_t> tasks;
    for (std::uint64_t t = shard.number - 1; t < grid.tasks(); t += shard.count) tasks.push_back(t);
    return tasks;
}

}  // namespace

std::optional<sim::InitialState> end_of(const output::StoredPoint& point) {
    constexpr std::size_t kFewest = 7;                 // angle and rate after the phase
    const std::vector<double>& numbers = point.state;  // as numbers_of
    if (numbers.size() < kFewest || std::ranges::any_of(numbers, [](double each) { return !std::isfinite(each); }))
        return std::nullopt;
    constexpr auto kLastFriction = static_cast<int>(sim::FrictionState::slide_minus);
    if (!(numbers[3] >= 0 && numbers[3] <= kLastFriction)) return std::nullopt;
    sim::InitialState s;
    s.phase = {numbers[0] != 0, numbers[1] != 0, numbers[2],
               static_cast<sim::FrictionState>(static_cast<int>(numbers[3])), numbers[4]};
    s.y.assign(numbers.begin() + 5, numbers.end());
    return s;
}

std::vector<bool> points_of(const SweepGrid& grid, const Shard& shard) {
    std::vector<bool> has(grid.points(), shard.whole());
    if (shard.whole()) return has;
    for (const std::uint64_t t : tasks_of(grid, shard))
        for (const std::uint64_t p : grid.task(t).points) has[p] = true;
    return has;
}

void make_points(const SweepGrid& grid, const Shard& shard, int threads, Progress& progress,
                 output::PointStore& store) {
    const std::vector<bool> mine = points_of(grid, shard);
    const std::vector<std::uint64_t> tasks = tasks_of(grid, shard);
    std::uint64_t missing = 0;
    for (std::uint64_t p = 0; p < mine.size(); ++p) missing += mine[p] && !store.has(p) ? 1 : 0;
    if (missing == 0) return;
    progress.begin("sweep", static_cast<double>(missing), "points");
    PointMaker maker(grid, store, progress);
    fan_out(tasks.size(), threads, [&](std::size_t k) { maker.make(grid.task(tasks[k])); });
    progress.end();
}

output::PointHead head_of(const SweepGrid& grid, const Shard& shard) {
    return {grid.identity(), to_text(object_node({{"part", shard.text()},
                                                  {"program", program_identity()},
                                                  {"sweep", grid.digest()},
                                                  {"scene", to_json(grid.scene())}}))};
}

output::PointShape shape_of(const SweepGrid& grid) {
    return {grid.points(), kept_columns(grid.sampling()).size(), static_cast<int>(names(sim::AttractorClass{}).size())};
}

output::SweepData data_of(const SweepGrid& grid, const Shard& shard) {
    output::SweepData data;
    data.axes = grid.axes();
    data.seeds = grid.seeds();
    for (const std::size_t c : kept_columns(grid.sampling())) {
        const sim::SampleColumnInfo& info = sim::sample_columns()[c];
        data.columns.push_back({info.name, info.unit, info.meaning});
    }
    for (const auto& each : names(sim::AttractorClass{})) data.classes.emplace_back(each.name);
    data.attributes = {{"Conventions", "CF-1.8"},
                       {"source", fmt::format("beamcam {}", kVersion)},
                       {"title", "Sweep"},
                       {"beamcam_scene", to_json(grid.scene())},
                       {"beamcam_program", program_identity()}};
    data.head = head_of(grid, shard);
    return data;
}

output::SweepData data_of(const SweepGrid& grid, const output::PointStore& store, const Shard& shard) {
    output::SweepData data = data_of(grid, shard);
    data.has = [mine = points_of(grid, shard)](std::uint64_t k) { return bool(mine[k]); };
    const std::size_t width = data.columns.size();
    data.rows = [&store, width](std::uint64_t k) { return store.numbers(k) / width; };
    data.read = [&store](std::uint64_t k) { return store.read(k); };
    return data;
}

}  // namespace beamcam::scenes
