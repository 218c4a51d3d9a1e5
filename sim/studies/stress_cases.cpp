#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "sim/problem/problem.hpp"
#include "sim/studies/stress.hpp"

namespace beamcam::sim {
namespace {

using std::numbers::pi;
constexpr double kUsualEnd = 0.06;       // [s] of a usual case: fall, strike, bounce
constexpr double kFirstBending = 816.9;  // [rad/s] of the free default beam

// The angle of a straight beam that touches the cam.
double lying_angle(const Problem& p) {
    const Vec2 disc = disc_centre(*p.cam, 0);
    return std::atan2(disc.y, disc.x) + std::asin(std::min(1.0, (p.cam->radius + contact_offset(p)) / norm(disc)));
}
void approach(Problem& p, double lead = 0.03, double speed = -2) {
    p.initial.angle = lying_angle(p) + lead;
    p.initial.angular_velocity = speed;
}
// The default system, with the beam 0.03 rad above the cam and approaching it.
Problem base() {
    Problem p;
    approach(p);
    return p;
}

// The budget of steps of a case. The cost of a step differs a thousandfold between models.
int budget(const Problem& p) {
    const double n = p.beam.modes;
    switch (p.beam.model) {
        case ModelKind::rigid:
            return 100000;
        case ModelKind::zeroth_order:
        case ModelKind::first_order:
        case ModelKind::paper:
            return static_cast<int>(std::max(8000.0, 50000 / (1 + n * n / 50)));
        case ModelKind::second_order:
        case ModelKind::exact:
            return static_cast<int>(std::max(2000.0, 30000 / (1 + n * n / 4)));
    }
    return 0;
}

class Builder {
  public:
    void grid(std::string title, std::string rows, std::string columns) {
        campaign_.grids.push_back({std::move(title), std::move(rows), std::move(columns), {}, {}});
    }
    // Adds a case to the last grid. Rows and columns are in the order of their first use.
    void add(const std::string& row, const std::string& column, const std::string& variant, const Problem& problem,
             double end = kUsualEnd) {
        CaseGrid& grid = campaign_.grids.back();
        StressCase one;
        one.grid = campaign_.grids.size() - 1;
        one.row = index(grid.rows, row);
        one.column = index(grid.columns, column);
        one.variant = variant;
        one.problem = problem;
        one.end = end;
        campaign_.cases.push_back(std::move(one));
    }
    // A single hard case.
    void add(const char* row, const Problem& problem, double end) {
        add(row, name(problem.beam.model), "", problem, end);
    }
    Campaign take() { return std::move(campaign_); }

  private:
    static std::size_t index(std::vector<std::string>& names, const std::string& name) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
        names.push_back(name);
        return names.size() - 1;
    }
    Campaign campaign_;
};

std::string power(double exponent) { return fmt::format("1e{:g}", exponent); }

// ---- the grids -------------------------------------------------------------------------------------

void stiffness_and_modes(Builder& out) {
    out.grid("contact stiffness and modes", "modes", "contact stiffness [N/m^1.5]");
    for (int modes : {1, 2, 3, 5, 8, 12, 20, 30, 40})
        for (int k = 2; k <= 12; ++k) {
            Problem p = base();
            p.beam.modes = modes;
            p.contact.stiffness = std::pow(10, k);
            out.add(fmt::to_string(modes), power(k), "first-order", p);
            p.beam.basis = Basis::cantilever;
            out.add(fmt::to_string(modes), power(k), "cantilever", p);
            if (modes > 12) continue;
            p.beam.basis = Basis::automatic;
            p.beam.model = modes % 2 ? ModelKind::second_order : ModelKind::exact;
            out.add(fmt::to_string(modes), power(k), name(p.beam.model), p, 0.03);
        }
}

void cam_speed_and_eccentricity(Builder& out) {
    out.grid("cam speed and eccentricity", "cam speed [rad/s]", "e/R");
    for (double speed : {-1000.0, -300.0, -100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0, 300.0, 1000.0})
        for (double share : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999999}) {
            Problem p = base();
            p.cam->speed = speed;
            p.cam->eccentricity = share * p.cam->radius;
            approach(p);
            const auto add = [&](const char* variant) {
                out.add(fmt::format("{:g}", speed), fmt::format("{:g}", share), variant, p);
            };
            add("first-order");
            p.contact.friction = CoulombFriction{0.3, 1e-3};
            p.contact.offset.reset();
            approach(p);
            add("friction");
            p.contact.model = ContactModel::restitution;
            add("restitution");
            p.beam.model = ModelKind::rigid;
            p.initial.shape = InitialShape::resting;
            add("resting");
        }
}

