// The grids of the stress campaign: two parameters each, with several variants in each cell.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "sim/problem/problem.hpp"
#include "sim/studies/stress_builder.hpp"

namespace beamcam::sim {
namespace {

using std::numbers::pi;

std::string power(double exponent) { return fmt::format("1e{:g}", exponent); }

void stiffness_and_modes(CampaignBuilder& out) {
    out.grid("contact stiffness and modes", "modes", "contact stiffness [N/m^1.5]");
    for (int modes : {1, 2, 3, 5, 8, 12, 20, 30, 40})
        for (int k = 2; k <= 12; ++k) {
            Problem p = base();
            p.beam.modes = modes;
            p.contact.stiffness = std::pow(10, k);
            out.at(modes, power(k));
            out.add("first-order", p);
            p.beam.basis = Basis::cantilever;
            out.add("cantilever", p);
            if (modes > 12) continue;
            p.beam.basis = Basis::automatic;
            p.beam.model = modes % 2 ? ModelKind::second_order : ModelKind::exact;
            out.add(name(p.beam.model), p, 0.03);
        }
}

void cam_speed_and_eccentricity(CampaignBuilder& out) {
    out.grid("cam speed and eccentricity", "cam speed [rad/s]", "e/R");
    for (double speed : {-1000.0, -300.0, -100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0, 300.0, 1000.0})
        for (double share : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999999}) {
            Problem p = base();
            p.cam->speed = speed;
            p.cam->eccentricity = share * p.cam->radius;
            approach(p);
            out.at(speed, share);
            out.add("first-order", p);
            p.contact.friction = CoulombFriction{0.3, 1e-3};
            p.contact.offset.reset();
            approach(p);
            out.add("friction", p);
            p.contact.model = ContactModel::restitution;
            out.add("restitution", p);
            p.beam.model = ModelKind::rigid;
            p.initial.shape = InitialShape::resting;
            out.add("resting", p);
        }
}

void tolerance_and_method(CampaignBuilder& out) {
    out.grid("tolerance and method", "method", "rtol");
    for (const Method method :
         {Method::automatic, Method::rk8, Method::cvode_adams, Method::cvode_bdf, Method::arkode_erk})
        for (int k = 2; k <= 13; ++k) {
            Problem p = base();
            p.solver.method = method;
            p.solver.rtol = std::pow(10, -k);
            p.solver.atol = 1e-3 * p.solver.rtol;
            constexpr double kEnd = 0.04;
            out.at(name(method), power(-k));
            out.add("first-order", p, kEnd);
            p.contact.model = ContactModel::restitution;
            out.add("restitution", p, kEnd);
            p.contact.model = ContactModel::compliant;
            p.contact.friction = StickSlipFriction{0.3, 0.5, {}, {}};
            p.contact.offset.reset();
            approach(p);
            out.add("stick-slip", p, kEnd);
            p.beam.model = ModelKind::exact;
            p.contact.friction = NoFriction{};
            out.add("exact", p, kEnd);
        }
}

void restitution_and_law(CampaignBuilder& out) {
    out.grid("restitution and its law", "law", "pre-set restitution");
    for (double c : {0.0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0}) {
        for (const auto& law : names(DampingLaw{}))
            for (double exponent : {1.0, 1.5, 2.0}) {
                Problem p = base();
                p.contact.restitution = c;
                p.contact.damping = law.value;
                p.contact.exponent = exponent;
                p.cam->speed = exponent < 1.2 ? 0 : 1;
                out.at(law.name, c);
                out.add(fmt::format("exponent {:g}", exponent), p);
            }
        for (const auto& law : names(ImpactLaw{}))
            for (int modes : {0, 2, 8}) {
                Problem p = base();
                p.contact.model = ContactModel::restitution;
                p.contact.law = law.value;
                p.contact.restitution = c;
                p.cam->speed = modes == 8 ? 0 : 5;
                if (modes == 0)
                    p.beam.model = ModelKind::rigid;
                else
                    p.beam.modes = modes;
                out.at(law.name, c);
                out.add(modes ? fmt::format("{} modes", modes) : "rigid", p);
            }
    }
}

struct FrictionKind {
    const char* row;
    std::function<Friction(double mu)> make;
    ContactModel model = ContactModel::compliant;
    ImpactLaw law = {};
};

std::vector<FrictionKind> friction_kinds() {
    const auto coulomb = [](double slip_speed) { return [=](double mu) { return CoulombFriction{mu, slip_speed}; }; };
    // `ratio`: static over kinetic coefficient.
    const auto bristle = [](double ratio, double stiffness, std::optional<double> damping) {
        return [=](double mu) { return StickSlipFriction{mu, ratio * mu, stiffness, damping}; };
    };
    return {
        {"coulomb 1e-6 m/s", coulomb(1e-6)},
        {"coulomb 1e-3 m/s", coulomb(1e-3)},
        {"coulomb 1 m/s", coulomb(1)},
        {"stick-slip",
         [](double mu) {
             return StickSlipFriction{mu, {}, {}, {}};
         }},
        {"bristle soft", bristle(2, 1e2, 1.0)},
        {"bristle hard", bristle(1.5, 1e9, {})},
        {"dashpot tiny", bristle(1, 1e6, 1e-6)},
        {"dashpot large", bristle(1.2, 1e5, 1e3)},
        {"newton", coulomb(1e-3), ContactModel::restitution, ImpactLaw::newton},
        {"poisson", coulomb(1e-3), ContactModel::restitution, ImpactLaw::poisson},
        {"stronge", coulomb(1e-3), ContactModel::restitution, ImpactLaw::stronge},
    };
}

void friction(CampaignBuilder& out) {
    out.grid("friction", "kind", "coefficient");
    for (const FrictionKind& kind : friction_kinds())
        for (double mu : {0.0, 0.01, 0.1, 0.3, 1.0, 2.0, 5.0}) {
            Problem p = base();
            p.contact.friction = kind.make(mu);
            p.contact.model = kind.model;
            p.contact.law = kind.law;
            p.cam->speed = 0;
            out.at(kind.row, mu);
            out.add("on the centre line, cam at rest", p);
            p.contact.offset.reset();
            p.cam->speed = 20;
            approach(p);
            out.add("half depth, cam turning", p);
            p.cam->speed = -20;
            p.hub.radius = 0.1;
            p.contact.offset = 0.05;
            approach(p);
            out.add("offset 5 cm, cam turning back", p);
            p.beam.model = ModelKind::rigid;
            p.cam->speed = 0;
            out.add("rigid, offset, cam at rest", p);
        }
}

void size_and_softness(CampaignBuilder& out) {
    out.grid("size and softness", "length [m]", "Young's modulus [Pa]");
    for (double length : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0})
        for (int k = 6; k <= 13; ++k) {
            // All lengths of the default system in proportion; density and gravity are unchanged.
            Problem p;
            p.beam.length = length;
            p.beam.area *= length * length;
            p.beam.second_moment *= std::pow(length, 4);
            p.beam.depth *= length;
            p.beam.youngs_modulus = std::pow(10, k);
            p.cam->centre = length * p.cam->centre;
            p.cam->radius *= length;
            p.cam->eccentricity *= length;
            p.contact.stiffness.reset();  // Hertz
            p.solver.atol = 1e-11 * length;
            approach(p, 0.03, -2 / std::sqrt(length));
            const double end = kUsualEnd * std::sqrt(length);
            out.at(length, power(k));
            out.add("first-order", p, end);
            p.beam.model = ModelKind::exact;
            p.beam.modes = 4;
            out.add("exact", p, end);
            p.beam.model = ModelKind::second_order;
            p.contact.offset.reset();
            p.contact.friction = CoulombFriction{0.3, 1e-3};
            approach(p, 0.03, -2 / std::sqrt(length));
            out.add("second-order, friction", p, end);
        }
}

