// The keys of measured data.
#include <algorithm>

#include "scenes/format/measurement_reader.hpp"

namespace beamcam::scenes {

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
        if (!r.diagnostics().failed(r.path("file")) && r.has("file")) read_measurement(r, m);
    });
}

}  // namespace beamcam::scenes
