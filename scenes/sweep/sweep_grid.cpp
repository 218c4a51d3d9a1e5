#include "scenes/sweep/sweep_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/files/digest.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/exit_code.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::uint64_t kMostPoints = 100'000'000;
constexpr std::uint64_t kMostChecked = 100'000;  // problems to check before the work

std::vector<double> values_of(const SweptKey& over) {
    if (!over.values.empty()) return over.values;
    std::vector<double> values;
    const int last = *over.count - 1;
    for (int i = 0; i <= last; ++i) {
        const double share = last == 0 ? 0 : static_cast<double>(i) / last;
        const double linear = *over.from + (*over.to - *over.from) * share;
        values.push_back(over.logarithmic ? *over.from * std::pow(*over.to / *over.from, share) : linear);
    }
    values.back() = *over.to;
    return values;
}

// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea & Flood 2014) from point and key, 0 … 1.
double random_share(std::uint64_t point, std::uint64_t key) {
    std::uint64_t z = (point + 1) * 0x9e3779b97f4a7c15 + (key + 1) * 0xd1b54a32d192ed03;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

SweepGrid::SweepGrid(const Scene& scene) : scene_(scene) {
    scene_.outputs.clear();
    scene_.output_places.clear();
    scene_.title.clear();
    scene_.data.clear();
    scene_.end_time = Scene{}.end_time;
    const Sweep& sweep = *scene_.sweep;
    for (const SweptKey& over : sweep.over) {
        axes_.push_back({over.key, si_unit(sim::number_key(scene_.problem, over.key)->dimension), values_of(over)});
        cells_ *= axes_.back().values.size();
    }
    seeds_ = starts_of(sweep.seeds);
    if (points() > kMostPoints)
        throw SceneError(fmt::format("sweep: {} points are too many; a sweep has at most {}", points(), kMostPoints));
    for (std::uint64_t s = 0; s < seeds_.size(); ++s)
        (seeds_[s] == SeedKind::carry_up || seeds_[s] == SeedKind::carry_down ? carried_ : single_).push_back(s);
    random_ = random_keys(sweep, scene_.problem);
    check();
}

void SweepGrid::set(sim::Problem& problem, const std::string& key, double value) const {
    if (!sim::set_number(problem, key, value))
        throw SceneError(
            fmt::format("sweep.over: {} = {:.10g} is outside its range or not a whole number", key, value));
}

// Checks as many problems as a short time allows. A start inside the cam is not an error here, but a failed point.
void SweepGrid::check() const {
    const std::uint64_t stride = std::max<std::uint64_t>(1, cells_ / kMostChecked);
    for (std::uint64_t cell = 0; cell < cells_; cell += stride) {
        const std::uint64_t point = cell * seeds_.size();
        for (const sim::Issue& finding : validate(problem(point))) {
            if (!finding.fatal || finding.path.starts_with("initial")) continue;
            std::string where;
            for (std::size_t a = 0; a < axes_.size(); ++a) {
                const std::uint64_t index = (a == 0 ? cell : cell / axes_[0].values.size()) % axes_[a].values.size();
                where += fmt::format("{}{} = {:.10g}", a > 0 ? ", " : "", axes_[a].name, axes_[a].values[index]);
            }
            throw SceneError(fmt::format("sweep at {}: {}: {}", where, finding.path, finding.message));
        }
    }
}

std::uint64_t SweepGrid::tasks() const {
    return cells_ * single_.size() + cells_ / axes_.front().values.size() * carried_.size();
}

SweepGrid::Task SweepGrid::task(std::uint64_t index) const {
    const std::uint64_t singles = cells_ * single_.size(), width = axes_.front().values.size();
    if (index < singles) return {{index / single_.size() * seeds_.size() + single_[index % single_.size()]}, false};
    index -= singles;
    const std::uint64_t row = index / carried_.size(), seed = carried_[index % carried_.size()];
    Task task{{}, true};
    for (std::uint64_t i = 0; i < width; ++i) task.points.push_back((row * width + i) * seeds_.size() + seed);
    if (seeds_[seed] == SeedKind::carry_down) std::ranges::reverse(task.points);
    return task;
}

sim::Problem SweepGrid::problem(std::uint64_t point) const {
    sim::Problem out = scene_.problem;
    std::uint64_t rest = point / seeds_.size();
    for (const output::SweepAxis& axis : axes_) {
        set(out, axis.name, axis.values[rest % axis.values.size()]);
        rest /= axis.values.size();
    }
    if (seed(point) != SeedKind::random) return out;
    for (std::size_t k = 0; k < random_.size(); ++k)
        set(out, random_[k].key, random_[k].from + (random_[k].to - random_[k].from) * random_share(point, k));
    return out;
}

std::string SweepGrid::digest() const {
    Scene points = scene_;
    points.units = {};  // of diagrams
    return output::sha256("sweep\n" + to_json(points));
}
std::string SweepGrid::identity() const { return output::sha256(program_identity() + "\n" + digest()); }

}  // namespace beamcam::scenes
