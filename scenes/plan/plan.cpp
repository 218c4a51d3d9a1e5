#include "scenes/plan/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "render/film/parameter_line.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

Plan plan(const Scene& scene, const Shard& shard, const ExistingWork& existing) {
    return Planner(scene, shard, existing).make();
}

bool Plan::needs_gl() const {
    return std::ranges::any_of(pictures, [](const Pictures& p) { return p.view.style != render::Style::flat; });
}

bool Plan::needs_encoder() const {
    return std::ranges::any_of(pictures, [](const Pictures& p) { return p.kind == Pictures::Kind::video; });
}

const std::vector<double>& Plan::times(const Pictures& p) const {
    return p.shown.front().request.poses[kFramePoses].times;
}

std::vector<sim::Request> requests_of(const Plan& plan) {
    std::vector<sim::Request> all;
    if (!plan.simulation) return all;
    all.push_back(plan.simulation->request);
    const auto add = [&all](const std::vector<Study>& studies) {
        for (const Study& study : studies)
            if (study.of_scene) all.push_back(study.request);
    };
    for (const Pictures& p : plan.pictures) add(p.shown);
    for (const FigureFile& f : plan.figures) add(f.studies);
    return all;
}

std::string why_panels_are_omitted(const Size& size) {
    return fmt::format("{} × {} is too small for them; increase \"size\" or their shares, or remove panels", size.width,
                       size.height);
}

std::string why_text_is_omitted(const Size& size) {
    return fmt::format("{} × {} is too small for them; increase \"size\"", size.width, size.height);
}

std::string omitted_text(const Pictures& p, const Scene& scene) {
    std::vector<const sim::Problem*> problems;
    for (const Compared& each : p.compare) problems.push_back(&each.problem);
    if (problems.empty()) problems.push_back(&scene.problem);
    const int members = p.comparison == render::Comparison::panels ? static_cast<int>(problems.size()) : 1;
    return fmt::format("{}", fmt::join(render::omitted_text(p.size.width, p.size.height, p.layout, members, scene.title,
                                                            problems, p.view.show, scene.units.speed),
                                       "; "));
}

std::string characters_without_font(const PictureOutput& p, const Scene& scene) {
    if (p.kind == PictureOutput::Kind::page) return {};
    std::string written = scene.title;
    for (const FilmEvent& event : p.span.events) written += event.text;
    for (const Compared& motion : p.compare) written += motion.label;
    for (const Measurement& data : scene.data) written += data.label;
    const std::string lost = render::characters_without_font(written);
    return lost.empty() ? lost : fmt::format("{} omits {}: no font has these characters", p.file, lost);
}

bool is_slow_motion(const Pictures& p) {
    return p.compare.empty() &&
           (p.span.speed.around || p.span.speed.factor <= 0.1 ||
            (p.span.duration && !p.ends_at_event() && p.end_time - p.span.from <= 0.1 * *p.span.duration));
}

}  // namespace beamcam::scenes
