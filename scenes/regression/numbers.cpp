#include "scenes/regression/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "output/data/table_difference.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kTimeScale = 1e-3;   // [s], a typical duration of a contact: unit of the tolerance of times
constexpr double kLeastShare = 0.01;  // of the largest value beside a number: least reference of its difference
constexpr std::size_t kMostLines = 4;

// Members about the work of the solver or its errors; the instants of extrema jump between equal ones.
constexpr std::string_view kNotOfTheMotion[] = {
    "steps",    "steps_by_method", "rhs_evaluations",     "wall_seconds",     "work",
    "warnings", "energy_residual", "energy_residual_max", "compared_with",    "reproducibility",
    "t_min",    "t_max",           "reproducible_until",  "not_reproducible", "reproducible_again_from"};

bool is_compared(const Member& member) {
    return std::ranges::find(kNotOfTheMotion, std::string_view(member.key)) == std::end(kNotOfTheMotion);
}

// A difference in multiples of the tolerance, and its message.
struct Finding {
    double excess;
    std::string line;
};
using Findings = std::vector<Finding>;

// ---- tables ----------------------------------------------------------------------------------------

void compare_tables(const output::ColumnTable& a, const output::ColumnTable& b, double tolerance, double horizon,
                    Findings& findings) {
    if (const output::TableDifference whole = output::difference(a, b); !whole.same_shape())
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

// ---- JSON ------------------------------------------------------------------------------------------

class JsonComparison {
  public:
    JsonComparison(double tolerance, Findings& findings)
        : tolerance_(std::max(tolerance, 1e-300)), findings_(findings) {}

    // `scale`: the largest value beside the number; of an instant the unit of its tolerance.
    void compare(const Node& a, const Node& b, const std::string& path, double scale) {
        if (a.kind != b.kind) return add(INFINITY, path, fmt::format("{} became {}", shown(a), shown(b)));
        switch (a.kind) {
            case Node::Kind::object:
                return compare_members(a, b, path);
            case Node::Kind::array:
                return compare_items(a, b, path);
            case Node::Kind::number:
                return compare_numbers(a.number, b.number, path, scale);
            case Node::Kind::string:
            case Node::Kind::boolean:
            case Node::Kind::null:
                if (one_line(a) != one_line(b)) add(INFINITY, path, fmt::format("{} became {}", shown(a), shown(b)));
        }
    }

  private:
    static std::string shown(const Node& node) {
        return node.kind == Node::Kind::object || node.kind == Node::Kind::array ? name(node.kind) : one_line(node);
    }
    static std::string inner(const std::string& path, const std::string& key) {
        return path.empty() ? key : path + "." + key;
    }
    void add(double excess, const std::string& path, const std::string& text) {
        findings_.push_back({excess, fmt::format("{}: {}", path, text)});
    }

    // The two ends of a range have one scale; other members have different units.
    void compare_members(const Node& a, const Node& b, const std::string& path) {
        const Member *low = a.find("min"), *high = a.find("max");
        const double largest = low && high ? std::max(std::fabs(low->value.number), std::fabs(high->value.number)) : 0;
        compare_members(a, b, path, [largest](const std::string&) { return largest; });
    }
    void compare_members(const Node& a, const Node& b, const std::string& path,
                         const std::function<double(const std::string& key)>& scale) {
        for (const Member& member : a.members) {
            if (!is_compared(member)) continue;
            if (const Member* other = b.find(member.key))
                compare(member.value, other->value, inner(path, member.key), scale(member.key));
            else
                add(INFINITY, inner(path, member.key), "disappeared");
        }
        for (const Member& member : b.members)
            if (is_compared(member) && !a.find(member.key)) add(INFINITY, inner(path, member.key), "appeared");
    }

    // Numbers of one key in a list of objects, such as impacts, have one scale.
    void compare_items(const Node& a, const Node& b, const std::string& path) {
        if (a.items.size() != b.items.size())
            add(INFINITY, path, fmt::format("{} became {}", counted(a.items.size(), "item"), b.items.size()));
        double largest = 0;
        std::map<std::string, double> by_key;
        for (const Node& item : a.items) {
            largest = std::max(largest, std::fabs(item.number));
            for (const Member& member : item.members)
                by_key[member.key] = std::max(by_key[member.key], std::fabs(member.value.number));
        }
        for (std::size_t i = 0; i < std::min(a.items.size(), b.items.size()); ++i) {
            const Node &x = a.items[i], &y = b.items[i];
            if (x.kind == Node::Kind::object && y.kind == Node::Kind::object)
                compare_members(x, y, fmt::format("{}.{}", path, i),
                                [&by_key](const std::string& key) { return by_key[key]; });
            else
                compare(x, y, fmt::format("{}.{}", path, i), largest);
        }
    }

    void compare_numbers(double a, double b, const std::string& path, double largest) {
        if (a == b) return;
        if (path.ends_with(".t_start") || path.ends_with(".t_end"))
            return add(std::fabs(b - a) / kTimeScale / tolerance_, path,
                       fmt::format("{:.9g} s became {:.9g} s ({:+.2g} s)", a, b, b - a));
        const double scale = std::max(std::fabs(a), kLeastShare * largest);
        const double share = scale > 0 ? std::fabs(b - a) / scale : INFINITY;
        add(share / tolerance_, path, fmt::format("{:.9g} became {:.9g} ({:+.2g} %)", a, b, 100 * (b - a) / scale));
    }

    const double tolerance_;
    Findings& findings_;
};

// ---- the end of the reproducible time --------------------------------------------------------------

double time_of(const Node& event, const char* key) {
    const Member* time = event.find(key);
    return time && time->value.kind == Node::Kind::number ? time->value.number : INFINITY;
}

// The values of an impact that are known only when it ends.
constexpr const char* kOfTheEnd[] = {"t_end", "v_n_after", "v_t_after", "duration", "restitution"};

// Removes the impacts that begin after the horizon, the collisions that end after it, and of impacts the values after
// it. An impact at the horizon may be just before it in one run and just after it in the other.
void cut(Node& a, Node& b, double horizon) {
    for (const auto& [list, time] : {std::pair{"impacts", "t_start"}, std::pair{"collisions", "t_end"}}) {
        Member *before = a.find(list), *after = b.find(list);
        if (!before || !after) continue;
        std::vector<Node>&x = before->value.items, &y = after->value.items;
        for (std::vector<Node>* all : {&x, &y})
            std::erase_if(*all, [&, time = time](const Node& event) { return time_of(event, time) > horizon; });
        for (std::vector<Node>* longer : {&x, &y})
            while (longer->size() > std::min(x.size(), y.size()) &&
                   std::fabs(time_of(longer->back(), time) - horizon) <= kTimeScale)
                longer->pop_back();
        for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
            if (time_of(x[i], "t_end") <= horizon) continue;
            for (const char* late : kOfTheEnd) remove(x[i], late), remove(y[i], late);
        }
    }
}

Findings findings_of(const Numbers& expected, const Numbers& actual, const Tolerance& tolerance, double horizon) {
    Findings all;
    compare_tables(expected.table, actual.table, *tolerance.motion, horizon, all);
    Node a = expected.json, b = actual.json;
    cut(a, b, horizon);
    JsonComparison(*tolerance.impacts, all).compare(a, b, "", 0);
    std::ranges::stable_sort(all, std::greater(), &Finding::excess);
    return all;
}

}  // namespace

MotionVerdict compare(const Numbers& expected, const Numbers& actual, const Tolerance& tolerance) {
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
