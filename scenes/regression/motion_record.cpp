#include "scenes/regression/motion_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <sstream>

#include "output/data/records.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/atomic_file.hpp"
#include "output/json/tree.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kSteps = 200;              // of the record of a picture: a file of 13 kB
constexpr double kTimeScale = 1e-3;      // [s], a typical duration of a contact: unit of the tolerance of times
constexpr double kSmallestShare = 0.01;  // of a quantity's largest value: least reference of relative differences
constexpr std::size_t kMostLines = 4;

// ---- impacts as text and back ----------------------------------------------------------------------

Node impacts_node(const std::vector<sim::Impact>& impacts, double until) {
    sim::Result some;
    for (sim::Impact impact : impacts) {
        if (impact.t_start > until) continue;
        impact.at_touch.reset(), impact.at_release.reset();  // the table contains these states
        if (!impact.t_end || *impact.t_end > until) {        // the same, however long the run was
            impact.t_end = impact.v_n_after = impact.v_t_after = impact.duration = impact.restitution = std::nullopt;
            impact.force_peak = impact.penetration_peak = impact.impulse_n = impact.impulse_t = impact.energy_lost = 0;
        }
        some.impacts.push_back(impact);
    }
    return node_of(output::impacts_json(some)).find("impacts")->value;
}

std::vector<ImpactFields> fields_of(const Node& list) {
    std::vector<ImpactFields> impacts;
    for (const Node& item : list.items) {
        ImpactFields fields;
        for (const Member& member : item.members) {
            const bool number = member.value.kind == Node::Kind::number;
            fields.emplace_back(member.key, number ? std::optional(member.value.number) : std::nullopt);
        }
        impacts.push_back(std::move(fields));
    }
    return impacts;
}

std::optional<double> field(const ImpactFields& impact, std::string_view key) {
    for (const auto& [name, value] : impact)
        if (name == key) return value;
    return std::nullopt;
}

bool is_time(std::string_view key) { return key == "t_start" || key == "t_end"; }

// ---- comparing -------------------------------------------------------------------------------------

class Comparer {
  public:
    Comparer(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance)
        : expected_(expected),
          actual_(actual),
          tolerance_(tolerance),
          horizon_(expected.reproducible_until.value_or(std::numeric_limits<double>::infinity())) {}

    MotionVerdict compare() {
        compare_tables();
        compare_impacts();
        if (identical_) return {};
        if (diagnostics_.empty()) add(0, fmt::format("only after the reproducible horizon of {:.4g} s", horizon_));
        return verdict_of(std::move(diagnostics_));
    }

  private:
    void add(double excess, std::string line) { diagnostics_.push_back({excess, std::move(line)}); }

    void compare_tables() {
        const output::TableDifference whole = output::difference(expected_.table, actual_.table);
        if (whole.identical()) return;
        identical_ = false;
        if (!whole.same_shape())
            add(INFINITY,
                fmt::format("the recorded table has {} and {}, expected {} and {}",
                            counted(actual_.table.rows(), "row"), counted(actual_.table.columns.size(), "column"),
                            expected_.table.rows(), expected_.table.columns.size()));
        for (const output::ColumnDifference& c : output::difference(expected_.table, actual_.table, horizon_).columns) {
            if (c.undefined > 0) add(INFINITY, fmt::format("{}: {} values appeared or vanished", c.name, c.undefined));
            if (c.largest == 0) continue;
            add(c.share / std::max(*tolerance_.motion, 1e-300),
                fmt::format("{} differs by {:.2g} at {:.4g} s ({:.2g} of its range)", c.name, c.largest, c.t, c.share));
        }
    }

    void compare_impacts() {
        const auto &a = expected_.impacts, &b = actual_.impacts;
        if (a != b) identical_ = false;
        for (const ImpactFields& impact : a)
            for (const auto& [key, value] : impact)
                if (value) largest_[key] = std::max(largest_[key], std::abs(*value));
        const std::size_t before = reproducible(a), after = reproducible(b);
        for (std::size_t i = 0; i < std::min(before, after); ++i) compare_impact(i, before, a[i], b[i]);
        if (before == after) return;
        // An impact at the horizon may be just before it in one run and just after it in the other.
        const ImpactFields& odd = before > after ? a[after] : b[before];
        const double t = field(odd, "t_start").value_or(0);
        if (std::abs(t - horizon_) <= kTimeScale) return;
        add(INFINITY, fmt::format("{} impacts became {}: the one at {:.6g} s {}", before, after, t,
                                  before > after ? "is lost" : "is new"));
    }

    std::size_t reproducible(const std::vector<ImpactFields>& impacts) const {
        return static_cast<std::size_t>(std::ranges::count_if(impacts, [&](const ImpactFields& impact) {
            return field(impact, "t_start").value_or(INFINITY) <= horizon_;
        }));
    }

