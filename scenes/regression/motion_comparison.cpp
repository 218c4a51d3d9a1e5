// The comparison of a motion with its record.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "output/data/table_difference.hpp"
#include "scenes/regression/records.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kTimeScale = 1e-3;   // [s], a typical duration of a contact: unit of the tolerance of times
constexpr double kLeastShare = 0.01;  // of the largest value beside a number: least reference of its difference
constexpr std::size_t kMostLines = 4;

// A difference in multiples of the tolerance, and its message.
struct Finding {
    double excess;
    std::string line;
};
using Findings = std::vector<Finding>;

// ---- tables ----------------------------------------------------------------------------------------

void compare_tables(const output::ColumnTable& a, const output::ColumnTable& b, double tolerance, double horizon,
                    Findings& findings) {
    const output::TableDifference whole = output::difference(a, b);
    if (whole.other_instant)
        findings.push_back({INFINITY, to_text(*whole.other_instant)});
    else if (!whole.same_shape())
        findings.push_back(
            {INFINITY, fmt::format("the table has {} and {}, expected {} and {}", counted(b.rows(), "row"),
                                   counted(b.columns.size(), "column"), a.rows(), a.columns.size())});
    for (const output::ColumnDifference& c : output::difference(a, b, horizon).columns) {
        if (c.undefined > 0 || c.texts > 0)
            findings.push_back({INFINITY, fmt::format("{}: {} values appeared, vanished or are other texts", c.name,
                                                      c.undefined + c.texts)});
        if (c.largest > 0)
            findings.push_back({c.share / std::max(tolerance, 1e-300),
                                fmt::format("{} differs by {:.2g} at {:.4g} s ({:.2g} of its range)", c.name, c.largest,
                                            c.t, c.share)});
    }
}

// ---- impacts ---------------------------------------------------------------------------------------

class ImpactsComparison {
  public:
    // Numbers of one key have one scale: the largest of all expected impacts.
    ImpactsComparison(const std::vector<Node>& expected, double tolerance, Findings& findings)
        : tolerance_(std::max(tolerance, 1e-300)), findings_(findings) {
        for (const Node& impact : expected)
            for (const Member& member : impact.members)
                largest_[member.key] = std::max(largest_[member.key], std::fabs(member.value.number));
    }

    // `where`: "impacts.0".
    void compare(const Node& a, const Node& b, const std::string& where) {
        for (const Member& member : a.members) {
            const Member* other = b.find(member.key);
            const std::string path = where + "." + member.key;
            if (other && member.value.kind == Node::Kind::number && other->value.kind == Node::Kind::number)
                compare_numbers(member.value.number, other->value.number, path, member.key);
            else if (!other || one_line(member.value) != one_line(other->value))
                add(INFINITY, path,
                    fmt::format("{} became {}", one_line(member.value), other ? one_line(other->value) : "nothing"));
        }
        for (const Member& member : b.members)
            if (!a.find(member.key)) add(INFINITY, where + "." + member.key, "appeared");
    }

  private:
    void compare_numbers(double a, double b, const std::string& path, const std::string& key) {
        if (a == b) return;
        if (key == "t_start" || key == "t_end")
            return add(std::fabs(b - a) / kTimeScale / tolerance_, path,
                       fmt::format("{:.9g} s became {:.9g} s ({:+.2g} s)", a, b, b - a));
        const double scale = std::max(std::fabs(a), kLeastShare * largest_[key]);
        const double share = scale > 0 ? std::fabs(b - a) / scale : INFINITY;
        add(share / tolerance_, path, fmt::format("{:.9g} became {:.9g} ({:+.2g} %)", a, b, 100 * (b - a) / scale));
    }
    void add(double excess, const std::string& path, const std::string& text) {
        findings_.push_back({excess, fmt::format("{}: {}", path, text)});
    }

    const double tolerance_;
    Findings& findings_;
    std::map<std::string, double> largest_;
};

void compare_impacts(const std::vector<Node>& a, const std::vector<Node>& b, double tolerance, Findings& findings) {
    if (a.size() != b.size())
        findings.push_back({INFINITY, fmt::format("impacts: {} became {}", counted(a.size(), "impact"), b.size())});
    ImpactsComparison each(a, tolerance, findings);
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        each.compare(a[i], b[i], fmt::format("impacts.{}", i));
}

// ---- the end of the reproducible time --------------------------------------------------------------

double time_of(const Node& impact, const char* key) {
    const Member* time = impact.find(key);
    return time && time->value.kind == Node::Kind::number ? time->value.number : INFINITY;
}

// The values of an impact that are known only when it ends.
constexpr const char* kOfTheEnd[] = {"t_end", "v_n_after", "v_t_after", "duration", "restitution"};

// Removes the impacts that begin after the horizon, and of the others the values after it. An impact at the horizon may
// be just before it in one run and just after it in the other.
void cut(std::vector<Node>& a, std::vector<Node>& b, double horizon) {
    for (std::vector<Node>* all : {&a, &b})
        std::erase_if(*all, [&](const Node& impact) { return time_of(impact, "t_start") > horizon; });
    for (std::vector<Node>* longer : {&a, &b})
        while (longer->size() > std::min(a.size(), b.size()) &&
               std::fabs(time_of(longer->back(), "t_start") - horizon) <= kTimeScale)
            longer->pop_back();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (time_of(a[i], "t_end") <= horizon) continue;
        for (const char* late : kOfTheEnd) remove(a[i], late), remove(b[i], late);
    }
}

Findings findings_of(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance,
                     double horizon) {
    Findings all;
    compare_tables(expected.table, actual.table, *tolerance.motion, horizon, all);
    std::vector<Node> a = expected.impacts.items, b = actual.impacts.items;
    cut(a, b, horizon);
    compare_impacts(a, b, *tolerance.impacts, all);
    std::ranges::stable_sort(all, std::greater(), &Finding::excess);
    return all;
}

}  // namespace

MotionVerdict compare(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance) {
    constexpr double kAlways = std::numeric_limits<double>::infinity();
    if (output::difference(expected.table, actual.table).identical() &&
        findings_of(expected, actual, tolerance, kAlways).empty())
        return {};
    const double horizon = expected.reproducible_until.value_or(kAlways);
    const Findings findings = findings_of(expected, actual, tolerance, horizon);
    if (findings.empty())
        return {Verdict::equivalent, {fmt::format("only after the reproducible horizon of {:.4g} s", horizon)}};
    const bool differs = findings.front().excess > 1;
    MotionVerdict result{differs ? Verdict::different : Verdict::equivalent, {}};
    for (const Finding& finding : findings)
        if (result.lines.size() < kMostLines && (finding.excess > 1 || !differs)) result.lines.push_back(finding.line);
    return result;
}

}  // namespace beamcam::scenes
