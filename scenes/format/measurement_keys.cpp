// The keys of measured data. The columns of their file become channels: in SI units, over the time of the motion.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "output/data/table_reader.hpp"
#include "output/files/digest.hpp"
#include "render/draw/markup.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/file_column.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "sim/beam/drive.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// The channels that can be measured, by name: all but the time and the coordinates of the model.
const std::vector<std::pair<std::string, sim::Channel>>& measurable_channels() {
    static const auto kAll = [] {
        std::vector<std::pair<std::string, sim::Channel>> all;
        for (const sim::Channel& channel : sim::all_channels({}))
            if (channel.kind != sim::ChannelKind::t && !sim::traits(channel.kind).of_mode)
                all.emplace_back(name(channel), channel);
        return all;
    }();
    return kAll;
}

// Fills `times`, `values` and `digest`, and `columns` where the scene names none.
class MeasurementReader {
  public:
    MeasurementReader(ObjectReader& r, Measurement& m) : r_(r), m_(m) {}

    void read() {
        const fs::path path = fs::path(r_.context().source.name).parent_path() / m_.file;
        try {
            table_ = output::read_columns(path, [this](const std::string& name) { return is_wanted(name); });
            m_.digest = output::sha256_of_file(path);
        } catch (const output::IoError& error) {
            return fail("file", error.what());
        }
        if (m_.label.empty()) m_.label = render::escaped(path.stem().string());
        check_markup(r_, "label", m_.label);
        find_columns();
        check_names();
        if (!failed_) read_values();
        if (!failed_) check_values();
        if (!failed_) check_times();
    }

  private:
    void fail(const std::string& key, const std::string& why) {
        failed_ = true;
        r_.reject_value(r_.place(key), key, ": {}", why);
    }

    bool is_wanted(const std::string& name) const {
        if (name == m_.time_column) return true;
        const auto is_column = [&](const auto& column) { return column.second == name; };
        const auto is_channel = [&](const auto& channel) { return channel.first == name; };
        return m_.columns.empty() ? std::ranges::any_of(measurable_channels(), is_channel)
                                  : std::ranges::any_of(m_.columns, is_column);
    }

    void find_columns() {
        if (m_.columns.empty())
            for (const auto& [known, channel] : measurable_channels())
                if (table_.column(known)) m_.columns.emplace_back(channel, known);
        if (m_.columns.empty())
            fail("file", fmt::format("no column is named like a channel; name the columns, for example \"theta\": {}",
                                     in_quotes(table_.columns.empty() ? "angle" : table_.columns.back().name)));
    }

    void check_names() {
        const auto check = [&](const std::string& key, const std::string& column) {
            if (!column.empty() && !table_.column(column))
                fail(key, fmt::format("the file has no column {}{}", in_quotes(column),
                                      suggestion_or_list(column, table_.names())));
        };
        for (const auto& [column, unit] : m_.units) check("units." + column, column);
        for (const auto& [channel, from] : m_.columns)
            if (sim::traits(channel.kind).needs_cam && !r_.context().scene.problem.cam)
                fail(r_.has(name(channel)) ? name(channel) : "file",
                     fmt::format("{} is a channel of the contact, but the scene has no cam", name(channel)));
    }

    void read_values() {
        m_.times = column("t", m_.time_column, "s");
        for (double& t : m_.times) t += m_.offset;
        for (const auto& [channel, from] : m_.columns) {
            std::vector<double> values = column(name(channel), from, si_unit_of(channel));
            if (!failed_ && values.size() != m_.times.size())
                fail("file", fmt::format("the column {} has {} rows, but the time has {}", in_quotes(from),
                                         values.size(), m_.times.size()));
            if (!failed_ && si_unit_of(channel) == "rad") join_turns(channel, from, values);
            m_.values.push_back(std::move(values));
        }
        if (!failed_) leave_out_rows_without_time();
    }

    std::string si_unit_of(const sim::Channel& channel) const { return unit(channel, r_.context().scene.problem); }

    // A column in SI units, from those that the scene or else the file names.
    std::vector<double> column(const std::string& key, const std::string& from, const std::string& si) {
        const auto named = std::ranges::find(m_.units, from, &std::pair<std::string, std::string>::first);
        const std::string unit = named == m_.units.end() ? "" : named->second;
        const FileColumn read = column_in_si(table_, "the file", from, unit, si);
        if (!read.problem.empty())
            fail(read.wrong_unit ? "units" : r_.has(key) ? key : "file", read.problem);
        else if (read.wrong_unit)
            r_.warn("file",
                    ": the file states {} for the column {}, which is not a unit of {}; it is read in {} unless "
                    "\"units\" names another",
                    in_quotes(table_.column(from)->unit), in_quotes(from), key, si.empty() ? "plain numbers" : si);
        else if (key == "theta" && unit.empty() && table_.column(from)->unit.empty())
            warn_of_degrees(from, read.values);
        return read.values;
    }

    void warn_of_degrees(const std::string& from, const std::vector<double>& angles) {
        const auto found = std::ranges::find_if(
            angles, [](double angle) { return std::isfinite(angle) && perhaps_in(sim::dimension::kAngle, angle); });
        if (found != angles.end())
            r_.warn(r_.has("theta") ? "theta" : "file",
                    ": the column {0} is read in rad and contains {1:g}; write \"units\": {{{0}: \"deg\"}} if that is "
                    "meant",
                    in_quotes(from), *found);
    }

