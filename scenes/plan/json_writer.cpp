// JSON that scenes/ writes: a resolved scene in its own format, and a plan.
#include <nlohmann/json.hpp>

#include "scenes/plan/plan.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {
namespace {

using Json = nlohmann::ordered_json;

void put_cost(Json& stage, const std::optional<Cost>& cost, const char* amount) {
    if (!cost) return;
    stage["seconds"] = cost->seconds;
    stage[amount] = cost->amount;
}

Json stage_of(const Simulation& simulation, const sim::Problem& problem) {
    Json stage = {{"stage", "simulate"},
                  {"model", name(problem.beam.model)},
                  {"modes", problem.beam.model == sim::ModelKind::rigid ? 0 : problem.beam.modes},
                  {"until", simulation.request.end_time},
                  {"because", simulation.until_because},
                  {"horizon", simulation.horizon},
                  {"from_cache", simulation.from_cache},
                  {"keep", simulation.keep}};
    put_cost(stage, simulation.cost, "steps");
    return stage;
}

}  // namespace

std::string to_json(const Plan& plan, const Scene& scene) {
    Json out, stages = Json::array();
    if (plan.impacts_until) stages.push_back({{"stage", "impacts"}, {"until", *plan.impacts_until}});
    if (plan.simulation) stages.push_back(stage_of(*plan.simulation, scene.problem));
    for (const Pictures& p : plan.pictures) {
        const std::vector<double>& times = plan.times(p);
        for (const ComparedMotion& motion : p.compared)
            stages.push_back(
                {{"stage", "simulate"},
                 {"model", name(motion.problem.beam.model)},
                 {"modes", motion.problem.beam.model == sim::ModelKind::rigid ? 0 : motion.problem.beam.modes},
                 {"until", motion.request.end_time},
                 {"because", p.file},
                 {"label", motion.label}});
        Json stage = {{"stage", kind_name(p.kind)}, {"file", p.file}, {"output", p.output}};
        if (p.settled) {
            stage["frames"] = p.draw.size();
            stage["from"] = times[static_cast<std::size_t>(p.draw.front())];
            stage["last"] = times[static_cast<std::size_t>(p.draw.back())];
        }
        stage["size"] = {p.picture.size.width, p.picture.size.height};
        stage["style"] = view_name(p.picture.view);
        if (p.kind != Pictures::Kind::still) stage["fps"] = p.span.fps.value();
        if (p.kind == Pictures::Kind::video) {
            stage["codec"] = output::name(p.encoding.codec);
            if (p.encoding.crf) stage["crf"] = *p.encoding.crf;
            if (p.encoding.codec == output::Codec::h264) stage["preset"] = p.encoding.preset;
            if (p.encoding.variable_rate) stage["rate_mode"] = "variable";
            if (!p.poster_file.empty()) stage["poster"] = p.poster_file;
        }
        put_cost(stage, p.cost, "bytes");
        stages.push_back(std::move(stage));
    }
    for (const Variant& variant : plan.variants) stages.push_back(stage_of(variant.simulation, variant.problem));
    for (const FigureFile& f : plan.figures) {
        Json stage = {{"stage", "figure"}, {"file", f.file}, {"output", f.output}, {"figure", f.figure}};
        put_cost(stage, f.cost, "bytes");
        stages.push_back(std::move(stage));
    }
    for (const TableFile& t : plan.tables) {
        const sim::TableRequest& table = plan.simulation->request.tables[t.table];
        Json channels = Json::array();
        for (const sim::Channel& channel : table.channels) channels.push_back(name(channel));
        Json stage = {{"stage", "table"},
                      {"file", t.file},
                      {"output", t.output},
                      {"rows", table.times.size()},
                      {"channels", channels}};
        put_cost(stage, t.cost, "bytes");
        stages.push_back(std::move(stage));
    }
    for (const ImpactsFile& i : plan.impacts)
        stages.push_back({{"stage", "impacts"}, {"file", i.file}, {"output", i.output}});
    for (const SummaryFile& s : plan.summaries)
        stages.push_back({{"stage", "summary"}, {"file", s.file}, {"output", s.output}});
    out["stages"] = std::move(stages);
    put_cost(out, plan.cost(), "bytes");
    Json skipped = Json::array();
    for (const Skipped& s : plan.skipped) skipped.push_back({{"what", s.what}, {"why", s.why}});
    out["skipped"] = std::move(skipped);
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace beamcam::scenes