    void compare_impact(std::size_t index, std::size_t count, const ImpactFields& a, const ImpactFields& b) {
        double excess = 0;
        std::string worst;
        for (const auto& [key, expected] : a) {
            const std::optional<double> actual = field(b, key);
            if (expected == actual) continue;
            const bool late = key == "t_end" || key.ends_with("_after") || key == "duration" || key == "restitution";
            if (late && field(a, "t_end").value_or(0) > horizon_) continue;
            if (!expected || !actual) {
                excess = INFINITY;
                worst = fmt::format("{} {}", key, expected ? "disappeared" : "appeared");
                continue;
            }
            const double scale =
                is_time(key) ? kTimeScale : std::max(std::abs(*expected), kSmallestShare * largest_[key]);
            const double share = scale > 0 ? std::abs(*actual - *expected) / scale : INFINITY;
            if (share / std::max(*tolerance_.impacts, 1e-300) <= excess) continue;
            excess = share / std::max(*tolerance_.impacts, 1e-300);
            const double change = *actual - *expected;
            worst = is_time(key) ? fmt::format("{} {:.9g} → {:.9g} s ({:+.2g} s)", key, *expected, *actual, change)
                                 : fmt::format("{} {:.6g} → {:.6g}", key, *expected, *actual);
            if (!is_time(key) && scale > 0) worst += fmt::format(" ({:+.2g} %)", 100 * change / scale);
        }
        if (excess > 0)
            add(excess, fmt::format("impact {} of {} at {:.6g} s: {}", index + 1, count,
                                    field(a, "t_start").value_or(0), worst));
    }

    const MotionRecord &expected_, &actual_;
    const Tolerance& tolerance_;
    double horizon_;
    bool identical_ = true;
    std::vector<Finding> diagnostics_;
    std::map<std::string, double> largest_;  // magnitude of each quantity over the expected impacts
};

}  // namespace

sim::TableRequest motion_behind_picture(const sim::Problem& problem, double until) {
    sim::TableRequest table;
    table.channels = {{sim::ChannelKind::t, 0}, {sim::ChannelKind::theta, 0}};
    if (problem.beam.model != sim::ModelKind::rigid) table.channels.push_back({sim::ChannelKind::tip_deflection, 0});
    for (int k = 0; k <= kSteps && (until > 0 || k == 0); ++k) table.times.push_back(until * k / kSteps);
    return table;
}

MotionRecord record_of(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until) {
    MotionRecord record;
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        record.table.columns.push_back({name(table.channels[c]), {}, {}, table.values[c]});
    record.impacts = fields_of(impacts_node(impacts, until));
    return record;
}

RecordNames::RecordNames(std::size_t motion)
    : table(motion == 0 ? "motion.csv" : fmt::format("motion-{}.csv", motion)),
      impacts(motion == 0 ? "impacts.json" : fmt::format("impacts-{}.json", motion)) {}

void put_record(ReferenceUpdate& update, const RecordNames& names, const sim::Table& table,
                const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until) {
    std::ostringstream csv;
    output::write_csv(csv, table);
    update.put(names.table, csv.str());
    update.put(names.impacts, to_text(object_node({{"reproducible_until", reproducible_until.value_or(until)},
                                                   {"impacts", impacts_node(impacts, until)}})));
}

std::optional<MotionRecord> read_record(const References& references, const RecordNames& names) {
    if (!references.has(names.table) || !references.has(names.impacts)) return std::nullopt;
    MotionRecord record;
    record.table = output::read_table(references.file(names.table));
    for (const output::TableColumn& column : record.table.columns) record.table.find(column.name);  // numbers only
    const Parsed parsed = parse(output::read_file(references.file(names.impacts)));
    const Member *list = parsed.root.find("impacts"), *horizon = parsed.root.find("reproducible_until");
    if (!parsed.is_json || !list || list->value.kind != Node::Kind::array)
        throw output::IoError(
            fmt::format("cannot read {}: it is not a list of impacts, or it is damaged; restore it, or replace it with "
                        "--update",
                        references.file(names.impacts).string()));
    record.impacts = fields_of(list->value);
    if (horizon && horizon->value.kind == Node::Kind::number) record.reproducible_until = horizon->value.number;
    return record;
}

MotionVerdict verdict_of(std::vector<Finding> findings) {
    std::ranges::stable_sort(findings, std::greater(), &Finding::excess);
    const bool differs = !findings.empty() && findings.front().excess > 1;
    MotionVerdict result{differs ? Verdict::different : Verdict::equivalent, {}};
    for (const Finding& finding : findings)
        if (result.lines.size() < kMostLines && (finding.excess > 1 || !differs)) result.lines.push_back(finding.line);
    return result;
}

MotionVerdict compare(const MotionRecord& expected, const MotionRecord& actual, const Tolerance& tolerance) {
    return Comparer(expected, actual, tolerance).compare();
}

}  // namespace beamcam::scenes
