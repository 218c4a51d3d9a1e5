#include "scenes/regression/sweep_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "scenes/regression/sweep_table.hpp"
#include "sim/base/counted.hpp"
#include "sim/sweep/sampling.hpp"

namespace beamcam::scenes {
namespace {

using sim::AttractorClass;

// Significant difference of two means over ten blocks. Student's t exceeds 8 in one of five million pairs; but of 200
// 000 pairs of quantities of chaotic motions with different initial states, one reached 8.4 (intermittent motion).
constexpr double kSureErrors = 10;
constexpr double kSureErrorsOfAll = 8;     // the same of sums over all points
constexpr std::size_t kMostOfOrbit = 500;  // compared samples of a periodic motion: its whole orbit
constexpr std::size_t kMostDifferences = 4;
constexpr double kLeastRange = 0.01;  // of a column, as a share of its natural size: least reference of differences

bool has_period(AttractorClass kind) {
    return kind == AttractorClass::rest || kind == AttractorClass::following || kind == AttractorClass::periodic;
}
// Points on the border between two of these classes may get either.
bool has_statistics(AttractorClass kind) { return !has_period(kind) && kind != AttractorClass::over_the_top; }

// A mean over blocks and its standard error.
struct MeanEstimate {
    double value = 0, error = 0;
};

// The samples of one point in equal blocks of the time: estimates, by batch means, of their number and of the mean of a
// function of each.
class SampleBlocks {
  public:
    static constexpr std::size_t kBlocks = 10;
    static constexpr std::size_t kFewestBlocks = 5;  // with samples; fewer give no estimate of the error

    SampleBlocks(std::span<const double> t, double from, double to) {
        for (const double at : t) {
            const double block = (at - from) / (to - from) * kBlocks;
            block_.push_back(block > 0 ? static_cast<std::size_t>(std::min(block, kBlocks - 1.0)) : 0);
        }
    }
    template <class Function>
    MeanEstimate mean(std::span<const double> samples, Function&& of) const {
        std::array<double, kBlocks> sum{}, count{};
        for (std::size_t i = 0; i < samples.size(); ++i) sum[block_[i]] += of(samples[i]), ++count[block_[i]];
        std::vector<double> means;
        for (std::size_t b = 0; b < kBlocks; ++b)
            if (count[b] > 0) means.push_back(sum[b] / count[b]);
        return estimate(means);
    }
    MeanEstimate number() const {
        std::vector<double> count(kBlocks);
        for (const std::size_t block : block_) ++count[block];
        return estimate(count);
    }

  private:
    static MeanEstimate estimate(const std::vector<double>& blocks) {
        if (blocks.size() < kFewestBlocks) return {0, INFINITY};
        const auto n = static_cast<double>(blocks.size());
        double sum = 0, squares = 0;
        for (const double x : blocks) sum += x;
        for (const double x : blocks) squares += (x - sum / n) * (x - sum / n);
        return {sum / n, std::sqrt(squares / (n * (n - 1)))};
    }

    std::vector<std::size_t> block_;
};

// The natural size of a column of samples in its unit, of motions that turn with the cam or fall like a pendulum: 1 rad
// or turn, the length of the beam, and the faster of both rates. 0 for other columns.
double natural_size(const std::string& column, const sim::Problem& problem) {
    const auto& columns = sim::sample_columns();
    const auto info = std::ranges::find_if(columns, [&](const auto& each) { return column == each.name; });
    if (info == columns.end()) return 0;
    const double length = problem.beam.length, speed = problem.cam ? std::fabs(problem.cam->speed) : 0,
                 rate = std::max(speed, std::sqrt(std::fabs(problem.gravity) / length));
    const std::map<std::string, double> sizes{
        {"1", 1}, {"rad", 1}, {"rad/s", rate}, {"m", length}, {"m/s", rate * length}, {"s", rate > 0 ? 1 / rate : 0}};
    return sizes.at(info->unit);
}

class SweepComparer {
  public:
    SweepComparer(const output::ColumnTable& expected, const output::ColumnTable& actual, const Tolerance& tolerance,
                  const sim::Problem& problem)
        : a_(expected), b_(actual), tolerance_(*tolerance.motion) {
        for (std::size_t c = 0; c < a_.values().size(); ++c)
            ranges_.push_back(std::max(range_of(a_.all(c)), kLeastRange * natural_size(a_.values()[c], problem)));
    }