    // An angle that begins again after a turn, as that of an absolute encoder, goes on instead.
    void join_turns(const sim::Channel& channel, const std::string& from, std::vector<double>& values) {
        const auto jump = joined_turns(values);
        if (!jump) return;
        r_.warn(r_.has(name(channel)) ? name(channel) : "file",
                ": the column {} jumps by {:.4g} deg in {}; it is read as an angle that begins again after 360 deg",
                in_quotes(from), jump->angle * 360 / kFullTurn, table_.row_name(jump->row));
        start_near_motion(channel, values);
    }

    // An angle within a turn leaves whole turns open: its first row is within half a turn of the motion's.
    void start_near_motion(const sim::Channel& channel, std::vector<double>& values) const {
        const sim::Problem& problem = r_.context().scene.problem;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i]) || !std::isfinite(m_.times[i])) continue;
            std::optional<double> there;
            if (channel.kind == sim::ChannelKind::cam_angle && problem.cam)
                there = problem.cam->phase - problem.cam->speed * m_.times[i];
            if (channel.kind == sim::ChannelKind::theta) there = hub_angle(problem, m_.times[i]);
            if (!there) return;
            const double turns = kFullTurn * std::round((*there - values[i]) / kFullTurn);
            for (double& value : values) value += turns;
            return;
        }
    }
    // A free hub begins at its initial angle.
    static double hub_angle(const sim::Problem& problem, double t) {
        const bool valid = std::ranges::none_of(sim::validate(problem), &sim::Issue::fatal);
        const double start = problem.initial.angle;
        if (!valid) return start;
        const sim::DriveLaw drive(problem.hub.drive, start);
        return drive.prescribed() ? drive.motion(t).angle : start;
    }

    // ---- checks --------------------------------------------------------------------------------

    void leave_out_rows_without_time() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < m_.times.size(); ++i) {
            if (!std::isfinite(m_.times[i])) continue;
            rows_.push_back(i);
            m_.times[kept] = m_.times[i];
            for (std::vector<double>& values : m_.values) values[kept] = values[i];
            ++kept;
        }
        m_.times.resize(kept);
        for (std::vector<double>& values : m_.values) values.resize(kept);
    }

    void check_values() {
        if (m_.times.empty()) return fail("file", "the file has no rows below the names of the columns");
        for (std::size_t i = 0; i < m_.values.size() && !failed_; ++i)
            if (std::ranges::none_of(m_.values[i], [](double value) { return std::isfinite(value); }))
                fail("file", fmt::format("the column {} contains no number", in_quotes(m_.columns[i].second)));
    }

    void check_times() {
        for (std::size_t i = 1; i < m_.times.size(); ++i)
            if (!(m_.times[i] > m_.times[i - 1]))
                return fail("file",
                            fmt::format("{}: the time does not increase; sort the rows, and keep each instant once",
                                        table_.row_name(rows_[i])));
        const double end = r_.context().scene.end_time;
        const auto outside = std::ranges::count_if(m_.times, [end](double t) { return t < 0 || t > end; });
        if (outside == std::ssize(m_.times))
            fail("file",
                 fmt::format("no row lies between 0 and {:g} s; check \"offset\" and the unit of the time", end));
        else if (outside > 0)
            r_.warn("file", ": {} of {} rows lie outside the motion, which is from 0 to {:g} s", outside,
                    m_.times.size(), end);
    }

    ObjectReader& r_;
    Measurement& m_;
    output::ColumnTable table_;
    std::vector<std::size_t> rows_;  // of the file, by row of the measurement
    bool failed_ = false;
};

}  // namespace

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

void SceneVisitor::file_of_columns() {
    columns_.emplace();
    text(sim::written_if(false, "file"), columns_->file,
         "A .csv or .npz file with the columns that other keys name; its path is relative to the scene's folder.");
    value(sim::written_if(false, "units"), column_units_format(columns_->units),
          "Units of columns, by their names: {\"x\": \"mm\"}; by default those that the file states, or SI units.");
}

void visit(SceneVisitor& v, Measurement& m) {
    using Drawn = Measurement::Drawn;
    v.text(sim::required("file", "\"rig.csv\""), m.file,
           "A .csv file with a line of names, or an .npz file with named arrays; its path is relative to the scene's "
           "folder. Other columns than those named here do not matter.");
    v.text("label", m.label, "Its name in pictures; by default the file's name.");
    v.text("t", m.time_column, "Name of the column with the time.");
    v.number("offset", m.offset, sim::dimension::kTime, sim::kAny,
             "Time of the motion at which the time of the file is zero.");
    v.value("units", column_units_format(m.units),
            "Units of columns, by their names: {\"angle\": \"deg\", \"time\": \"ms\"}; by default those that the file "
            "states, or SI units.");
    v.choice("draw", m.drawn, {{Drawn::automatic, "auto"}, {Drawn::points, "points"}, {Drawn::line, "line"}},
             "How the data are drawn; auto: points up to 300 rows, else a line.");
    for (const auto& [known, channel] : measurable_channels()) {
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
