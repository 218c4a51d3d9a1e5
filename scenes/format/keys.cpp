#include "scenes/format/keys.hpp"

#include "scenes/format/checks.hpp"
#include "scenes/format/object_reader.hpp"
#include "sim/problem/assumptions.hpp"

namespace beamcam::scenes {
namespace {

sim::Alternative output_of(Output& output, const PictureType& type) {
    return {{{"type", type.name}},
            type.meaning,
            picture_of(output, type.kind) != nullptr,
            [&output, kind = type.kind](sim::Visitor& v) {
                if (!picture_of(output, kind)) output = PictureOutput::of(kind);
                std::get<PictureOutput>(output).visit(static_cast<SceneVisitor&>(v));
            }};
}

template <class Type>
sim::Alternative output_of(Output& output) {
    return {{{"type", Type::kType}}, Type::kMeaning, std::holds_alternative<Type>(output), [&output](sim::Visitor& v) {
                if (!std::holds_alternative<Type>(output)) output.emplace<Type>();
                std::get<Type>(output).visit(static_cast<SceneVisitor&>(v));
            }};
}

template <class... Others>
std::vector<sim::Alternative> types_of(std::variant<PictureOutput, Others...>& output) {
    std::vector<sim::Alternative> all;
    for (const PictureType& type : kPictureTypes) all.push_back(output_of(output, type));
    (all.push_back(output_of<Others>(output)), ...);
    return all;
}

}  // namespace

void visit(SceneVisitor& v, Output& output) { v.alternatives(types_of(output), true); }

void visit_outputs(SceneVisitor& v, Scene& scene) {
    v.list("outputs", SceneVisitor::items_of(scene.outputs),
           "The files that `beamcam run` writes. Without any: one film with the name of the scene.");
    v.check([&scene](ObjectReader& r) { check_outputs(r, scene); });
}

// ---- the scene ---------------------------------------------------------------------------------

void visit(SceneVisitor& v, Scene& scene) {
    std::string schema;
    v.text(sim::written_if(false, "$schema"), schema, "Location of the JSON Schema, for editors.");
    v.text(sim::written_if(!scene.title.empty(), "title"), scene.title,
           "Title of pictures; formulas are between dollar signs: $\\omega_1 = \\frac{a}{b}$, $\\dot\\theta$.");
    v.check([&scene](ObjectReader& r) { check_words(r, "title", scene.title); });
    v.problem(scene.problem);
    const auto time = [&scene](sim::Visitor& inside) {
        inside.number("end", scene.end_time, sim::dimension::kTime,
                      {0, kLatestEnd, true, false,
                       "must be positive and at most 1e12 s; write the number of seconds to simulate"},
                      "End of the simulation, which starts at 0.");
    };
    v.object("time", time, "Duration of the simulation.", nullptr);
    v.check([&scene](ObjectReader& r) { infer_units(r, scene.units); });
    v.object(
        sim::written_if(scene.units != render::Units{}, "units"),
        [&scene](sim::Visitor& inside) {
            auto& s = static_cast<SceneVisitor&>(inside);
            s.choice(
                sim::derived("angle"), scene.units.degrees, {{false, "rad"}, {true, "deg"}},
                "Unit of angles; by default that of initial.angle, cam.phase or cam.profile.lowest, the first that is "
                "a text with a unit.");
            s.choice(sim::derived("speed"), scene.units.speed,
                     {{render::SpeedUnit::automatic, "auto"},
                      {render::SpeedUnit::radians, "rad/s"},
                      {render::SpeedUnit::degrees, "deg/s"},
                      {render::SpeedUnit::rpm, "rpm"}},
                     "Unit of angular speeds; by default that of cam.speed, the drive or initial.angular_velocity, the "
                     "first that is a text with a unit. auto: rad/s, in charts that of angles per second. Of a key "
                     "that is swept the sweep's first value counts.");
        },
        "Units of angles and speeds in films and figures.", nullptr);
    v.check([&scene](ObjectReader& r) {
        check_physics(r, scene.problem);
        if (!r.diagnostics().any())
            scene.notes = sim::assumptions(scene.problem, written_value(*r.node(), "contact.stiffness") != nullptr,
                                           scene.end_time);
    });
    Sweep sweep = scene.sweep.value_or(Sweep{});
    bool swept = scene.sweep.has_value();
    v.object(sim::written_if(swept, "sweep"), SceneVisitor::keys_of(sweep),
             "Many motions over one or two keys (`beamcam sweep`); null: none.", &swept);
    if (swept) scene.sweep = std::move(sweep);
    v.list("data", SceneVisitor::items_of(scene.data),
           "Measured data of the motion: series and films show them, summaries compare the motion with them.");
    visit_outputs(v, scene);
}

}  // namespace beamcam::scenes
