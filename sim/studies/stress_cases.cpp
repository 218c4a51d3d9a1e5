// The single hard cases and the random mixtures of the stress campaign, and the campaign as a whole.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/problem/problem.hpp"
#include "sim/studies/stress_builder.hpp"

namespace beamcam::sim {
namespace {

using std::numbers::pi;

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

// ---- single hard cases -------------------------------------------------------------------------------

void long_runs(CampaignBuilder& out, bool full) {
    {
        Problem p;  // the default scene for ten minutes
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        out.add_single("ten minutes, elastic", p, full ? 600 : 60);
        p.beam.model = ModelKind::first_order;
        p.contact.restitution = 0.7;
        out.add_single("ten minutes", p, full ? 600 : 10);
    }
    {
        Problem p;  // ten thousand impacts and more
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        p.contact.damping = DampingLaw::none;
        p.cam->speed = 0;
        p.initial.angle = touching_angle(p) + 0.005;
        out.add_single("10⁴ elastic impacts", p, full ? 1000 : 20);
        p.contact.model = ContactModel::restitution;
        out.add_single("10⁴ impulses", p, full ? 1000 : 20);
        p.contact.restitution = 0.999;
        out.add_single("chatter of many impulses", p, full ? 300 : 20);
    }
    {
        Problem p;  // 10⁵ periods of the first bending mode, undamped, in free flight
        p.cam.reset();
        p.gravity = 0;
        p.initial.angular_velocity = 1;
        p.hub.drive = TorqueTable{{0, 0.005, 0.01, 0.011}, {0, 5, 0, 0}};
        out.add_single("10⁵ periods of free vibration", p, full ? 1e5 * 2 * pi / kFirstBending : 10);
    }
}

void chatter_and_resonance(CampaignBuilder& out) {
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge}) {
        Problem p = base();
        p.contact.model = ContactModel::restitution;
        p.contact.law = law;
        p.contact.restitution = 0.5;
        p.beam.modes = 6;
        p.cam->speed = 3;
        out.at("chatter to rest", name(law));
        out.add("", p, 2);
    }
    {
        Problem p = base();
        p.cam->speed = kFirstBending;
        p.cam->eccentricity = 1e-3;
        approach(p);
        out.add_single("cam at the bending frequency", p, 0.3);
        p.hub.drive = HarmonicTorque{2, kFirstBending / (2 * pi), 0};
        p.cam.reset();
        out.add_single("torque at the bending frequency", p, 2);
    }
}

void slender_beams_and_needles(CampaignBuilder& out) {
    {
        Problem p = base();  // a hair that curls
        p.beam.second_moment = 1e-13;
        p.beam.area = 1e-6;
        p.beam.model = ModelKind::exact;
        p.beam.modes = 8;
        out.add_single("hair over the cam", p, 0.3);
        p.hub.drive = ConstantSpeed{-6};
        out.add_single("hair pulled over the cam", p, 0.3);
    }
    {
        Problem p = base();  // a very small cam
        p.cam->radius = 1e-6;
        p.cam->eccentricity = 0;
        p.cam->speed = 0;
        approach(p);
        out.add_single("needle of a micrometre", p);
        p.contact.stiffness = 1e12;
        out.add_single("hard needle of a micrometre", p);
        p.gravity = 0;
        p.initial.angular_velocity = -1e-9;
        p.initial.angle = touching_angle(p) + 1e-9;
        out.add_single("touch at a nanometre a second", p, 3);
    }
}

void loads_and_models(CampaignBuilder& out) {
    {
        Problem p = base();
        p.beam.damping_ratio = {50};
        out.add_single("overdamped fifty times", p);
        p.beam.damping_ratio.clear();
        p.beam.kelvin_voigt = 1;
        out.add_single("Kelvin–Voigt of a second", p);
        p.beam.kelvin_voigt.reset();
        p.gravity = 1e6;
        out.add_single("gravity 1e6 m/s²", p, 0.01);
        p.gravity = -9.81;
        out.add_single("gravity upwards", p);
        p.gravity = 0;
        p.initial.angular_velocity = 0;
        out.add_single("nothing moves", p);
    }
    for (const auto& model : names(ModelKind{})) {
        Problem p = base();
        p.beam.model = model.value;
        out.add_single("every model, one second", p, model.value == ModelKind::exact ? 0.2 : 1);
        p.beam.youngs_modulus = 1e8;
        out.add_single("every model, soft beam", p, 0.2);
    }
}

void single_cases(CampaignBuilder& out, bool full) {
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

void mixtures(CampaignBuilder& out) {
    out.grid("random mixtures of everything", "seed, tens", "seed, ones");
    for (unsigned seed = 0; seed < 500; ++seed) {
        Dice dice(seed);
        out.at(25 * (seed / 25), seed % 25);
        out.add(fmt::format("seed {}", seed), mixture(dice));
    }
}

}  // namespace

Campaign stress_campaign(bool full) {
    CampaignBuilder out;
    add_grids(out);
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
