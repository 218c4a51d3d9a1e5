#include "scenes/sweep/swept_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "output/data/table_reader.hpp"
#include "scenes/figures/motion_requests.hpp"
#include "scenes/scene/exit_code.hpp"
#include "sim/problem/number_keys.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

// The numbers of the classes whose sections belong to a lasting motion.
std::vector<double> lasting_classes() {
    std::vector<double> numbers;
    for (const auto& [kind, name] : sim::names(sim::AttractorClass{}))
        if (sim::has_section(kind)) numbers.push_back(static_cast<double>(kind));
    return numbers;
}

}  // namespace

sim::Problem problem_with(sim::Problem problem, const std::string& key, double value, bool any_start) {
    if (!sim::set_number(problem, key, value))
        throw SceneError(fmt::format("{} = {:.10g} is outside its range or not a whole number", key, value));
    for (const sim::Issue& finding : sim::validate(problem))
        if (finding.fatal && !(any_start && finding.path.starts_with("initial")))
            throw SceneError(fmt::format("at {} = {:.10g}: {}: {}", key, value, finding.path, finding.message));
    return problem;
}

SweptImpacts swept_impacts(const std::string& file, const std::string& key, double from, double to) {
    const output::ColumnTable table = output::read_table(file);
    const auto column = [&](const std::string& name) -> const std::vector<double>& {
        if (const std::vector<double>* found = table.find(name)) return *found;
        throw UsageError(fmt::format(
            "--sweep {}: column {} is missing; write the file by beamcam sweep --over {}=... --sample impacts -o {}",
            file, name, key, file));
    };
    const std::vector<double>&value = column(key), &speed = column("v_n_before");
    const std::vector<double>* kind = table.find("class");
    const std::vector<double> lasting = lasting_classes();
    SweptImpacts out;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        if (kind && std::ranges::find(lasting, (*kind)[i]) == lasting.end()) continue;
        if (!(value[i] >= from && value[i] <= to) || std::isnan(speed[i])) continue;
        out.parameter.push_back(value[i]);
        out.approach.push_back(-speed[i]);
    }
    return out;
}

sim::Problem problem_at_row(sim::Problem problem, const std::string& file, int row) {
    const output::ColumnTable table = output::read_table(file);
    const auto index = static_cast<std::size_t>(row - 1);
    if (index >= table.rows()) throw UsageError(fmt::format("--row {}: {} has {} rows", row, file, table.rows()));
    const auto value = [&](const char* name) {
        const std::vector<double>* column = table.find(name);
        if (!column || std::isnan((*column)[index]))
            throw UsageError(fmt::format("--row {}: {} is missing in this row of {}", row, name, file));
        return (*column)[index];
    };
    for (const sim::NumberKey& key : sim::number_keys(problem))
        if (const std::vector<double>* column = table.find(key.path))
            problem = problem_with(problem, key.path, (*column)[index]);
    if (!problem.cam) throw UsageError("--row: the scene has no cam");
    constexpr double kAbove = 1e-9;  // [rad]; a row of impacts must start outside the cam
    problem.cam->phase = value("cam_angle");
    problem.initial = {};
    problem.initial.angle = value("theta") + kAbove;
    problem.initial.angular_velocity = value("theta_dot");
    return problem;
}

}  // namespace beamcam::scenes
