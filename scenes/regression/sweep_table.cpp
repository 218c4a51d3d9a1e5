#include "scenes/regression/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace beamcam::scenes {

SweepTable::SweepTable(const output::ColumnTable& table) : table_(table), kinds_(column("class")) {
    const std::vector<double>& sample = column("sample");
    for (std::size_t row = 0; row < sample.size(); ++row) {
        if (points_.empty() || !(sample[row] > 0)) points_.push_back({row, row});
        points_.back().end = row + (std::isnan(sample[row]) ? 0 : 1);
        if (!(kinds_[row] >= 0 && kinds_[row] < double(sim::names(sim::AttractorClass()).size())))
            throw output::IoError(fmt::format("the record of the sweep is damaged: there is no class {}", kinds_[row]));
    }
    const std::vector<std::string> names = table.names();
    axes_.assign(names.begin(), std::ranges::find(names, "seed"));
    for (auto name = std::ranges::find(names, "sample") + 1; name != names.end(); ++name)
        if (*name != "t" && *name != "cam_angle") values_.push_back(*name), columns_.emplace_back(column(*name));
}

std::string SweepTable::place(const PointRows& point) const {
    std::string text;
    for (const std::string& axis : axes_) text += fmt::format("{} = {:.9g}, ", axis, at(point, axis));
    return text + fmt::format("seed {:g}", at(point, "seed"));
}

bool SweepTable::same_rows(const PointRows& own, const SweepTable& other, const PointRows& its) const {
    if (own.size() != its.size()) return false;
    return std::ranges::all_of(table_.columns, [&](const output::TableColumn& each) {
        const std::size_t rows = std::max<std::size_t>(own.size(), 1);
        return std::ranges::equal(SweepColumn(each.values).subspan(own.begin, rows),
                                  SweepColumn(other.column(each.name)).subspan(its.begin, rows), same_number);
    });
}

const std::vector<double>& SweepTable::column(const std::string& name) const {
    if (const std::vector<double>* found = table_.find(name)) return *found;
    throw output::IoError(fmt::format("the record of the sweep is damaged: it has no column {}", name));
}

}  // namespace beamcam::scenes