void tolerance_and_method(Builder& out) {
    out.grid("tolerance and method", "method", "rtol");
    for (const Method method :
         {Method::automatic, Method::rk8, Method::cvode_adams, Method::cvode_bdf, Method::arkode_erk})
        for (int k = 2; k <= 13; ++k) {
            Problem p = base();
            p.solver.method = method;
            p.solver.rtol = std::pow(10, -k);
            p.solver.atol = 1e-3 * p.solver.rtol;
            const auto add = [&](const char* variant) { out.add(name(method), power(-k), variant, p, 0.04); };
            add("first-order");
            p.contact.model = ContactModel::restitution;
            add("restitution");
            p.contact.model = ContactModel::compliant;
            p.contact.friction = StickSlipFriction{0.3, 0.5, {}, {}};
            p.contact.offset.reset();
            approach(p);
            add("stick-slip");
            p.beam.model = ModelKind::exact;
            p.contact.friction = NoFriction{};
            add("exact");
        }
}

void restitution_and_law(Builder& out) {
    out.grid("restitution and its law", "law", "pre-set restitution");
    for (double c : {0.0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0}) {
        const std::string column = fmt::format("{:g}", c);
        for (const auto& law : names(DampingLaw{}))
            for (double exponent : {1.0, 1.5, 2.0}) {
                Problem p = base();
                p.contact.restitution = c;
                p.contact.damping = law.value;
                p.contact.exponent = exponent;
                p.cam->speed = exponent < 1.2 ? 0 : 1;
                out.add(law.name, column, fmt::format("exponent {:g}", exponent), p);
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
                out.add(law.name, column, modes ? fmt::format("{} modes", modes) : "rigid", p);
            }
    }
}

void friction(Builder& out) {
    out.grid("friction", "kind", "coefficient");
    using Make = std::function<Friction(double mu)>;
    const auto coulomb = [](double slip_speed) -> Make {
        return [=](double mu) { return CoulombFriction{mu, slip_speed}; };
    };
    // `ratio`: static over kinetic coefficient.
    const auto bristle = [](double ratio, double stiffness, std::optional<double> damping) -> Make {
        return [=](double mu) { return StickSlipFriction{mu, ratio * mu, stiffness, damping}; };
    };
    struct Kind {
        const char* row;
        Make make;
        ContactModel model = ContactModel::compliant;
        ImpactLaw law = {};
    };
    const std::vector<Kind> kinds{
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
    for (const Kind& kind : kinds)
        for (double mu : {0.0, 0.01, 0.1, 0.3, 1.0, 2.0, 5.0}) {
            Problem p = base();
            p.contact.friction = kind.make(mu);
            p.contact.model = kind.model;
            p.contact.law = kind.law;
            const auto add = [&](const char* variant) { out.add(kind.row, fmt::format("{:g}", mu), variant, p); };
            p.cam->speed = 0;
            add("on the centre line, cam at rest");
            p.contact.offset.reset();
            p.cam->speed = 20;
            approach(p);
            add("half depth, cam turning");
            p.cam->speed = -20;
            p.hub.radius = 0.1;
            p.contact.offset = 0.05;
            approach(p);
            add("offset 5 cm, cam turning back");
            p.beam.model = ModelKind::rigid;
            p.cam->speed = 0;
            add("rigid, offset, cam at rest");
        }
}

void size_and_softness(Builder& out) {
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
            const auto add = [&](const char* variant) {
                out.add(fmt::format("{:g}", length), power(k), variant, p, end);
            };
            add("first-order");
            p.beam.model = ModelKind::exact;
            p.beam.modes = 4;
            add("exact");
            p.beam.model = ModelKind::second_order;
            p.contact.offset.reset();
            p.contact.friction = CoulombFriction{0.3, 1e-3};
            approach(p, 0.03, -2 / std::sqrt(length));
            add("second-order, friction");
        }
}

void hubs(Builder& out) {
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
            const auto add = [&](const char* variant) {
                out.add(fmt::format("{:g}", radius), fmt::format("{:g}", inertia), variant, p);
            };
            p.beam.modes = 4;
            add("hub-beam");
            p.beam.basis = Basis::cantilever;
            add("cantilever");
            p.beam.model = ModelKind::second_order;
            add("second-order");
        }
}

void starts_and_drives(Builder& out) {
    out.grid("start and drive", "start", "drive");
    struct Start {
        const char* row;
        std::function<void(Problem&)> set;
    };
    const std::vector<Start> starts{
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
        {"upright",
         [](Problem& p) {
             p.initial = {pi / 2, 0, InitialShape::straight};
         }},
        {"static", [](Problem& p) { p.initial.shape = InitialShape::static_equilibrium; }},
        {"resting", [](Problem& p) { p.initial.shape = InitialShape::resting; }},
        {"spinning at 300 rad/s", [](Problem& p) { p.initial.angular_velocity = -300; }},
        {"inside the cam", [](Problem& p) { approach(p, -0.01, 0); }},
    };
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
    for (const Start& start : starts)
        for (const Law& law : laws)
            for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact}) {
                Problem p = base();
                p.beam.model = kind;
                p.hub.drive = law.drive;
                start.set(p);
                out.add(start.row, law.column, name(kind), p);
                if (kind == ModelKind::exact) continue;
                p.contact.model = ContactModel::restitution;
                p.contact.friction = CoulombFriction{0.2, 1e-3};
                out.add(start.row, law.column, "restitution", p);
            }
}

