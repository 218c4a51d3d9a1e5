// The plan as JSON.
#include "scenes/plan/plan.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {
namespace {

Node file_stage(const char* name, const std::string& file, std::size_t output) {
    return object_node({{"stage", name}, {"file", file}, {"output", output}});
}

Node stage_of(const Simulation& simulation) {
    const sim::Beam& beam = simulation.problem.beam;
    Node stage = object_node({{"stage", "simulate"},
                              {"model", name(beam.model)},
                              {"modes", beam.model == sim::ModelKind::rigid ? 0 : beam.modes},
                              {"until", simulation.request.end_time},
                              {"because", simulation.until_because}});
    if (!simulation.label.empty()) add(stage, "label", simulation.label);
    if (!simulation.until_events.empty()) add(stage, "until_events", simulation.until_events);
    add(stage, "horizon", simulation.horizon);
    return stage;
}

Node stage_of(const Pictures& p, const std::vector<double>& times) {
    Node stage = file_stage(kind_name(p.kind), p.file, p.output);
    if (!p.draw.empty()) add(stage, "frames", p.draw.size());
    if (p.times_known) {
        add(stage, "from", times[static_cast<std::size_t>(p.draw.front())]);
        add(stage, "last", times[static_cast<std::size_t>(p.draw.back())]);
    }
    add(stage, "size", array_node({p.size.width, p.size.height}));
    add(stage, "style", view_name(p.view));
    if (p.kind != Pictures::Kind::still) add(stage, "fps", p.span.fps.value());
    if (p.kind == Pictures::Kind::video) {
        add(stage, "codec", output::name(p.encoding.codec));
        if (p.encoding.crf) add(stage, "crf", *p.encoding.crf);
        if (p.encoding.codec == output::Codec::h264) add(stage, "preset", p.encoding.preset);
        if (p.encoding.variable_rate) add(stage, "rate_mode", "variable");
        if (!p.poster_file.empty()) add(stage, "poster", p.poster_file);
    }
    return stage;
}

Node stages_of(const Plan& plan) {
    Node stages = array_node();
    const auto put = [&stages](Node stage) { stages.items.push_back(std::move(stage)); };
    if (plan.events_until) put(object_node({{"stage", "impacts"}, {"until", *plan.events_until}}));
    if (plan.simulation) put(stage_of(*plan.simulation));
    for (const Simulation& other : plan.others) put(stage_of(other));
    for (const Pictures& p : plan.pictures) put(stage_of(p, plan.times(p)));
    for (const FigureFile& f : plan.figures) {
        put(file_stage("figure", f.file, f.output));
        add(stages.items.back(), "figure", f.figure);
    }
    for (const DataFile& d : plan.data) {
        put(file_stage(d.stage.c_str(), d.file, d.output));
        for (const Member& detail : d.details.members) add(stages.items.back(), detail.key, detail.value);
    }
    return stages;
}

}  // namespace

std::string to_json(const Plan& plan) {
    Node out = object_node({{"stages", stages_of(plan)}});
    add(out, "skipped", array_node(plan.skipped, [](const Skipped& each) {
            return object_node({{"what", each.what}, {"why", each.why}});
        }));
    return to_text(out);
}

}  // namespace beamcam::scenes