    MotionVerdict compare() {
        if (const std::string why = another_sweep(); !why.empty())
            return {Verdict::different, {"it is another sweep: " + why}};
        bool identical = true;
        std::size_t not_compared = 0;
        std::vector<std::string> of_class, of_values;
        for (std::size_t k = 0; k < a_.points().size(); ++k) {
            const PointRows& a = a_.points()[k];
            not_compared += is_compared(a) ? 0 : 1;
            identical = identical && (!is_compared(a) || a_.same_rows(a, b_, b_.points()[k]));
            if (const PointChange change = difference(k); !change.text.empty())
                (change.of_class ? of_class : of_values).push_back(fmt::format("{}: {}", a_.place(a), change.text));
        }
        if (identical) return {};
        if (of_values.empty()) of_values = differences_over_points();
        MotionVerdict all{Verdict::equivalent, {"all points agree in their numbers or their statistics"}};
        if (of_class.size() <= (not_compared + 1) / 2 && !of_class.empty())
            all.lines.push_back(fmt::format("{} on borders between classes changed their class", of_class.size()));
        else
            of_values.insert(of_values.end(), of_class.begin(), of_class.end());
        if (of_values.empty()) return all;
        const std::size_t shown = std::min(of_values.size(), kMostDifferences);
        all = {Verdict::different, {of_values.begin(), of_values.begin() + static_cast<std::ptrdiff_t>(shown)}};
        if (of_values.size() > shown) all.lines.push_back(fmt::format("and {} more points", of_values.size() - shown));
        return all;
    }

    std::vector<std::size_t> differing() {
        std::vector<std::size_t> all;
        for (std::size_t k = 0; k < a_.points().size(); ++k)
            if (!difference(k).text.empty()) all.push_back(k);
        return all;
    }

  private:
    static double range_of(SweepColumn values) {
        double least = INFINITY, most = -INFINITY;
        for (const double x : values)
            if (std::isfinite(x)) least = std::min(least, x), most = std::max(most, x);
        if (most > least) return most - least;
        return std::isfinite(most) && most != 0 ? std::fabs(most) : 1;
    }

    std::string another_sweep() const {
        if (a_.values() != b_.values() || a_.points().size() != b_.points().size())
            return fmt::format("{} of {}, expected {} of {}", counted(b_.points().size(), "point"),
                               counted(b_.values().size(), "column"), a_.points().size(), a_.values().size());
        for (std::size_t k = 0; k < a_.points().size(); ++k)
            if (const std::string was = a_.place(a_.points()[k]), is = b_.place(b_.points()[k]); was != is)
                return fmt::format("{} is where {} was", is, was);
        return {};
    }

    bool is_compared(const PointRows& a) const { return a_.kind(a) != AttractorClass::unsettled; }

    // How the point differs; empty text: it does not.
    struct PointChange {
        std::string text;
        bool of_class = false;
    };
    PointChange difference(std::size_t k) {
        const PointRows &a = a_.points()[k], &b = b_.points()[k];
        if (!is_compared(a) || a_.same_rows(a, b_, b)) return {};
        const AttractorClass was = a_.kind(a), is = b_.kind(b);
        if (has_statistics(was) && has_statistics(is)) return {difference_of_statistics(a, b)};
        if (was != is) return {fmt::format("{} became {}", name(was), name(is)), true};
        if (!has_period(was)) return {};
        for (const char* what : {"period", "impacts_per_period"})
            if (!same_number(a_.at(a, what), b_.at(b, what)))
                return {fmt::format("{} {:g} became {:g}", what, a_.at(a, what), b_.at(b, what))};
        return {difference_of_orbits(a, b)};
    }

    std::string difference_of_orbits(const PointRows& a, const PointRows& b) const {
        double worst = 0;
        std::size_t column = 0;
        for (const bool forwards : {true, false}) {
            const auto [distance, at] = forwards ? farthest(a_, a, b_, b) : farthest(b_, b, a_, a);
            if (distance > worst) worst = distance, column = at;
        }
        if (worst <= tolerance_) return {};
        if (std::isinf(worst)) return "samples appeared or vanished";
        return fmt::format("{} moved by {:.2g} of its range", a_.values()[column], worst);
    }