// ---- single hard cases -------------------------------------------------------------------------------

void long_runs(Builder& out, bool full) {
    {
        Problem p;  // the default scene for ten minutes
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        out.add("ten minutes, elastic", p, full ? 600 : 60);
        p.beam.model = ModelKind::first_order;
        p.contact.restitution = 0.7;
        out.add("ten minutes", p, full ? 600 : 10);
    }
    {
        Problem p;  // ten thousand impacts and more
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        p.contact.damping = DampingLaw::none;
        p.cam->speed = 0;
        p.initial.angle = lying_angle(p) + 0.005;
        out.add("10⁴ elastic impacts", p, full ? 1000 : 20);
        p.contact.model = ContactModel::restitution;
        out.add("10⁴ impulses", p, full ? 1000 : 20);
        p.contact.restitution = 0.999;
        out.add("chatter of many impulses", p, full ? 300 : 20);
    }
    {
        Problem p;  // 10⁵ periods of the first bending mode, undamped, in free flight
        p.cam.reset();
        p.gravity = 0;
        p.initial.angular_velocity = 1;
        p.hub.drive = TorqueTable{{0, 0.005, 0.01, 0.011}, {0, 5, 0, 0}};
        out.add("10⁵ periods of free vibration", p, full ? 1e5 * 2 * pi / kFirstBending : 10);
    }
}

void chatter_and_resonance(Builder& out) {
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge}) {
        Problem p = base();
        p.contact.model = ContactModel::restitution;
        p.contact.law = law;
        p.contact.restitution = 0.5;
        p.beam.modes = 6;
        p.cam->speed = 3;
        out.add("chatter to rest", name(law), "", p, 2);
    }
    {
        Problem p = base();
        p.cam->speed = kFirstBending;
        p.cam->eccentricity = 1e-3;
        approach(p);
        out.add("cam at the bending frequency", p, 0.3);
        p.hub.drive = HarmonicTorque{2, kFirstBending / (2 * pi), 0};
        p.cam.reset();
        out.add("torque at the bending frequency", p, 2);
    }
}

void slender_beams_and_needles(Builder& out) {
    {
        Problem p = base();  // a hair that curls
        p.beam.second_moment = 1e-13;
        p.beam.area = 1e-6;
        p.beam.model = ModelKind::exact;
        p.beam.modes = 8;
        out.add("hair over the cam", p, 0.3);
        p.hub.drive = ConstantSpeed{-6};
        out.add("hair pulled over the cam", p, 0.3);
    }
    {
        Problem p = base();  // a very small cam
        p.cam->radius = 1e-6;
        p.cam->eccentricity = 0;
        p.cam->speed = 0;
        approach(p);
        out.add("needle of a micrometre", p, kUsualEnd);
        p.contact.stiffness = 1e12;
        out.add("hard needle of a micrometre", p, kUsualEnd);
        p.gravity = 0;
        p.initial.angular_velocity = -1e-9;
        p.initial.angle = lying_angle(p) + 1e-9;
        out.add("touch at a nanometre a second", p, 3);
    }
}

void loads_and_models(Builder& out) {
    {
        Problem p = base();
        p.beam.damping_ratio = {50};
        out.add("overdamped fifty times", p, kUsualEnd);
        p.beam.damping_ratio.clear();
        p.beam.kelvin_voigt = 1;
        out.add("Kelvin–Voigt of a second", p, kUsualEnd);
        p.beam.kelvin_voigt.reset();
        p.gravity = 1e6;
        out.add("gravity 1e6 m/s²", p, 0.01);
        p.gravity = -9.81;
        out.add("gravity upwards", p, kUsualEnd);
        p.gravity = 0;
        p.initial.angular_velocity = 0;
        out.add("nothing moves", p, kUsualEnd);
    }
    for (const auto& model : names(ModelKind{})) {
        Problem p = base();
        p.beam.model = model.value;
        out.add("every model, one second", p, model.value == ModelKind::exact ? 0.2 : 1);
        p.beam.youngs_modulus = 1e8;
        out.add("every model, soft beam", p, 0.2);
    }
}

void single_cases(Builder& out, bool full) {
    out.grid("single cases", "case", "model");
    long_runs(out, full);
    chatter_and_resonance(out);
    slender_beams_and_needles(out);
    loads_and_models(out);
}

