#include "scenes/plan/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "render/film/parameter_line.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

Plan plan(const Scene& scene, const Selection& selection, const ExistingWork& existing) {
    return Planner(scene, selection, existing).make();
}

void Simulation::simulate_until(double t, const std::string& file) {
    if (!(t > request.end_time) && !until_because.empty()) return;
    request.end_time = std::max(t, request.end_time);
    until_because = file;
}

bool Plan::needs_gl() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.view.style != render::Style::flat; });
}

bool Plan::needs_encoder() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.kind == Pictures::Kind::video; });
}

std::optional<Cost> Plan::cost() const {
    std::optional<Cost> all;
    const auto add = [&](const std::optional<Cost>& one, bool bytes) {
        if (!one) return;
        if (!all) all.emplace();
        all->seconds += one->seconds;
        if (bytes) all->amount += one->amount;
    };
    if (simulation) add(simulation->cost, false);
    for (const Simulation& s : others) add(s.cost, false);
    for (const Pictures& p : pictures) add(p.cost, true);
    for (const FigureFile& f : figures) add(f.cost, true);
    for (const DataFile& d : data) add(d.cost, true);
    return all;
}

std::vector<double> Plan::times(const Pictures& p) const {
    const sim::Request& request = p.compared.empty() ? simulation->request : p.compared.front().request;
    const PictureRequests& at = p.compared.empty() ? p.of_scene : p.compared.front().of_picture;
    const std::vector<double>& all = request.poses[at.poses].times;
    std::vector<double> out;
    for (std::size_t i = 0; i < all.size(); i += p.view.poses()) out.push_back(all[i]);
    return out;
}

std::vector<sim::Request> requests_of(const Plan& plan) {
    std::vector<sim::Request> all;
    if (!plan.simulation) return all;
    all.push_back(plan.simulation->request);
    for (double end : plan.simulation->ends) {
        all.emplace_back();
        all.back().end_time = end;
    }
    for (const FigureFile& figure : plan.figures)
        for (const Study& study : figure.studies)
            if (study.of_scene) all.push_back(study.request);
    return all;
}

void assign_ends(Plan& plan) {
    if (!plan.simulation) return;
    std::vector<double>& ends = plan.simulation->ends;
    ends.clear();
    for (Pictures& p : plan.pictures) {
        p.until.reset();
        if (!p.compared.empty() || !(p.end_time < plan.simulation->request.end_time)) continue;
        const auto at = std::ranges::find(ends, p.end_time);
        p.until = static_cast<std::size_t>(at - ends.begin());
        if (at == ends.end()) ends.push_back(p.end_time);
    }
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
                                                            problems, p.view.show, scene.units.rpm),
                                       "; "));
}

void add_omitted_text(Plan& plan, const Scene& scene) {
    std::vector<Skipped> notes;
    try {
        for (const Pictures& p : plan.pictures)
            if (const std::string what = omitted_text(p, scene); !what.empty())
                notes.push_back({fmt::format("{} on {}", what, p.file), why_text_is_omitted(p.size)});
    } catch (const render::FontError&) {
        return;  // drawing reports this
    }
    plan.skipped.insert(plan.skipped.begin(), notes.begin(), notes.end());
}

bool is_slow_motion(const Pictures& p) {
    return p.compare.empty() &&
           (p.span.speed.around || p.span.speed.factor <= 0.1 ||
            (p.span.duration && !p.ends_at_event() && p.end_time - p.span.from <= 0.1 * *p.span.duration));
}

bool Pictures::makes_poster() const { return poster && std::ranges::binary_search(draw, *poster); }

}  // namespace beamcam::scenes
