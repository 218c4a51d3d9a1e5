#include "render/plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/base/error.hpp"
#include "render/draw/markup.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

constexpr double kMargin = 0.04;          // beyond the data, of the range
constexpr double kRoundingRange = 1e-12;  // a range smaller than this part of its numbers is rounding, not data
constexpr double kLargestPower = 4, kSmallestPower = -2;  // powers of ten within which numbers need no common factor
constexpr double kOffsetFrom = 2e-4;  // a range smaller than this part of its numbers gets a common offset

int whole_log10(double value) { return static_cast<int>(std::floor(std::log10(value))); }

// The power of ten that is written beside the numbers.
int usual_shift(double order) {
    const bool ordinary = order < kLargestPower && order >= kSmallestPower;
    return ordinary ? 0 : 3 * static_cast<int>(std::floor(order / 3));
}

struct PrefixedUnit {
    int power = 0;  // of ten, by its prefix
    std::string base;
};
std::optional<PrefixedUnit> prefixed_unit(const std::string& unit) {
    constexpr std::pair<const char*, int> kPrefixes[] = {{"", 0}, {"k", 3}, {"M", 6}, {"m", -3}, {"µ", -6}, {"n", -9}};
    for (const char* base : {"m", "N", "J", "s", "Hz", "Pa", "W", "m/s", "m/s²"})
        for (const auto& [prefix, power] : kPrefixes)
            if (unit == std::string(prefix) + base) return PrefixedUnit{power, base};
    return std::nullopt;
}

// Widens the range to multiples of the step and returns the ticks.
Ticks with_round_ends(Range& range, double step) {
    const double first = std::floor(range.low / step + 1e-9), last = std::ceil(range.high / step - 1e-9);
    range = {first * step, last * step};
    return multiples(step, range.low, range.high);
}

// Steps for angles of more than a quarter turn [°], and the minor intervals in them.
constexpr std::pair<double, int> kTurns[] = {{45, 3}, {90, 3}, {180, 4}, {360, 4}};

// Minor intervals in a step of 1, 2 or 5, or of a part of a turn.
int minor_parts(double step) {
    for (const auto& [turn, parts] : kTurns)
        if (step == turn) return parts;
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    return std::lround(mantissa) == 2 ? 4 : 5;
}

// Angles in degrees have ticks at parts of a turn where steps of 50 or more would be needed.
Ticks in_turns(const Ticks& marks, const Range& range, int most) {
    if (marks.step < 50) return marks;
    for (const auto& [turn, parts] : kTurns)
        if (Ticks out = multiples(turn, range.low, range.high);
            out.values.size() >= 2 && std::cmp_less_equal(out.values.size(), most))
            return out;
    return marks;
}

}  // namespace

void Extent::add(std::span<const double> values, Scale scale) {
    for (const double v : values) {
        if (!std::isfinite(v) || (scale == Scale::logarithmic && !(v > 0))) continue;
        low = any ? std::min(low, v) : v;
        high = any ? std::max(high, v) : v;
        any = true;
    }
}

AxisMap::AxisMap(const Axis& axis, const Extent& data, int most, const std::string& what)
    : log_(axis.scale == Scale::logarithmic) {
    const auto usable = [&](double v) { return std::isfinite(v) && (!log_ || v > 0); };
    if ((axis.from && !usable(*axis.from)) || (axis.to && !usable(*axis.to)) ||
        (axis.from && axis.to && *axis.from == *axis.to))
        throw PictureError(fmt::format("{}: an axis from {} to {} is not possible", what,
                                       axis.from ? fmt::format("{:g}", *axis.from) : "the data",
                                       axis.to ? fmt::format("{:g}", *axis.to) : "the data"));
    if (!data.any && !(axis.from && axis.to))
        throw PictureError(fmt::format("{}: there is no {} value to show", what, log_ ? "positive" : "finite"));
    double from = axis.from.value_or(data.low), to = axis.to.value_or(data.high);
    if (axis.with_zero && !log_) {
        if (!axis.from) from = std::min(from, 0.0);
        if (!axis.to) to = std::max(to, 0.0);
    }
    // One limit beyond all data reverses the axis rather than leaving it empty.
    reversed_ = axis.from && axis.to && from > to;
    low_ = std::min(from, to);
    high_ = std::max(from, to);
    label_ = axis.label;
    const std::size_t unit = label_.rfind(" / ");
    symbol_ = label_.substr(0, unit);
    if (unit != std::string::npos) base_unit_ = told_unit_ = label_.substr(unit + 3);
    log_ ? logarithmic(axis, most) : linear(axis, most);
    if (!axis.ticked) ticks_.clear();
}

