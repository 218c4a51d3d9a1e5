// The plan as JSON.
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

Json motion_stage(const sim::Problem& problem, const sim::Request& request, const std::string& because) {
    return {{"stage", "simulate"},
            {"model", name(problem.beam.model)},
            {"modes", problem.beam.model == sim::ModelKind::rigid ? 0 : problem.beam.modes},
            {"until", request.end_time},
            {"because", because}};
}

Json stage_of(const Simulation& simulation, const sim::Problem& problem) {
    Json stage = motion_stage(problem, simulation.request, simulation.until_because);
    if (!simulation.until_events.empty()) stage["until_events"] = simulation.until_events;
    stage["horizon"] = simulation.horizon;
    stage["from_cache"] = simulation.from_cache;
    stage["keep"] = simulation.keep;
    put_cost(stage, simulation.cost, "steps");
    return stage;
}

Json stage_of(const Pictures& p, const std::vector<double>& times) {
    Json stage = {{"stage", kind_name(p.kind)}, {"file", p.file}, {"output", p.output}};
    if (p.times_known) {
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
    return stage;
}

}  // namespace

std::string to_json(const Plan& plan, const Scene& scene) {
    Json out, stages = Json::array();
    if (plan.events_until) stages.push_back({{"stage", "impacts"}, {"until", *plan.events_until}});
    if (plan.simulation) stages.push_back(stage_of(*plan.simulation, scene.problem));
    for (const Pictures& p : plan.pictures) {
        for (const ComparedMotion& motion : p.compared) {
            stages.push_back(motion_stage(motion.problem, motion.request, p.file));
            stages.back()["label"] = motion.label;
        }
        stages.push_back(stage_of(p, plan.times(p)));
    }
    for (const Variant& variant : plan.variants) stages.push_back(stage_of(variant.simulation, variant.problem));
    for (const FigureFile& f : plan.figures) {
        Json stage = {{"stage", "figure"}, {"file", f.file}, {"output", f.output}, {"figure", f.figure}};
        put_cost(stage, f.cost, "bytes");
        stages.push_back(std::move(stage));
    }
    for (const DataFile& d : plan.data) {
        Json stage = {{"stage", d.stage}, {"file", d.file}, {"output", d.output}};
        stage.update(Json::parse(to_text(d.details)));
        put_cost(stage, d.cost, "bytes");
        stages.push_back(std::move(stage));
    }
    out["stages"] = std::move(stages);
    put_cost(out, plan.cost(), "bytes");
    Json skipped = Json::array();
    for (const Skipped& s : plan.skipped) skipped.push_back({{"what", s.what}, {"why", s.why}});
    out["skipped"] = std::move(skipped);
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace beamcam::scenes
