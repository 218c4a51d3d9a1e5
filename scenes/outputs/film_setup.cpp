#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/draw/markup.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/series_data.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/plan/resolve.hpp"

namespace beamcam::scenes {
namespace {

// "10⁻⁸", "2 × 10⁻⁹".
std::string plain_digit(double value) { return render::to_plain(one_digit(value)); }

std::string beyond_model(const sim::Problem& problem, render::Lang lang) {
    return phrase(lang, "bends beyond {}", phrase(lang, sim::name(problem.beam.model)));
}

render::Motion motion_of(const MotionRequest& shown, sim::Result& result) {
    render::Motion motion;
    motion.problem = shown.problem;
    motion.label = shown.label;
    motion.poses = std::move(result.poses[kFramePoses]);
    motion.survey = std::move(result.poses[kSurveyPoses]);
    motion.path = std::move(result.poses[kPathPoses]);
    motion.chart = std::move(result.tables[kChartTable]);
    if (shown.problem.cam) motion.trace = std::move(result.tables[kTraceTable]);
    motion.impacts = result.impacts;
    motion.end = result.end_time;
    return motion;
}

std::vector<render::FilmData> data_of(const Scene& scene) {
    std::vector<render::FilmData> out;
    for (const Measurement& each : scene.data) {
        out.push_back({render::to_plain(each.label), each.is_line(each.times.size()), each.times, {}});
        for (std::size_t c = 0; c < each.columns.size(); ++c)
            out.back().values.emplace_back(each.columns[c].first, each.values[c]);
    }
    return out;
}

void add_motions(const Plan& plan, const PlannedPictures& p, std::span<sim::Result* const> results,
                 render::FilmSetup& setup) {
    for (std::size_t i = 0; i < p.motions.size(); ++i) {
        const MotionRequest& shown = plan.motions[p.motions[i]];
        if (results[i]->beyond_model) setup.warning = beyond_model(shown.problem, p.view.lang);
        render::Motion motion = motion_of(shown, *results[i]);
        if (i == 0)
            static_cast<render::Motion&>(setup) = std::move(motion);
        else
            setup.others.push_back(std::move(motion));
    }
}

}  // namespace

std::string accuracy_note(const sim::Problem& problem, const sim::Result& result) {
    std::string note = fmt::format("rtol {}", plain_digit(problem.solver.rtol));
    if (result.energy_scale > 0 && result.energy_residual_max > 0)
        note += fmt::format(" · energy closes to {}", plain_digit(result.energy_residual_max / result.energy_scale));
    if (result.beyond_model) note += " · " + beyond_model(problem, render::Lang::en);
    return note;
}

render::FilmSetup film_setup(const Plan& plan, const PlannedPictures& p, const Scene& scene,
                             std::span<sim::Result* const> results) {
    render::FilmSetup setup;
    setup.title = scene.title;
    setup.scene_end = scene.end_time;
    setup.width = p.size.width;
    setup.height = p.size.height;
    setup.view = p.view;
    setup.units = scene.units;
    setup.layout = p.layout;
    setup.comparison = p.comparison;
    if (p.kind != PlannedPictures::Kind::still) setup.fps = p.span.fps.value();
    setup.speeds = p.times.speeds;
    setup.by_collision = shows_latest_collision(p, p.end_time);
    setup.callouts = p.times.callouts;
    setup.data = data_of(scene);
    setup.moves = p.times.moves;
    add_motions(plan, p, results, setup);
    return setup;
}

}  // namespace beamcam::scenes
