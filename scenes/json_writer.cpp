// JSON that scenes/ writes: a resolved scene in its own format, and a plan.
#include <nlohmann/json.hpp>

#include "scenes/plan.hpp"
#include "scenes/scene.hpp"

namespace beamcam::scenes {
namespace {

using Json = nlohmann::ordered_json;

Json drive(const sim::Drive& any) {
    struct Write {
        Json operator()(const sim::FreeDrive&) const { return {{"type", "free"}}; }
        Json operator()(const sim::ConstantTorque& d) const { return {{"type", "torque"}, {"value", d.value}}; }
        Json operator()(const sim::HarmonicTorque& d) const {
            return {{"type", "torque"}, {"amplitude", d.amplitude}, {"frequency", d.frequency}, {"phase", d.phase}};
        }
        Json operator()(const sim::TorqueTable& d) const {
            return {{"type", "torque"}, {"t", d.t}, {"torque", d.torque}};
        }
        Json operator()(const sim::ConstantSpeed& d) const {
            return {{"type", "prescribed"}, {"law", "constant"}, {"speed", d.speed}};
        }
        Json operator()(const sim::SpinUp& d) const {
            return {{"type", "prescribed"}, {"law", "spin-up"}, {"speed", d.speed}, {"duration", d.duration}};
        }
        Json operator()(const sim::AngleTable& d) const {
            return {{"type", "prescribed"}, {"law", "table"}, {"t", d.t}, {"theta", d.theta}};
        }
    };
    return std::visit(Write{}, any);
}

Json friction(const sim::Friction& any) {
    struct Write {
        Json operator()(const sim::NoFriction&) const { return {{"type", "none"}}; }
        Json operator()(const sim::CoulombFriction& f) const {
            return {{"type", "coulomb"}, {"coefficient", f.coefficient}, {"slip_speed", f.slip_speed}};
        }
        Json operator()(const sim::StickSlipFriction& f) const {
            Json out = {{"type", "stick-slip"}, {"coefficient", f.coefficient}};
            if (f.static_coefficient) out["static_coefficient"] = *f.static_coefficient;
            if (f.stiffness) out["stiffness"] = *f.stiffness;
            if (f.damping) out["damping"] = *f.damping;
            return out;
        }
    };
    return std::visit(Write{}, any);
}

Json beam(const sim::Beam& b) {
    Json out = {{"length", b.length},
                {"area", b.area},
                {"second_moment", b.second_moment},
                {"density", b.density},
                {"youngs_modulus", b.youngs_modulus},
                {"poisson_ratio", b.poisson_ratio},
                {"depth", b.depth},
                {"model", name(b.model)},
                {"basis", name(b.basis)},
                {"modes", b.modes}};
    if (b.damping_ratio.size() == 1)
        out["damping_ratio"] = b.damping_ratio.front();
    else if (!b.damping_ratio.empty())
        out["damping_ratio"] = b.damping_ratio;
    if (b.kelvin_voigt) out["kelvin_voigt"] = *b.kelvin_voigt;
    return out;
}

Json cam(const std::optional<sim::Cam>& c) {
    if (!c) return nullptr;
    Json out = {{"centre", {c->centre.x, c->centre.y}},
                {"radius", c->radius},
                {"eccentricity", c->eccentricity},
                {"phase", c->phase},
                {"speed", c->speed},
                {"poisson_ratio", c->poisson_ratio}};
    if (c->youngs_modulus) out["youngs_modulus"] = *c->youngs_modulus;
    return out;
}

Json contact(const sim::Contact& c) {
    const bool by_value = c.approach_floor.policy == sim::ApproachFloorPolicy::value;
    return {{"model", name(c.model)},
            {"stiffness", c.stiffness ? Json(*c.stiffness) : Json("hertz")},
            {"exponent", c.exponent},
            {"damping", name(c.damping)},
            {"restitution", c.restitution},
            {"law", name(c.law)},
            {"friction", friction(c.friction)},
            {"offset", c.offset ? Json(*c.offset) : Json("half-depth")},
            {"approach_floor", {{"policy", by_value ? "value" : "first-touch"}, {"value", c.approach_floor.value}}},
            {"collision_gap", c.collision_gap}};
}

Json frame_rate(const FrameRate& rate) {
    if (rate.denominator == 1) return rate.numerator;
    return std::to_string(rate.numerator) + "/" + std::to_string(rate.denominator);
}

Json layout(const render::LayoutNode& node) {
    using Kind = render::LayoutNode::Kind;
    Json out;
    if (node.kind == Kind::panel) {
        const render::PanelSpec& p = node.panel;
        out["panel"] = render::name(p.kind);
        for (const sim::Channel& channel : p.channels) out["channels"].push_back(name(channel));
        if (p.by_collision) out["window"] = "collision";
        if (p.window) out["window"] = *p.window;
        if (p.member > 0) out["motion"] = p.member + 1;
    } else {
        for (const render::LayoutNode& child : node.children)
            out[node.kind == Kind::rows ? "rows" : "columns"].push_back(layout(child));
    }
    out["share"] = node.share;
    return out;
}

Json instant(const Instant& at) {
    switch (at.kind) {
        case Instant::Kind::time:
            return at.t;
        case Instant::Kind::impact:
            return "impact:" + std::to_string(at.number);
        case Instant::Kind::collision:
            return "collision:" + std::to_string(at.number);
    }
    return at.t;
}

template <class Film>
Json film(const char* type, const Film& film) {
    static constexpr const char* kThemes[] = {"light", "dark", "print"};
    const render::Orbit& orbit = film.view.orbit;
    Json view = {{"style", view_name(film.view)},
                 {"trace", film.view.trace == render::TraceColor::force ? "force" : "age"},
                 {"tip_path", film.view.tip_path ? "whole" : "recent"}};
    if (film.view.style == render::Style::solid)
        view["camera"] = {{"yaw", orbit.yaw}, {"pitch", orbit.pitch}, {"swing", orbit.swing}};
    if (film.view.exaggeration) view["exaggeration"] = *film.view.exaggeration;
    Json out = {{"type", type},
                {"file", film.file},
                {"view", view},
                {"theme", kThemes[static_cast<int>(film.view.theme)]},
                {"background", film.view.transparent ? "transparent" : "paper"},
                {"size", {film.size.width, film.size.height}},
                {"layout", film.layout ? layout(*film.layout) : Json("auto")}};
    if (film.compare.empty()) return out;
    out["comparison"] = film.comparison == render::Comparison::panels ? "panels" : "ghosts";
    for (const Compared& each : film.compare) {
        // All of its mechanics, so that it does not depend on the scene's own or on another file.
        Json set = Json::parse(each.physics);
        set.erase("time");
        out["compare"].push_back({{"label", each.label}, {"set", set}});
    }
    return out;
}

void add_span(Json& out, const FrameSpan& span) {
    out["fps"] = frame_rate(span.fps);
    out["from"] = span.from;
    if (span.to) out["to"] = *span.to;
    if (const auto& slow = span.speed.around)
        out["speed"] = {{"around", "impacts"},    {"factor", slow->factor}, {"otherwise", span.speed.factor},
                        {"before", slow->before}, {"after", slow->after},   {"ease", slow->ease}};
    else
        out["speed"] = span.speed.factor;
    for (const FilmEvent& event : span.events)
        out["events"].push_back(
            {{"at", instant(event.at)}, {"freeze", event.freeze}, {"text", event.text}, {"show", event.show}});
}

Json output_json(const Output& any) {
    struct Write {
        Json operator()(const VideoOutput& v) const {
            Json out = film("video", v);
            add_span(out, v.span);
            if (v.span.poster) out["poster"] = instant(*v.span.poster);
            out["codec"] = output::name(v.encoding.codec);
            if (v.encoding.crf) out["crf"] = *v.encoding.crf;
            if (v.encoding.codec == output::Codec::h264) out["preset"] = v.encoding.preset;
            if (v.encoding.variable_rate) out["rate_mode"] = "variable";
            return out;
        }
        Json operator()(const FramesOutput& f) const {
            Json out = film("frames", f);
            add_span(out, f.span);
            return out;
        }
        Json operator()(const StillOutput& s) const {
            Json out = film("still", s);
            out["at"] = instant(s.at);
            return out;
        }
        Json operator()(const FigureOutput& f) const {
            Json out = {{"type", "figure"},   {"file", f.file}, {"figure", f.figure},
                        {"column", f.column}, {"dpi", f.dpi},   {"lang", f.lang == Lang::zh ? "zh" : "en"}};
            if (f.width) out["width"] = *f.width;
            return out;
        }
        Json operator()(const TrajectoryOutput& t) const {
            Json out = {{"type", "trajectory"}, {"file", t.file}};
            for (const sim::Channel& channel : t.channels) out["channels"].push_back(name(channel));
            if (t.times.empty())
                out["rate"] = t.rate;
            else
                out["times"] = t.times;
            return out;
        }
        Json operator()(const ImpactsOutput& i) const { return {{"type", "impacts"}, {"file", i.file}}; }
        Json operator()(const SummaryOutput& s) const {
            return {{"type", "summary"}, {"file", s.file}, {"horizon", s.horizon}};
        }
    };
    return std::visit(Write{}, any);
}

}  // namespace

std::string to_json(const Scene& scene) {
    const sim::Problem& p = scene.problem;
    Json out;
    if (!scene.title.empty()) out["title"] = scene.title;
    out["hub"] = {{"radius", p.hub.radius}, {"inertia", p.hub.inertia}, {"drive", drive(p.hub.drive)}};
    out["beam"] = beam(p.beam);
    out["cam"] = cam(p.cam);
    out["contact"] = contact(p.contact);
    out["gravity"] = p.gravity;
    out["initial"] = {
        {"angle", p.initial.angle}, {"angular_velocity", p.initial.angular_velocity}, {"shape", name(p.initial.shape)}};
    out["solver"] = {{"method", name(p.solver.method)},
                     {"rtol", p.solver.rtol},
                     {"atol", p.solver.atol},
                     {"max_steps", p.solver.max_steps}};
    out["time"] = {{"end", scene.end_time}};
    if (!scene.outputs.empty()) {
        out["outputs"] = Json::array();
        for (const Output& each : scene.outputs) out["outputs"].push_back(output_json(each));
    }
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

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