void hubs(CampaignBuilder& out) {
    out.grid("hub", "radius a [m]", "inertia [kg m²]");
    for (double radius : {-0.9, -0.5, -0.1, 0.0, 0.1, 1.0, 10.0})
        for (double inertia : {0.0, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6}) {
            Problem p = base();
            p.hub.radius = radius;
            p.hub.inertia = inertia;
            // The cam is under the middle of the part of the beam beyond the axis.
            const double from = std::max(0.0, radius), to = radius + p.beam.length;
            p.cam->centre = {0.5 * (from + to), 0};
            p.cam->radius = 0.2 * (to - from);
            p.cam->eccentricity = 0.1 * p.cam->radius;
            if (radius <= 0 && p.cam->radius + p.cam->eccentricity >= p.cam->centre.x) continue;
            approach(p);
            out.at(radius, inertia);
            p.beam.modes = 4;
            out.add("hub-beam", p);
            p.beam.basis = Basis::cantilever;
            out.add("cantilever", p);
            p.beam.model = ModelKind::second_order;
            out.add("second-order", p);
        }
}

struct StartCase {
    const char* row;
    std::function<void(Problem&)> set;
};

std::vector<StartCase> start_cases() {
    return {
        {"on the cam", [](Problem& p) { approach(p, 0, 0); }},
        {"1e-12 above", [](Problem& p) { approach(p, 1e-12, 0); }},
        {"at 1 m/s onto it", [](Problem& p) { approach(p, 0, -4); }},
        {"at the tip",
         [](Problem& p) {
             p.cam->centre = {1.0, 0};
             approach(p);
         }},
        {"grazing the tip",
         [](Problem& p) {
             p.cam->centre = {1.0 + p.cam->radius - 1e-7, 0};
             p.cam->eccentricity = 0;
             p.initial = {0.06, -2, InitialShape::straight};
         }},
        {"upside down", [](Problem& p) { p.initial.angle = pi + 0.5; }},
        {"upright", [](Problem& p) { p.initial.angle = pi / 2, p.initial.angular_velocity = 0; }},
        {"static", [](Problem& p) { p.initial.shape = InitialShape::static_equilibrium; }},
        {"resting", [](Problem& p) { p.initial.shape = InitialShape::resting; }},
        {"spinning at 300 rad/s", [](Problem& p) { p.initial.angular_velocity = -300; }},
        {"inside the cam", [](Problem& p) { approach(p, -0.01, 0); }},
    };
}

