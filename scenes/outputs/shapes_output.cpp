// Output "shapes": the deflection along the beam in time, as CSV or NPZ: t, x, v in rows.
#include <fmt/format.h>

#include <algorithm>

#include "output/data/tables.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/film_times.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

void ShapesOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".csv", ".npz"}, "-shapes.csv");
    visit_rows(v, rate, times);
    v.integer("stations", stations, 2, 1001,
              "Number of points along the beam, equally spaced from the root to the tip.");
    v.check([this](ObjectReader& r) { limit_rows(r, rate, stations); });
}

void ShapesOutput::plan(Planner& planner, std::size_t output) const {
    const Scene& scene = planner.scene();
    std::vector<double> instants = times.empty() ? rows(0, scene.end_time, rate) : times;
    planner.simulate_until(*std::ranges::max_element(instants), file);
    std::vector<sim::PoseRequest>& poses = planner.request().poses;
    poses.push_back({.times = std::move(instants), .stations = stations});
    DataFile data{output, file, "shapes", {}};
    data.content = fmt::format("{} points at {} times", stations, poses.back().times.size());
    data.numbers = 3 * static_cast<std::size_t>(stations) * poses.back().times.size();
    data.write = [index = poses.size() - 1](const DataSource& from) {
        output::NamedTable table{{"t", "x", "v"}, {{}, {}, {}}};
        for (const sim::Pose& pose : from.run.poses[index]) {
            const std::vector<double> v = deflection(pose);
            for (std::size_t k = 0; k < v.size(); ++k) {
                table.columns[0].push_back(pose.t);
                table.columns[1].push_back(from.problem.beam.length * static_cast<double>(k) /
                                           static_cast<double>(v.size() - 1));
                table.columns[2].push_back(v[k]);
            }
        }
        output::write_table(*from.file, table);
        return counted(table.rows(), "row");
    };
    planner.add(std::move(data));
}

}  // namespace beamcam::scenes