// ---- random mixtures -----------------------------------------------------------------------------------

class Dice {
  public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double share() { return static_cast<double>(engine_()) / 4294967296.0; }
    double between(double low, double high) { return low + (high - low) * share(); }
    double decades(double low, double high) { return std::pow(10, between(low, high)); }
    int below(int count) { return static_cast<int>(share() * count); }
    bool one_in(int n) { return below(n) == 0; }
    template <class Enum>
    Enum one_of(std::span<const Named<Enum>> all) {
        return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))].value;
    }

  private:
    std::mt19937 engine_;
};

Problem mixture(Dice& dice) {
    Problem p;
    p.beam.model = dice.one_of(names(ModelKind{}));
    const bool costly = p.beam.model == ModelKind::exact || p.beam.model == ModelKind::second_order;
    p.beam.modes = 1 + dice.below(costly ? 8 : dice.one_in(4) ? 40 : 10);
    p.beam.basis = dice.one_of(names(Basis{}));
    p.beam.youngs_modulus = dice.decades(8, 12);
    if (dice.one_in(3)) p.beam.damping_ratio = {dice.decades(-4, 1)};
    p.hub.radius = dice.one_in(2) ? 0 : dice.between(-0.2, 0.5);
    p.hub.inertia = dice.one_in(2) ? 0 : dice.decades(-9, 6);
    p.cam->radius = dice.decades(-4, -0.8);
    p.cam->eccentricity = dice.one_in(4) ? 0 : p.cam->radius * dice.share();
    const double nearest = p.cam->radius + p.cam->eccentricity;
    p.cam->centre = {dice.between(nearest, std::max(1.1 * nearest, 1 + p.hub.radius + nearest)),
                     dice.between(-0.1, 0.1)};
    p.cam->phase = dice.between(-pi, pi);
    p.cam->speed = dice.one_in(3) ? 0 : (dice.one_in(2) ? 1 : -1) * dice.decades(-2, 3);
    p.contact.model = dice.one_in(3) ? ContactModel::restitution : ContactModel::compliant;
    p.contact.law = dice.one_of(names(ImpactLaw{}));
    p.contact.stiffness = dice.decades(4, 12);
    p.contact.exponent = dice.between(1, 2);
    p.contact.damping = dice.one_of(names(DampingLaw{}));
    p.contact.restitution = dice.share();
    if (dice.one_in(3)) p.contact.friction = CoulombFriction{dice.between(0, 5), dice.decades(-6, 0)};
    if (dice.one_in(3)) p.contact.friction = StickSlipFriction{dice.between(0, 2), {}, dice.decades(2, 9), {}};
    if (dice.one_in(3)) p.contact.offset = dice.decades(-4, -1.3);
    p.gravity = dice.one_in(5) ? 0 : dice.decades(-1, 2);
    p.solver.rtol = dice.decades(-12, -2);
    p.solver.atol = 1e-3 * p.solver.rtol;
    approach(p, dice.decades(-9, -1), -dice.decades(-3, 1));
    if (dice.one_in(8)) p.initial.shape = InitialShape::resting;
    if (dice.one_in(8)) p.hub.drive = ConstantTorque{dice.between(-10, 10)};
    if (dice.one_in(8)) p.hub.drive = ConstantSpeed{dice.between(-10, 10)};
    return p;
}

void mixtures(Builder& out) {
    out.grid("random mixtures of everything", "seed, tens", "seed, ones");
    for (unsigned seed = 0; seed < 500; ++seed) {
        Dice dice(seed);
        out.add(fmt::format("{}", 25 * (seed / 25)), fmt::format("{}", seed % 25), fmt::format("seed {}", seed),
                mixture(dice));
    }
}

}  // namespace

Campaign stress_campaign(bool full) {
    Builder out;
    stiffness_and_modes(out);
    cam_speed_and_eccentricity(out);
    tolerance_and_method(out);
    restitution_and_law(out);
    friction(out);
    size_and_softness(out);
    hubs(out);
    starts_and_drives(out);
    mixtures(out);
    single_cases(out, full);
    Campaign campaign = out.take();
    for (StressCase& one : campaign.cases)
        if (one.grid + 1 != campaign.grids.size()) one.problem.solver.max_steps = budget(one.problem);
    if (!full) {
        // Eleven has no common factor with the sizes of the grids, so that every row and column is included.
        std::vector<StressCase> some;
        for (std::size_t i = 0; i < campaign.cases.size(); ++i)
            if (i % 11 == 0 || campaign.cases[i].grid + 1 == campaign.grids.size())
                some.push_back(std::move(campaign.cases[i]));
        campaign.cases = std::move(some);
    }
    return campaign;
}

}  // namespace beamcam::sim
