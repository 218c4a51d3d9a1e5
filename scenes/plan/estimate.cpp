#include "scenes/plan/estimate.hpp"

#include <fmt/format.h>

#include <optional>

#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

std::vector<std::string> picture_work(const Pictures& p, int threads) {
    std::string how = fmt::format("{} {}", kind_name(p.kind), view_name(p.view));
    if (p.kind == Pictures::Kind::video) how += ", " + encoding_text(p.encoding);
    if (!p.compare.empty()) how += fmt::format(", {} motions", p.compare.size());
    return {fmt::format("{}, {} x {}, {} threads", how, p.size.width, p.size.height, threads)};
}

std::vector<std::string> figure_work(const FigureFile& f) {
    return {fmt::format("figure {} {}", f.figure, ending_of(f.file)), "figure"};
}

std::vector<std::string> data_work(const DataFile& d) { return {"numbers of " + ending_of(d.file)}; }

namespace {

std::optional<Cost> cost(const History& history, const Simulation& s) {
    return history.find(motion_work(s.key, s.problem, s.from_cache, s.horizon), s.request.end_time);
}

}  // namespace

void estimate(Plan& plan, const History& history, int threads) {
    if (plan.simulation && plan.simulation->until_events.empty())
        plan.simulation->cost = cost(history, *plan.simulation);
    for (Simulation& s : plan.others) s.cost = cost(history, s);
    for (Pictures& p : plan.pictures)
        if (!p.draw.empty()) p.cost = history.find(picture_work(p, threads), static_cast<double>(p.draw.size()));
    for (FigureFile& f : plan.figures) f.cost = history.find(figure_work(f));
    for (DataFile& d : plan.data)
        if (d.numbers > 0) d.cost = history.find(data_work(d), static_cast<double>(d.numbers));
}

}  // namespace beamcam::scenes
