// The keys of the figure "table", which reads the columns of a file.
#include <filesystem>

#include "output/data/table_reader.hpp"
#include "output/files/digest.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"
#include "sim/problem/number_keys.hpp"
#include "sim/sweep/sampling.hpp"

namespace beamcam::scenes {
namespace {

// The SI unit of a column by its name, that of a channel, a key or a sample of a sweep; empty: it is none of them.
std::string unit_by_name(const std::string& name, const sim::Problem& problem) {
    if (const auto channel = sim::channel_named(name)) return unit(*channel, problem);
    if (const auto key = sim::number_key(problem, name)) return si_unit(key->dimension);
    for (const sim::SampleColumnInfo& sample : sim::sample_columns())
        if (sample.name == name) return sample.unit;
    return {};
}

// In the unit `shown`, which may be empty.
PlottedTable::Column column_of(ObjectReader& r, const output::TableColumn& from, const std::string& key,
                               const std::string& shown) {
    PlottedTable::Column column{.name = from.name, .unit = from.unit, .values = from.values};
    if (column.unit.empty()) column.unit = unit_by_name(from.name, r.context().scene.problem), column.prefixed = true;
    if (shown.empty()) return column;
    const auto factor = column.unit.empty() ? std::optional(1.0) : factor_between(column.unit, shown);
    if (!factor)
        r.reject(key, " = {}: the column {} is in {}; leave the unit out, or draw this column alone", in_quotes(shown),
                 in_quotes(from.name), column.unit);
    for (double& value : column.values) value *= factor.value_or(1);
    column.unit = shown, column.prefixed = false;
    return column;
}

// Fills `columns` and `digest`.
void read_columns_of(ObjectReader& r, PlottedTable& plotted) {
    if (plotted.file.empty() || r.diagnostics().failed(r.object_name())) return;
    const auto path = std::filesystem::path(r.context().source.name).parent_path() / plotted.file;
    for (const auto& [key, text] : {std::pair{"label", &plotted.label}, std::pair{"x_label", &plotted.x_label}})
        check_markup(r, key, *text);
    try {
        const output::ColumnTable table = output::read_columns(path, [&](const std::string& name) {
            return name == plotted.x || std::ranges::find(plotted.y, name) != plotted.y.end();
        });
        const auto add = [&](const char* key, const std::string& name, const std::string& unit_key,
                             const std::string& unit) {
            if (!table.find(name))
                return r.reject(key, ": {} has no column {}{}", path.string(), in_quotes(name),
                                suggestion_or_list(name, table.names()));
            plotted.columns.push_back(column_of(r, *table.column(name), unit_key, unit));
        };
        add("x", plotted.x, "x_unit", plotted.x_unit);
        for (const std::string& name : plotted.y) add("y", name, "unit", plotted.unit);
        for (std::size_t i = 2; i < plotted.columns.size() && !plotted.label.empty(); ++i)
            if (plotted.columns[i].unit != plotted.columns[1].unit)
                r.reject("label", ": the columns of \"y\" have several units and panels; name columns of one unit");
        plotted.digest = output::sha256_of_file(path);
    } catch (const output::IoError& error) {
        r.reject("file", ": {}", error.what());
    }
}

}  // namespace

void visit(SceneVisitor& v, PlottedTable& table) {
    const std::string unit =
        "columns whose unit is known by their heading or name are converted, others are taken to be in it.";
    v.text(sim::required("file", "\"peaks.csv\""), table.file,
           "A .csv or .npz file, of beamcam or of other programs; its path is relative to the scene's folder.");
    v.text(sim::required("x", "\"cam.speed\""), table.x, "The column of the abscissa.");
    v.value(sim::required("y", "[\"force_peak\"]"), texts_format(table.y),
            "The columns that are drawn, with one panel for each unit.");
    v.text("label", table.label, "Label of the ordinate, without the unit; by default the names of the columns.");
    v.text("unit", table.unit, ("Unit of the ordinate, \"kN\": " + unit).c_str());
    v.text("x_label", table.x_label, "Label of the abscissa, without the unit.");
    v.text("x_unit", table.x_unit, ("Unit of the abscissa, \"rpm\": " + unit).c_str());
    v.check([&table](ObjectReader& r) { read_columns_of(r, table); });
}

}  // namespace beamcam::scenes