    // The largest distance of one of the last samples of a table from the nearest sample of the other, and its column.
    std::pair<double, std::size_t> farthest(const SweepTable& from, const PointRows& own, const SweepTable& to,
                                            const PointRows& its) const {
        const std::size_t n = own.size(), m = its.size();
        std::pair<double, std::size_t> most{0, 0};
        for (std::size_t i = n - std::min(n, kMostOfOrbit); i < n; ++i) {
            std::pair<double, std::size_t> nearest{INFINITY, 0};
            for (std::size_t k = m - std::min(m, kMostOfOrbit); k < m && nearest.first > most.first; ++k)
                nearest = std::min(nearest, distance(from, own, i, to, its, k));
            most = std::max(most, nearest);
        }
        return most;
    }
    std::pair<double, std::size_t> distance(const SweepTable& from, const PointRows& own, std::size_t i,
                                            const SweepTable& to, const PointRows& its, std::size_t k) const {
        std::pair<double, std::size_t> most{0, 0};
        for (std::size_t c = 0; c < a_.values().size(); ++c) {
            const double x = from.samples(own, c)[i], y = to.samples(its, c)[k];
            double step = same_number(x, y) ? 0 : std::isnan(x) || std::isnan(y) ? INFINITY : std::fabs(x - y);
            if (a_.values()[c] == "cam_phase" && step > 0.5) step = 1 - step;  // fractions of a turn
            most = std::max(most, {step / ranges_[c], c});
        }
        return most;
    }

    std::string difference_of_statistics(const PointRows& a, const PointRows& b) {
        const SweepColumn ta = a_.times(a), tb = b_.times(b);
        if (ta.size() < 2 * SampleBlocks::kBlocks || tb.size() < 2 * SampleBlocks::kBlocks)
            return ta.empty() == tb.empty() ? "" : "samples appeared or vanished";
        const double from = std::min(ta.front(), tb.front()), to = std::max(ta.back(), tb.back());
        const SampleBlocks in_a(ta, from, to), in_b(tb, from, to);
        if (std::string why = compared("number of samples a block", in_a.number(), in_b.number(), 1); !why.empty())
            return why;
        const MeanEstimate before{a_.at(a, "exponent"), a_.at(a, "exponent_error")},
            after{b_.at(b, "exponent"), b_.at(b, "exponent_error")};
        if (std::isnan(before.value) != std::isnan(after.value)) return "the exponent appeared or vanished";
        // The exponent is infinite where lasting contact removed every difference.
        if (std::isfinite(before.value) && std::isfinite(after.value))
            if (std::string why = compared("exponent", before, after, 0); !why.empty()) return why;
        for (std::size_t c = 0; c < a_.values().size(); ++c) {
            const std::string& column = a_.values()[c];
            const SweepColumn x = a_.samples(a, c), y = b_.samples(b, c);
            const auto itself = [](double value) { return value; };
            const MeanEstimate mean = in_a.mean(x, itself);
            if (std::string why = compared("mean of " + column, mean, in_b.mean(y, itself), ranges_[c]); !why.empty())
                return why;
            const auto square = [&](double value) { return (value - mean.value) * (value - mean.value); };
            if (std::string why = compared("variance of " + column, in_a.mean(x, square), in_b.mean(y, square),
                                           ranges_[c] * ranges_[c]);
                !why.empty())
                return why;
        }
        return {};
    }

    std::string compared(const std::string& what, const MeanEstimate& a, const MeanEstimate& b, double range) {
        const double step = b.value - a.value, error = std::hypot(a.error, b.error);
        if (std::isfinite(step) && std::isfinite(error)) {
            Change& all = over_points_[what];
            all.sum += step, all.variance += error * error, all.floor += tolerance_ * range;
        }
        if (same_number(a.value, b.value) || !(std::fabs(step) > kSureErrors * error + tolerance_ * range)) return {};
        return fmt::format("{} {:.4g} became {:.4g}, by {:.3g} of its standard errors", what, a.value, b.value,
                           std::fabs(step) / error);
    }

    // Small changes in the same direction at many points.
    std::vector<std::string> differences_over_points() const {
        std::vector<std::string> lines;
        for (const auto& [what, all] : over_points_)
            if (const double error = std::sqrt(all.variance); std::fabs(all.sum) > kSureErrorsOfAll * error + all.floor)
                lines.push_back(
                    fmt::format("over all points without period the {} changed by {:.3g} of its standard errors", what,
                                all.sum / error));
        return lines;
    }

    const SweepTable a_, b_;
    const double tolerance_;
    std::vector<double> ranges_;
    // Sums over the points for each quantity: its change, the variance of the change, and the tolerance.
    struct Change {
        double sum = 0, variance = 0, floor = 0;
    };
    std::map<std::string, Change> over_points_;
};

}  // namespace

MotionVerdict compare_sweeps(const output::ColumnTable& expected, const output::ColumnTable& actual,
                             const Tolerance& tolerance, const sim::Problem& problem) {
    return SweepComparer(expected, actual, tolerance, problem).compare();
}

std::vector<std::size_t> points_that_differ(const output::ColumnTable& expected, const output::ColumnTable& actual,
                                            const Tolerance& tolerance, const sim::Problem& problem) {
    return SweepComparer(expected, actual, tolerance, problem).differing();
}

}  // namespace beamcam::scenes
