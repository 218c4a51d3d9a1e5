#include "scenes/sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/json/tree.hpp"
#include "scenes/sweep/make_points.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

// Size of a number in CSV and NPZ files [bytes], and columns besides those of the samples.
constexpr double kTextOfNumber = 19, kNumber = 8;
constexpr double kCommonColumns = 9;

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

std::string sweep_plan(const SweepGrid& grid, const std::vector<PlannedFile>& files, int threads, bool json) {
    const SweepCost cost = cost_of(grid);
    const int used = static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(threads), grid.tasks()));
    const double seconds = cost.seconds / std::max(used, 1);
    const double columns = kCommonColumns + (grid.sampling().kind == sim::SampleKind::impacts ? 11 : 5);
    const double rows = std::max(cost.rows, static_cast<double>(grid.points()));
    if (json)
        return to_text(object_node({{"points", grid.points()},
                                    {"tasks", grid.tasks()},
                                    {"threads", used},
                                    {"seconds", seconds},
                                    {"rows", std::round(rows)},
                                    {"csv_bytes", std::round(rows * columns * kTextOfNumber)},
                                    {"npz_bytes", std::round(rows * columns * kNumber)},
                                    {"files", array_node(files, &PlannedFile::file)}}));
    std::string text = "sweep\n";
    for (std::size_t i = 0; i < grid.axes().size(); ++i) text += axis_text(grid.axes()[i], grid.sweep().over[i]);
    text += fmt::format("  {}, samples: {}\n", counted(grid.points(), "point"), text_of_sample(grid.sampling()));
    text += fmt::format("  about {:.2g} s on {}\n", seconds, counted(used, "thread"));
    text += fmt::format("  about {:.2g} rows: {:.2g} MB of CSV, {:.2g} MB of NPZ\n", rows,
                        1e-6 * rows * columns * kTextOfNumber, 1e-6 * rows * columns * kNumber);
    for (const PlannedFile& each : files) text += fmt::format("  {}: {}\n", each.file, each.content);
    return text;
}

}  // namespace beamcam::scenes