void AxisMap::linear(const Axis& axis, int most) {
    if (axis.unit) {
        unit_ = *axis.unit;
        ends_ = {low_ / unit_, high_ / unit_};
        return add_linear_ticks(axis, most, false);
    }
    // All arithmetic is in numbers of order 1, so that no range overflows or underflows.
    double largest = std::max(std::abs(low_), std::abs(high_));
    const int size = largest > 0 ? std::clamp(whole_log10(largest), -300, 300) : 0;
    double unit = ten_to(size), a = low_ / unit, b = high_ / unit;
    if (b - a <= kRoundingRange * std::max(std::abs(a), std::abs(b)) || !(b > a)) {
        const double half = a == 0 && b == 0 ? 1 : 0.1 * std::max(std::abs(a), std::abs(b));
        a -= half, b += half;
    } else {
        const double air = axis.tight ? 0 : kMargin * (b - a);
        if (!axis.from && !(axis.with_zero && a == 0)) a -= air;
        if (!axis.to && !(axis.with_zero && b == 0)) b += air;
    }
    low_ = std::clamp(a, -1.7e308 / unit, 1.7e308 / unit) * unit;
    high_ = std::clamp(b, -1.7e308 / unit, 1.7e308 / unit) * unit;

    // A common offset for a small range far from zero, a common factor for very large or small numbers.
    double offset = 0;
    if (b - a < kOffsetFrom * std::max(std::abs(a), std::abs(b))) {
        const double step = render::ticks(a, b, most).step;
        offset = std::clamp(std::round(0.5 * (a + b) / (10 * step)) * 10 * step, -1.7e308 / unit, 1.7e308 / unit);
    }
    // By logarithms: the number itself may be beyond the largest that exists.
    const double order = std::log10(std::max(std::abs(a - offset), std::abs(b - offset))) + size;
    const int shift = choose_powers(axis, order, offset != 0);
    unit_ = unit;
    offset_ = offset;
    scale_ = ten_to(size - shift);
    ends_.low = (a - offset) * scale_;
    ends_.high = (b - offset) * scale_;

    if (!(std::isfinite(ends_.low) && std::isfinite(ends_.high) && ends_.high > ends_.low))
        throw PictureError(fmt::format("an axis from {:g} to {:g} cannot be divided", low_, high_));
    // Integers have ticks at integers alone.
    add_linear_ticks(axis, most, axis.counts && shift == 0 && offset == 0 && ends_.high - ends_.low >= 1);

    if (factor_) common_ = "×" + power_of_ten(factor_);
    if (offset_ != 0) {
        const int digits = std::max(0, whole_log10(std::abs(offset)) - whole_log10(step_ / scale_)) + 1;
        offset_text_ = fmt::format("{:.{}g}", std::abs(offset) * unit, std::min(digits, 16));
        common_ += fmt::format("{}{}{}", common_.empty() ? "" : " ", offset_ < 0 ? "−" : "+", offset_text_);
    }
}

// The power of ten that divides numbers of this order: the prefix of the unit, and a factor for the rest.
int AxisMap::choose_powers(const Axis& axis, double order, bool offset) {
    int by_prefix = 0;
    const std::optional<PrefixedUnit> unit = axis.keeps_unit ? std::nullopt : prefixed_unit(base_unit_);
    if (unit && (axis.short_numbers || (usual_shift(order) != 0 && !offset))) {
        const Prefix prefix = prefix_for(std::pow(10.0, order + unit->power));
        by_prefix = static_cast<int>(std::lround(std::log10(prefix.factor))) - unit->power;
        told_unit_ = prefix.symbol + unit->base;
        label_ = symbol_ + " / " + told_unit_;
    }
    if (base_unit_ == power_of_ten(-3) && usual_shift(order) < 0 && !offset) {  // thousandths become millionths
        by_prefix = usual_shift(order);
        told_unit_ = power_of_ten(by_prefix - 3);
        label_ = symbol_ + " / " + told_unit_;
    }
    factor_ = usual_shift(order - by_prefix);
    return by_prefix + factor_;
}