void starts_and_drives(CampaignBuilder& out) {
    out.grid("start and drive", "start", "drive");
    struct Law {
        const char* column;
        Drive drive;
    };
    const std::vector<Law> laws{{"free", FreeDrive{}},
                                {"torque 100 N m", ConstantTorque{-100}},
                                {"resonant torque", HarmonicTorque{1, kFirstBending / (2 * pi), 0}},
                                {"torque table", TorqueTable{{0, 0.01, 0.010001, 0.03}, {0, 5, -5, 0}}},
                                {"speed −2", ConstantSpeed{-2}},
                                {"spin-up", SpinUp{20, 0.05}},
                                {"angle table", AngleTable{{0, 0.02, 0.04, 0.06}, {0.6, 0.55, 0.6, 0.45}}}};
    for (const StartCase& start : start_cases())
        for (const Law& law : laws)
            for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact}) {
                Problem p = base();
                p.beam.model = kind;
                p.hub.drive = law.drive;
                start.set(p);
                out.at(start.row, law.column);
                out.add(name(kind), p);
                if (kind == ModelKind::exact) continue;
                p.contact.model = ContactModel::restitution;
                p.contact.friction = CoulombFriction{0.2, 1e-3};
                out.add("restitution", p);
            }
}

}  // namespace

void add_grids(CampaignBuilder& out) {
    stiffness_and_modes(out);
    cam_speed_and_eccentricity(out);
    tolerance_and_method(out);
    restitution_and_law(out);
    friction(out);
    size_and_softness(out);
    hubs(out);
    starts_and_drives(out);
}

}  // namespace beamcam::sim
