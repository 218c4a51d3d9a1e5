// The mechanics of a scene: from the tree to a sim::Problem.
#include "scenes/sections.hpp"

namespace beamcam::scenes {
namespace {

namespace dim = dimension;

void read_torque(Fields& f, sim::Drive& drive) {
    if (f.has("t") || f.has("torque")) {
        sim::TorqueTable table;
        const Node* t = f.require("t", "[0, 1]");
        const Node* torque = f.require("torque", "[0, 0.5]");
        const bool fine =
            t && torque &&
            f.list_value(*t, "t", dim::kTime, table.t) & f.list_value(*torque, "torque", dim::kTorque, table.torque);
        if (fine && table.t.size() != table.torque.size())
            f.fail(*torque, "torque",
                   fmt::format("{} has {} values and {} has {}; a table needs as many of one as of the other",
                               f.path("torque"), table.torque.size(), f.path("t"), table.t.size()));
        if (fine) drive = std::move(table);
    } else if (f.has("amplitude") || f.has("frequency") || f.has("phase")) {
        sim::HarmonicTorque harmonic;
        if (const Node* node = f.require("amplitude", "0.5"))
            f.value(*node, "amplitude", dim::kTorque, harmonic.amplitude);
        if (const Node* node = f.require("frequency", "\"2 Hz\""))
            f.value(*node, "frequency", dim::kFrequency, harmonic.frequency);
        f.quantity("phase", dim::kAngle, harmonic.phase);
        drive = harmonic;
    } else {
        sim::ConstantTorque constant;
        if (const Node* node = f.require("value", "\"0.5 N m\"")) f.value(*node, "value", dim::kTorque, constant.value);
        drive = constant;
    }
}

void read_prescribed(Fields& f, sim::Drive& drive) {
    enum class Law { constant, spin_up, table };
    Law law = Law::constant;
    const Node* name = f.require("law", "\"constant\"");
    if (!name ||
        !f.choice_value<Law>(*name, "law",
                             {{"constant", Law::constant}, {"spin-up", Law::spin_up}, {"table", Law::table}}, law)) {
        for (const char* key : {"speed", "duration", "t", "theta"}) f.take(key);
        return;
    }
    switch (law) {
        case Law::constant: {
            sim::ConstantSpeed constant;
            if (const Node* node = f.require("speed", "\"30 rpm\""))
                f.value(*node, "speed", dim::kAngularSpeed, constant.speed);
            drive = constant;
            break;
        }
        case Law::spin_up: {
            sim::SpinUp spin_up;
            if (const Node* node = f.require("speed", "4")) f.value(*node, "speed", dim::kAngularSpeed, spin_up.speed);
            if (const Node* node = f.require("duration", "15"))
                f.value(*node, "duration", dim::kTime, spin_up.duration);
            drive = spin_up;
            break;
        }
        case Law::table: {
            sim::AngleTable table;
            const Node* t = f.require("t", "[0, 1, 2]");
            const Node* theta = f.require("theta", "[0, 0.5, 0]");
            const bool fine =
                t && theta &&
                f.list_value(*t, "t", dim::kTime, table.t) & f.list_value(*theta, "theta", dim::kAngle, table.theta);
            if (fine && table.t.size() != table.theta.size())
                f.fail(*theta, "theta",
                       fmt::format("{} has {} values and {} has {}; a table needs as many of one as of the other",
                                   f.path("theta"), table.theta.size(), f.path("t"), table.t.size()));
            if (fine) drive = std::move(table);
            break;
        }
    }
}

void read_drive(Findings& findings, const Node* node, const std::string& path, sim::Drive& drive) {
    enum class Type { free, torque, prescribed };
    if (!node) return;
    Fields f(findings, node, path);
    Type type = Type::free;
    if (!f.node()) return;
    const Node* name = f.require("type", "\"free\"");
    if (!name ||
        !f.choice_value<Type>(*name, "type",
                              {{"free", Type::free}, {"torque", Type::torque}, {"prescribed", Type::prescribed}}, type))
        return;  // the other keys depend on it
    switch (type) {
        case Type::free:
            drive = sim::FreeDrive{};
            break;
        case Type::torque:
            read_torque(f, drive);
            break;
        case Type::prescribed:
            read_prescribed(f, drive);
            break;
    }
    f.finish();
}

void read_hub(Findings& findings, const Node* node, sim::Hub& hub) {
    if (!node) return;
    Fields f(findings, node, "hub");
    f.quantity("radius", dim::kLength, hub.radius);
    f.quantity("inertia", dim::kInertia, hub.inertia);
    read_drive(findings, f.take("drive"), "hub.drive", hub.drive);
    f.finish();
}

void read_damping_ratio(Fields& f, std::vector<double>& ratios) {
    const Node* node = f.take("damping_ratio");
    if (!node) return;
    if (node->kind == Node::Kind::array) {
        f.list_value(*node, "damping_ratio", dim::kNone, ratios);
        return;
    }
    double ratio = 0;
    if (f.value(*node, "damping_ratio", dim::kNone, ratio)) ratios = {ratio};
}

void read_beam(Findings& findings, const Node* node, sim::Beam& beam) {
    if (!node) return;
    Fields f(findings, node, "beam");
    f.quantity("length", dim::kLength, beam.length);
    f.quantity("area", dim::kArea, beam.area);
    f.quantity("second_moment", dim::kSecondMoment, beam.second_moment);
    f.quantity("density", dim::kDensity, beam.density);
    f.quantity("youngs_modulus", dim::kPressure, beam.youngs_modulus);
    f.quantity("poisson_ratio", dim::kNone, beam.poisson_ratio);
    f.quantity("depth", dim::kLength, beam.depth);
    using sim::ModelKind;
    f.choice<ModelKind>("model",
                        {{name(ModelKind::rigid), ModelKind::rigid},
                         {name(ModelKind::zeroth_order), ModelKind::zeroth_order},
                         {name(ModelKind::first_order), ModelKind::first_order},
                         {name(ModelKind::paper), ModelKind::paper},
                         {name(ModelKind::second_order), ModelKind::second_order},
                         {name(ModelKind::exact), ModelKind::exact}},
                        beam.model);
    using sim::Basis;
    f.choice<Basis>("basis",
                    {{name(Basis::automatic), Basis::automatic},
                     {name(Basis::cantilever), Basis::cantilever},
                     {name(Basis::hub_beam), Basis::hub_beam}},
                    beam.basis);
    f.whole("modes", 1, 40, beam.modes);
    read_damping_ratio(f, beam.damping_ratio);
    f.quantity("kelvin_voigt", dim::kTime, beam.kelvin_voigt);
    f.finish();
}

void read_cam(Findings& findings, const Node* node, std::optional<sim::Cam>& out) {
    if (!node) return;
    if (node->kind == Node::Kind::null) {
        out.reset();
        return;
    }
    if (node->kind != Node::Kind::object) {
        findings.error(node->place, "cam",
                       fmt::format("cam must be an object {{ … }}, or null for no cam, not {}", shown(*node)));
        return;
    }
    Fields f(findings, node, "cam");
    sim::Cam cam;
    if (const Node* centre = f.take("centre")) {
        std::vector<double> xy;
        if (f.list_value(*centre, "centre", dim::kLength, xy)) {
            if (xy.size() == 2)
                cam.centre = {xy[0], xy[1]};
            else
                f.fail(*centre, "centre", fmt::format("cam.centre must be two lengths [x, y], not {}", xy.size()));
        }
    }
    f.quantity("radius", dim::kLength, cam.radius);
    f.quantity("eccentricity", dim::kLength, cam.eccentricity);
    f.quantity("phase", dim::kAngle, cam.phase);
    f.quantity("speed", dim::kAngularSpeed, cam.speed);
    f.quantity("youngs_modulus", dim::kPressure, cam.youngs_modulus);
    f.quantity("poisson_ratio", dim::kNone, cam.poisson_ratio);
    f.finish();
    out = cam;
}

void read_friction(Findings& findings, const Node* node, sim::Friction& friction) {
    if (!node) return;
    enum class Type { none, coulomb, stick_slip };
    Fields f(findings, node, "contact.friction");
    if (!f.node()) return;
    Type type = Type::none;
    const Node* name = f.require("type", "\"none\"");
    if (!name ||
        !f.choice_value<Type>(
            *name, "type", {{"none", Type::none}, {"coulomb", Type::coulomb}, {"stick-slip", Type::stick_slip}}, type))
        return;
    switch (type) {
        case Type::none:
            friction = sim::NoFriction{};
            break;
        case Type::coulomb: {
            sim::CoulombFriction coulomb;
            f.quantity("coefficient", dim::kNone, coulomb.coefficient);
            f.quantity("slip_speed", dim::kSpeed, coulomb.slip_speed);
            friction = coulomb;
            break;
        }
        case Type::stick_slip: {
            sim::StickSlipFriction bristle;
            f.quantity("coefficient", dim::kNone, bristle.coefficient);
            f.quantity("static_coefficient", dim::kNone, bristle.static_coefficient);
            f.quantity("stiffness", dim::kSpringStiffness, bristle.stiffness);
            f.quantity("damping", dim::kSpringDamping, bristle.damping);
            friction = bristle;
            break;
        }
    }
    f.finish();
}

void read_approach_floor(Findings& findings, const Node* node, sim::ApproachFloor& floor) {
    if (!node) return;
    Fields f(findings, node, "contact.approach_floor");
    using Policy = sim::ApproachFloorPolicy;
    f.choice<Policy>("policy", {{"value", Policy::value}, {"first-touch", Policy::first_touch}}, floor.policy);
    f.quantity("value", dim::kSpeed, floor.value);
    f.finish();
}

void read_contact(Findings& findings, const Node* node, sim::Contact& contact) {
    if (!node) return;
    Fields f(findings, node, "contact");
    using sim::ContactModel;
    f.choice<ContactModel>("model",
                           {{name(ContactModel::compliant), ContactModel::compliant},
                            {name(ContactModel::restitution), ContactModel::restitution}},
                           contact.model);
    f.quantity("exponent", dim::kNone, contact.exponent);
    if (const Node* stiffness = f.take("stiffness")) {
        if (stiffness->kind == Node::Kind::string && stiffness->text == "hertz")
            contact.stiffness.reset();
        else
            f.value(*stiffness, "stiffness", dim::contact_stiffness(contact.exponent), contact.stiffness);
    }
    using sim::DampingLaw;
    f.choice<DampingLaw>("damping",
                         {{name(DampingLaw::none), DampingLaw::none},
                          {name(DampingLaw::hunt_crossley), DampingLaw::hunt_crossley},
                          {name(DampingLaw::lankarani_nikravesh), DampingLaw::lankarani_nikravesh},
                          {name(DampingLaw::herbert_mcwhannell), DampingLaw::herbert_mcwhannell},
                          {name(DampingLaw::lee_wang), DampingLaw::lee_wang},
                          {name(DampingLaw::gonthier), DampingLaw::gonthier},
                          {name(DampingLaw::flores), DampingLaw::flores},
                          {name(DampingLaw::hu_guo), DampingLaw::hu_guo},
                          {name(DampingLaw::zhang_sharf), DampingLaw::zhang_sharf}},
                         contact.damping);
    f.quantity("restitution", dim::kNone, contact.restitution);
    using sim::ImpactLaw;
    f.choice<ImpactLaw>("law",
                        {{name(ImpactLaw::newton), ImpactLaw::newton},
                         {name(ImpactLaw::poisson), ImpactLaw::poisson},
                         {name(ImpactLaw::stronge), ImpactLaw::stronge}},
                        contact.law);
    read_friction(findings, f.take("friction"), contact.friction);
    if (const Node* offset = f.take("offset")) {
        if (offset->kind == Node::Kind::string && offset->text == "half-depth")
            contact.offset.reset();
        else
            f.value(*offset, "offset", dim::kLength, contact.offset);
    }
    read_approach_floor(findings, f.take("approach_floor"), contact.approach_floor);
    f.quantity("collision_gap", dim::kTime, contact.collision_gap);
    f.finish();
}

void read_initial(Findings& findings, const Node* node, sim::Initial& initial) {
    if (!node) return;
    Fields f(findings, node, "initial");
    f.quantity("angle", dim::kAngle, initial.angle);
    f.quantity("angular_velocity", dim::kAngularSpeed, initial.angular_velocity);
    using sim::InitialShape;
    f.choice<InitialShape>("shape",
                           {{name(InitialShape::straight), InitialShape::straight},
                            {name(InitialShape::static_equilibrium), InitialShape::static_equilibrium},
                            {name(InitialShape::resting), InitialShape::resting}},
                           initial.shape);
    f.finish();
}

void read_solver(Findings& findings, const Node* node, sim::Solver& solver) {
    if (!node) return;
    Fields f(findings, node, "solver");
    using sim::Method;
    f.choice<Method>("method",
                     {{name(Method::automatic), Method::automatic},
                      {name(Method::exponential), Method::exponential},
                      {name(Method::rk8), Method::rk8},
                      {name(Method::cvode_adams), Method::cvode_adams},
                      {name(Method::cvode_bdf), Method::cvode_bdf},
                      {name(Method::arkode_erk), Method::arkode_erk}},
                     solver.method);
    f.quantity("rtol", dim::kNone, solver.rtol);
    f.quantity("atol", dim::kNone, solver.atol);
    f.whole("max_steps", 1, 2'000'000'000, solver.max_steps);
    f.finish();
}

constexpr double kLatestEnd = 1e12;  // [s]: a step of a millisecond is 16 digits less

void read_time(Findings& findings, const Node* node, double& end_time) {
    if (!node) return;
    Fields f(findings, node, "time");
    if (const Node* end = f.take("end"); end && f.value(*end, "end", dim::kTime, end_time)) {
        if (!(end_time > 0))
            f.fail(*end, "end",
                   fmt::format("time.end = {} s must be positive; write how many seconds to simulate", end_time));
        else if (end_time > kLatestEnd)
            f.fail(*end, "end",
                   fmt::format("time.end = {:g} s is beyond {:g} s, where steps are lost in the digits of time",
                               end_time, kLatestEnd));
    }
    f.finish();
}

}  // namespace

void read_physics(Findings& findings, Fields& root, Scene& scene) {
    sim::Problem& problem = scene.problem;
    read_hub(findings, root.take("hub"), problem.hub);
    read_beam(findings, root.take("beam"), problem.beam);
    read_cam(findings, root.take("cam"), problem.cam);
    read_contact(findings, root.take("contact"), problem.contact);
    root.quantity("gravity", dim::kAcceleration, problem.gravity);
    read_initial(findings, root.take("initial"), problem.initial);
    read_solver(findings, root.take("solver"), problem.solver);
    read_time(findings, root.take("time"), scene.end_time);
}

}  // namespace beamcam::scenes
