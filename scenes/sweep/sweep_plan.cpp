#include "scenes/sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include "output/json/tree.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

// "  cam.speed: 21 values, 40 to 60 rad/s in steps of 1 rad/s"
std::string axis_text(const output::SweepAxis& axis, const SweptKey& over) {
    const std::string unit = axis.unit == "1" ? "" : " " + axis.unit;
    std::string text = fmt::format("  {}: {}, {:.10g} to {:.10g}{}", axis.name, counted(axis.values.size(), "value"),
                                   axis.values.front(), axis.values.back(), unit);
    if (over.logarithmic)
        text += ", logarithmically spaced";
    else if (over.count && axis.values.size() > 1)
        text += fmt::format(" in steps of {:.6g}{}", axis.values[1] - axis.values[0], unit);
    return text + "\n";
}

}  // namespace

std::string sweep_plan(const SweepGrid& grid, const std::vector<PlannedFile>& files, bool json) {
    if (json)
        return to_text(object_node(
            {{"points", grid.points()}, {"tasks", grid.tasks()}, {"files", array_node(files, &PlannedFile::file)}}));
    std::string text = "sweep\n";
    for (std::size_t i = 0; i < grid.axes().size(); ++i) text += axis_text(grid.axes()[i], grid.sweep().over[i]);
    text += fmt::format("  {}, samples: {}\n", counted(grid.points(), "point"), text_of_sample(grid.sampling()));
    for (const PlannedFile& each : files) text += fmt::format("  {}: {}\n", each.file, each.content);
    return text;
}

}  // namespace beamcam::scenes
