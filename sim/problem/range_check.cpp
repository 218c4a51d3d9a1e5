// Checks each number of a problem against the range of its key.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/problem/keys.hpp"

namespace beamcam::sim {
namespace {

class RangeCheck final : public NumberVisitor {
  public:
    explicit RangeCheck(std::vector<Issue>& out) : out_(out) {}

    void number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range, const char*,
                const char*) override {
        if (value) in_range(key, *value, unit, range);
    }
    void numbers(const Key& key, std::vector<double>& values, const Unit& unit, const Range& range, const Length&,
                 const char*) override {
        (void)std::ranges::all_of(values, [&](double x) { return in_range(key, x, unit, range); });
    }
    void integer(const Key& key, std::optional<int>& value, int min, int max, const char*) override {
        if (value && (*value < min || *value > max))
            out_.push_back({path(key), fmt::format("must be {} to {}, is {}", min, max, *value)});
    }

  private:
    bool in_range(const Key& key, double value, const Unit& unit, const Range& range) {
        const bool finite = std::isfinite(value);
        const bool bounded = std::isfinite(range.max);
        if (finite && range.contains(value) && (bounded || std::fabs(value) <= kLargestNumber)) return true;
        out_.push_back({path(key), problem(value, unit, range, bounded, finite) + range.remedy});
        return false;
    }
    static std::string problem(double value, const Unit& unit, const Range& range, bool bounded, bool finite) {
        if (bounded) return fmt::format("must lie between {:g} and {:g}, is {:g}", range.min, range.max, value);
        if (finite && range.contains(value))
            return fmt::format("must lie within ±{:g}, is {:g}: products of larger numbers overflow", kLargestNumber,
                               value);
        if (!std::isfinite(range.min)) return fmt::format("must be a finite number, is {:g}", value);
        if (!range.exclusive_min) return fmt::format("must not be negative, is {:g}", value);
        return fmt::format("must be a positive number of {}, is {:g}", unit_name(unit), value);
    }
    static std::string unit_name(const Unit& unit) {
        const std::string symbol = unit.symbol();
        return symbol == "m" ? "metres" : symbol == "s" ? "seconds" : symbol;
    }

    std::vector<Issue>& out_;
};

}  // namespace

void check_ranges(const Problem& problem, std::vector<Issue>& out) {
    Problem visited = problem;  // visitors take references that may be written to; this one only reads
    RangeCheck ranges(out);
    visit(ranges, visited);
}

}  // namespace beamcam::sim
