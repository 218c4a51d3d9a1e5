// The keys of measured data, and the reader of its files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "output/data/tables.hpp"
#include "output/files/digest.hpp"
#include "render/draw/markup.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// The channels that can be measured: all but the time and the coordinates of the model.
const std::vector<std::pair<std::string, sim::Channel>>& measurable() {
    static const auto kAll = [] {
        std::vector<std::pair<std::string, sim::Channel>> all;
        for (const sim::Channel& channel : sim::all_channels({}))
            if (channel.kind != sim::ChannelKind::t && channel.kind != sim::ChannelKind::q)
                all.emplace_back(name(channel), channel);
        return all;
    }();
    return kAll;
}

ValueFormat column_units_format(std::vector<std::pair<std::string, std::string>>& units) {
    const auto read = [&units](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::object) return r.expect(node, key, "an object such as {{\"angle\": \"deg\"}}");
        for (const Member& member : node.members)
            if (member.value.kind == Node::Kind::string)
                units.emplace_back(member.key, member.value.text);
            else
                r.fail(member.value, key + "." + member.key,
                       r.path(key + "." + member.key) + " must be a unit in quotes, such as \"deg\"");
    };
    const auto write = [&units] {
        Node out = units.empty() ? Node() : object_node();
        for (const auto& [column, unit] : units) add(out, column, unit);
        return out;
    };
    return {"object of units", R"({"type": "object", "additionalProperties": {"type": "string"}})", read, write};
}

// Reads the file's columns in SI units.
class MeasurementReader {
  public:
    MeasurementReader(ObjectReader& r, Measurement& m) : r_(r), m_(m) {}

    void read() {
        const fs::path path = fs::path(r_.context().source.name).parent_path() / m_.file;
        if (std::error_code error; !fs::is_regular_file(path, error))
            return fail("file", error ? error.message() : "it is not a regular file");
        output::ColumnTable table;
        try {
            table = output::read_table(path);
            m_.digest = output::sha256_of_file(path);
        } catch (const output::IoError& error) {
            return fail("file", error.what());
        }
        if (m_.label.empty()) m_.label = render::escaped(path.stem().string());
        check_markup(r_, "label", m_.label);
        if (m_.columns.empty())
            for (const auto& [known, channel] : measurable())
                if (table.find(known)) m_.columns.emplace_back(channel, known);
        if (m_.columns.empty())
            return fail("file",
                        fmt::format("no column is named like a channel; name the columns, for example \"theta\": {}",
                                    in_quotes(table.columns.front().name)));
        for (const auto& [column, unit] : m_.units)
            if (!table.find(column))
                return fail("units", fmt::format("the file has no column {}{}", in_quotes(column),
                                                 suggestion_or_list(column, table.names())));
        m_.times = column(table, "t", m_.time_column, "s");
        for (double& t : m_.times) t += m_.offset;
        check_channels();
        for (const auto& [channel, from] : m_.columns)
            m_.values.push_back(column(table, name(channel), from, unit(channel, r_.context().scene.problem)));
        check_values();
        check_times();
    }

  private:
    void fail(const std::string& key, const std::string& why) {
        failed_ = true;
        r_.reject_value(r_.place(key), key, ": {}", why);
    }

    std::vector<double> column(const output::ColumnTable& table, const std::string& key, const std::string& from,
                               const std::string& si) {
        const std::vector<double>* found = table.find(from);
        const std::string at = r_.has(key) ? key : "file";
        if (!found) {
            fail(at,
                 fmt::format("the file has no column {}{}", in_quotes(from), suggestion_or_list(from, table.names())));
            return {};
        }
        std::vector<double> out = *found;
        const auto named = std::ranges::find(m_.units, from, &std::pair<std::string, std::string>::first);
        if (named == m_.units.end()) return out;
        const QuantityText given = parse_quantity("1 " + named->second), required = parse_quantity("1 " + si);
        if (!given.quantity || !required.quantity || !same(given.quantity->dimension, required.quantity->dimension)) {
            fail("units", fmt::format("{} is not a unit of {}, which is measured in {}{}", in_quotes(named->second),
                                      key, si, given.quantity ? "" : ": " + given.problem));
            return {};
        }
        for (double& value : out) value *= given.quantity->value;
        return out;
    }

    void check_channels() {
        for (const auto& [channel, from] : m_.columns)
            if (sim::traits(channel.kind).needs_cam && !r_.context().scene.problem.cam)
                fail(r_.has(name(channel)) ? name(channel) : "file",
                     fmt::format("{} is a channel of the contact, but the scene has no cam", name(channel)));
    }

    void check_values() {
        if (m_.times.empty() && !failed_) fail("file", "the file has no rows below the names of the columns");
        for (std::size_t i = 0; i < m_.values.size() && !failed_; ++i)
            if (std::ranges::none_of(m_.values[i], [](double value) { return std::isfinite(value); }))
                fail("file", fmt::format("the column {} contains no number", in_quotes(m_.columns[i].second)));
    }

    void check_times() {
        if (failed_) return;
        for (std::size_t i = 0; i < m_.times.size(); ++i)
            if (!std::isfinite(m_.times[i]) || (i > 0 && !(m_.times[i] > m_.times[i - 1])))
                // In a CSV file the first line has the names.
                return fail(
                    "file",
                    fmt::format("{} {}: the time does not increase; sort the rows, and keep each instant once",
                                m_.file.ends_with(".csv") ? "line" : "row", m_.file.ends_with(".csv") ? i + 2 : i));
        const double end = r_.context().scene.end_time;
        if (m_.times.empty() || m_.times.back() < 0 || m_.times.front() > end)
            fail("file",
                 fmt::format("no row lies between 0 and {:g} s; check \"offset\" and the unit of the time", end));
    }

    ObjectReader& r_;
    Measurement& m_;
    bool failed_ = false;
};

}  // namespace

void visit(SceneVisitor& v, Measurement& m) {
    using Drawn = Measurement::Drawn;
    v.text(sim::required("file", "\"rig.csv\""), m.file,
           "A .csv file with a line of names, or an .npz file with named arrays; its path is relative to the scene's "
           "folder.");
    v.text("label", m.label, "Its name in pictures; by default the file's name.");
    v.text("t", m.time_column, "Name of the column with the time.");
    v.number("offset", m.offset, sim::dimension::kTime, sim::kAny,
             "Time of the motion at which the time of the file is zero.");
    v.value("units", column_units_format(m.units),
            "Units of columns, by their names: {\"angle\": \"deg\", \"time\": \"ms\"}; by default SI units.");
    v.choice("draw", m.drawn, {{Drawn::automatic, "auto"}, {Drawn::points, "points"}, {Drawn::line, "line"}},
             "How the data are drawn; auto: points up to 300 rows, else a line.");
    for (const auto& [known, channel] : measurable()) {
        const auto found = std::ranges::find(m.columns, channel, &std::pair<sim::Channel, std::string>::first);
        std::string column = found == m.columns.end() ? "" : found->second;
        v.text(sim::written_if(!column.empty(), known.c_str()), column, "Name of the column with this channel.");
        if (found != m.columns.end())
            found->second = column;
        else if (!column.empty())
            m.columns.emplace_back(channel, column);
    }
    v.check([&m](ObjectReader& r) {
        if (!r.diagnostics().failed(r.path("file")) && r.has("file")) MeasurementReader(r, m).read();
    });
}

}  // namespace beamcam::scenes