void AxisMap::add_linear_ticks(const Axis& axis, int most, bool whole) {
    Ticks marks = render::ticks(ends_.low, ends_.high, std::max(2, most));
    // A single label defines no scale; where four have room, two are few.
    const std::size_t least = axis.round_ends || axis.unit ? 0 : most < 4 ? 2 : 3;
    for (int more = std::max(3, most + 1); marks.values.size() < least && more < 8; ++more)
        marks = render::ticks(ends_.low, ends_.high, more);
    if (base_unit_ == "°" && factor_ == 0 && offset_ == 0) marks = in_turns(marks, ends_, std::max(2, most));
    if (axis.round_ends) marks = with_round_ends(ends_, marks.step);
    if (whole && marks.step < 1) {
        marks = {.step = 1, .decimals = 0, .values = {}};
        const double lowest = std::ceil(ends_.low);
        for (int k = 0; lowest + k <= ends_.high; ++k) marks.values.push_back(lowest + k);
    }
    step_ = marks.step;
    const double range = ends_.high - ends_.low;
    const auto at = [&](double v) { return reversed_ ? (ends_.high - v) / range : (v - ends_.low) / range; };
    for (const double v : marks.values)
        if (v >= axis.first_number.value_or(v))
            ticks_.push_back({std::clamp(at(v), 0.0, 1.0), axis.numbered ? fixed(v, marks.decimals) : "", true});
    const double minor = whole ? std::max(1.0, std::round(marks.step / 5)) : marks.step / minor_parts(marks.step);
    const double first = std::ceil(ends_.low / minor - 1e-9), last = std::floor(ends_.high / minor + 1e-9);
    for (double k = first; k <= last && last - first < 400; ++k)
        if (std::abs(std::remainder(k * minor, marks.step)) > 0.3 * minor) ticks_.push_back({at(k * minor), "", false});
}

std::string AxisMap::name() const {
    std::string text = symbol_, unit = told_unit_;
    if (offset_ != 0) {
        const std::string value = fmt::format("{} {}", offset_ > 0 ? "−" : "+", offset_text_);
        text = base_unit_.empty() ? fmt::format("{} {}", symbol_, value)
                                  : fmt::format("({} {}\u2009{})", symbol_, value, base_unit_);
    }
    // A unit that is a quotient or a product is put in brackets: dθ/dt / (rad/s).
    const bool composed = unit.find('/') != std::string::npos || (factor_ != 0 && !unit.empty());
    if (factor_ != 0) unit = power_of_ten(factor_) + (unit.empty() ? "" : "\u2009" + unit);
    if (unit.empty()) return text;
    return fmt::format(fmt::runtime(composed ? "{} / ({})" : "{} / {}"), text, unit);
}

void AxisMap::logarithmic(const Axis& axis, int most) {
    double a = std::log10(low_), b = std::log10(high_);
    if (b - a < 1e-9) a -= 0.5, b += 0.5;
    const double air = axis.tight ? 0 : kMargin * (b - a);
    if (!axis.from) a -= air;
    if (!axis.to) b += air;
    ends_.low = a;
    ends_.high = b;
    const auto at = [&](double v) { return reversed_ ? (b - v) / (b - a) : (v - a) / (b - a); };
    const int first = static_cast<int>(std::ceil(a - 1e-9)), last = static_cast<int>(std::floor(b + 1e-9));
    // Three numbers at least, where three have room: within less than two decades 2 and 5 have numbers as well, or 3.
    int stride = std::max(1, (last - first + most) / std::max(1, most));
    if (most > 2) stride = std::min(stride, std::max(1, (last - first + 1) / 3));
    const bool few = last - first < 1 || (last - first < 2 && 3 * (b - a) <= most + 2);
    const bool two = !few && most > 2 && last - first < 2;
    const auto label = [&](int digit, int n) {
        if ((few || two) && std::abs(n) <= 3) return fixed(digit * ten_to(n), std::max(0, -n));
        return digit == 1 ? power_of_ten(n) : fmt::format("{}×{}", digit, power_of_ten(n));
    };
    for (int n = first; n <= last; ++n) {
        const bool labelled = n % stride == 0;
        ticks_.push_back({std::clamp(at(n), 0.0, 1.0), labelled ? label(1, n) : "", labelled});
    }
    // Over many decades minor ticks would be a blur.
    for (int n = first - 1; n <= last && last - first <= most; ++n)
        for (int digit = 2; digit <= 9; ++digit) {
            const double v = n + std::log10(digit);
            if (v < a || v > b) continue;
            const bool labelled = (few && (digit == 2 || digit == 5 || last < first)) || (two && digit == 3);
            ticks_.push_back({at(v), labelled ? label(digit, n) : "", labelled});
        }
}

double AxisMap::place(double value, double length) const {
    if (log_ && !(value > 0)) return std::nan("");
    const double v = log_ ? std::log10(value) : tick_value(value);
    const double along = length * (v - ends_.low) / (ends_.high - ends_.low);
    return reversed_ ? length - along : along;
}

}  // namespace beamcam::render
