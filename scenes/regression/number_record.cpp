#include "scenes/regression/number_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "output/data/table_difference.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/atomic_file.hpp"
#include "output/json/tree.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastShare = 0.01;  // of the largest value beside a number: least reference of its difference

// These keys tell of the work of the solver or of its errors; the instants of extrema jump between equal ones.
constexpr std::string_view kNotOfTheMotion[] = {
    "steps",    "steps_by_method", "rhs_evaluations",     "wall_seconds",     "work",
    "warnings", "energy_residual", "energy_residual_max", "compared_with",    "reproducibility",
    "t_min",    "t_max",           "reproducible_until",  "not_reproducible", "reproducible_again_from"};

bool is_compared(const Member& member) {
    return std::ranges::find(kNotOfTheMotion, std::string_view(member.key)) == std::end(kNotOfTheMotion);
}

class NodeComparer {
  public:
    explicit NodeComparer(double tolerance) : tolerance_(std::max(tolerance, 1e-300)) {}

    std::vector<Finding> findings;

    // `scale`: the largest value beside the number.
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
    void add(double excess, const std::string& path, const std::string& text) {
        findings.push_back({excess, fmt::format("{}: {}", path, text)});
    }

    // The two ends of a range have one scale; other members have different units.
    void compare_members(const Node& a, const Node& b, const std::string& path) {
        const Member *low = a.find("min"), *high = a.find("max");
        const double largest = low && high ? std::max(std::fabs(low->value.number), std::fabs(high->value.number)) : 0;
        for (const Member& member : a.members) {
            if (!is_compared(member)) continue;
            const std::string inner = path.empty() ? member.key : path + "." + member.key;
            if (const Member* other = b.find(member.key))
                compare(member.value, other->value, inner, largest);
            else
                add(INFINITY, inner, "disappeared");
        }
        for (const Member& member : b.members)
            if (is_compared(member) && !a.find(member.key))
                add(INFINITY, path.empty() ? member.key : path + "." + member.key, "appeared");
    }

    // Numbers of one key in a list of objects, such as impacts, have one scale.
    void compare_items(const Node& a, const Node& b, const std::string& path) {
        if (a.items.size() != b.items.size())
            return add(INFINITY, path, fmt::format("{} became {}", counted(a.items.size(), "item"), b.items.size()));
        double largest = 0;
        std::map<std::string, double> by_key;
        for (const Node& item : a.items) {
            largest = std::max(largest, std::fabs(item.number));
            for (const Member& member : item.members)
                by_key[member.key] = std::max(by_key[member.key], std::fabs(member.value.number));
        }
        for (std::size_t i = 0; i < a.items.size(); ++i) {
            const Node &x = a.items[i], &y = b.items[i];
            const std::string inner = fmt::format("{}.{}", path, i);
            if (x.kind != Node::Kind::object || y.kind != Node::Kind::object) {
                compare(x, y, inner, largest);
                continue;
            }
            for (const Member& member : x.members)
                if (const Member* other = y.find(member.key); other && is_compared(member))
                    compare(member.value, other->value, inner + "." + member.key, by_key[member.key]);
            if (x.members.size() != y.members.size()) add(INFINITY, inner, "has other keys");
        }
    }

    void compare_numbers(double a, double b, const std::string& path, double largest) {
        if (a == b) return;
        const double scale = std::max(std::fabs(a), kLeastShare * largest);
        const double share = scale > 0 ? std::fabs(b - a) / scale : INFINITY;
        add(share / tolerance_, path, fmt::format("{:.9g} became {:.9g} ({:+.2g} %)", a, b, 100 * (b - a) / scale));
    }

    const double tolerance_;
};

// Without the impacts and collisions that begin or end after the horizon.
void cut(Node& root, double horizon) {
    const auto is_late = [horizon](const Node& event) {
        const auto after = [&](const char* key) {
            const Member* time = event.find(key);
            return time && !(time->value.kind == Node::Kind::number && time->value.number <= horizon);
        };
        return after("t_start") || after("t_end");
    };
    for (const char* list : {"impacts", "collisions"})
        if (Member* member = root.find(list)) std::erase_if(member->value.items, is_late);
}

Node read_json(const fs::path& file) {
    Parsed parsed = parse(output::read_file(file));
    if (parsed.is_json) return std::move(parsed.root);
    throw output::IoError(
        fmt::format("cannot read {}: it is no JSON, or it is damaged; restore it, or replace it with "
                    "--update",
                    file.string()));
}

MotionVerdict compare_tables(const fs::path& expected, const fs::path& actual, double tolerance, double horizon) {
    const output::ColumnTable a = output::read_table(expected), b = output::read_table(actual);
    const output::TableDifference whole = output::difference(a, b);
    if (whole.identical()) return {};
    std::vector<Finding> findings;
    if (!whole.same_shape())
        findings.push_back(
            {INFINITY, fmt::format("the table has {} and {}, expected {} and {}", counted(b.rows(), "row"),
                                   counted(b.columns.size(), "column"), a.rows(), a.columns.size())});
    for (const output::ColumnDifference& c : output::difference(a, b, horizon).columns) {
        if (c.undefined > 0 || c.texts > 0)
            findings.push_back({INFINITY, fmt::format("{}: {} values appeared, vanished or are other texts", c.name,
                                                      c.undefined + c.texts)});
        if (c.largest > 0)
            findings.push_back({c.share / std::max(tolerance, 1e-300),
                                fmt::format("{} differs by {:.2g} ({:.2g} of its range)", c.name, c.largest, c.share)});
    }
    return verdict_of(std::move(findings));
}

}  // namespace

MotionVerdict compare_numbers(const fs::path& expected, const fs::path& actual, const Tolerance& tolerance,
                              std::optional<double> horizon) {
    const double until = horizon.value_or(std::numeric_limits<double>::infinity());
    if (expected.extension() == ".csv") return compare_tables(expected, actual, *tolerance.motion, until);
    Node a = read_json(expected), b = read_json(actual);
    if (horizon) cut(a, until), cut(b, until);
    NodeComparer comparer(*tolerance.impacts);
    comparer.compare(a, b, "", 0);
    return comparer.findings.empty() ? MotionVerdict() : verdict_of(std::move(comparer.findings));
}

}  // namespace beamcam::scenes
