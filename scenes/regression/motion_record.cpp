// The record of a motion, and its files.
#include <fmt/format.h>

#include "output/data/records.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/regression/records.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kSteps = 200;  // of the record of a picture: a file of 13 kB

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

}  // namespace

sim::TableRequest motion_behind_picture(const sim::Problem& problem, double until) {
    sim::TableRequest table;
    table.channels = {{sim::ChannelKind::t, 0}, {sim::ChannelKind::theta, 0}};
    if (problem.beam.model != sim::ModelKind::rigid) table.channels.push_back({sim::ChannelKind::tip_deflection, 0});
    for (int k = 0; k <= kSteps && (until > 0 || k == 0); ++k) table.times.push_back(until * k / kSteps);
    return table;
}

MotionRecord record_of(const sim::Table& table, const std::vector<sim::Impact>& impacts, double until) {
    MotionRecord record{.impacts = impacts_node(impacts, until)};
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        record.table.columns.push_back({name(table.channels[c]), {}, {}, table.values[c]});
    return record;
}

RecordNames::RecordNames(std::size_t motion)
    : table(motion == 0 ? "motion.csv" : fmt::format("motion-{}.csv", motion)),
      impacts(motion == 0 ? "impacts.json" : fmt::format("impacts-{}.json", motion)) {}

void put_record(ReferenceUpdate& update, const RecordNames& names, const sim::Table& table,
                const std::vector<sim::Impact>& impacts, double until, std::optional<double> reproducible_until) {
    std::string csv;
    output::write_csv([&csv](const std::string& text) { csv += text; }, table);
    update.put(names.table, csv);
    update.put(names.impacts, to_text(object_node({{"reproducible_until", reproducible_until.value_or(until)},
                                                   {"impacts", impacts_node(impacts, until)}})));
}

std::optional<MotionRecord> read_record(const References& references, const RecordNames& names) {
    if (!references.has(names.table) || !references.has(names.impacts)) return std::nullopt;
    MotionRecord record{.table = output::read_table(references.file(names.table))};
    for (const output::TableColumn& column : record.table.columns) record.table.find(column.name);  // numbers only
    const std::filesystem::path file = references.file(names.impacts);
    const Parsed parsed = parse(output::read_file(file));
    const Member* impacts = parsed.is_json ? parsed.root.find("impacts") : nullptr;
    if (!impacts || impacts->value.kind != Node::Kind::array)
        refuse_reference(file, "it has no list of impacts, or it is damaged");
    record.impacts = impacts->value;
    if (const Member* horizon = parsed.root.find("reproducible_until"))
        record.reproducible_until = horizon->value.number;
    return record;
}

}  // namespace beamcam::scenes
