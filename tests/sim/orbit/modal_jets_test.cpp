// The vector field in jets against System: its values, and differences for its derivatives.
#include "sim/orbit/modal_jets.hpp"

#include "sim/base/numerics.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kJetTime = 0.1;

struct JetCase {
    const char* name;
    ModelKind model = ModelKind::first_order;
    Basis basis = Basis::automatic;
    Friction friction = NoFriction{};
    Phase phase = {};
    Drive drive = FreeDrive{};
    std::optional<Profile> profile = {};
};

Problem problem_of(const JetCase& c) {
    Problem p;
    p.beam.model = c.model;
    p.beam.basis = c.basis;
    p.beam.modes = 3;
    p.beam.damping_ratio = {0.01};
    p.hub = {0.05, 0.02, c.drive};
    p.cam->speed = 12;
    p.contact.model = c.phase.held ? ContactModel::restitution : ContactModel::compliant;
    p.contact.friction = c.friction;
    p.contact.offset = 0.02;
    if (!c.profile) return p;
    p.cam->profile = c.profile;
    p.hub.spring = {3, -0.2, 0.1};
    if (!c.phase.held) p.contact.stiffness.reset();  // Hertz's, which changes along the outline
    return p;
}

// A bent beam in motion, with this gap.
std::vector<double> state_with(System& system, double gap) {
    const int n = system.coordinates();
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    for (int i = 1; i < n; ++i) {
        y[static_cast<std::size_t>(i)] = 2e-3 / (i * i);
        y[static_cast<std::size_t>(n + i)] = 0.3 / i;
    }
    y[static_cast<std::size_t>(n)] = -0.7;
    if (system.has_bristle()) y[static_cast<std::size_t>(2 * n)] = 1e-6;
    system.set_phase({});
    const auto excess = [&](double angle) {
        y[0] = angle;
        return system.contact(kJetTime, y.data()).gap - gap;
    };
    if (!system.drive().prescribed()) y[0] = find_root(excess, 0.05, 1.2);
    return y;
}

// ξ̈ and ż of System.
Vector field(System& system, const Phase& phase, const std::vector<double>& y) {
    std::vector<double> dy(y.size());
    system.set_phase(phase);
    system.rhs(kJetTime, y.data(), dy.data());
    const int n = system.coordinates();
    return Eigen::Map<const Vector>(dy.data() + n, n + (system.has_bristle() ? 1 : 0));
}

void expect_the_same_field(const JetCase& c) {
    SCOPED_TRACE(c.name);
    System system(problem_of(c));
    const int n = system.coordinates();
    std::vector<double> y = state_with(system, c.phase.held ? 0 : -1e-5);
    const Vector values = field(system, c.phase, y);
    const ContactState near = system.contact(kJetTime, y.data());
    ModalJets jets(system);
    JetState s(system, kJetTime, y.data(), c.phase);
    for (int i = 0; i < n; ++i) {  // eight directions
        s.xi[static_cast<std::size_t>(i)].d[i] = 1;
        s.rate[static_cast<std::size_t>(i)].d[n + i] = 1;
    }
    std::vector<Jet> out;
    Jet bristle_rate;
    jets.flow(s, c.phase, near, out, bristle_rate);
    if (system.has_bristle()) out.push_back(bristle_rate);
    for (std::size_t r = 0; r < out.size(); ++r)
        EXPECT_NEAR(out[r].v, values[static_cast<Eigen::Index>(r)], 1e-9 * values.norm()) << "row " << r;
    const bool driven = system.drive().prescribed();
    for (int k = 0; k < 2 * n; ++k) {
        if (driven && k % n == 0) continue;
        const Vector column = slope_at_zero(
            [&](double h) {
                std::vector<double> z = y;
                z[static_cast<std::size_t>(k)] += h;
                return field(system, c.phase, z);
            },
            k < n ? 1e-7 : 1e-4);
        for (std::size_t r = 0; r < out.size(); ++r)
            EXPECT_NEAR(out[r].d[k], column[static_cast<Eigen::Index>(r)], 1e-6 * (column.norm() + values.norm()))
                << "row " << r << ", column " << k;
    }
}

TEST(ModalJets, GiveTheVectorFieldAndItsDerivatives) {
    using enum ModelKind;
    const Phase flight, touch{.touching = true, .approach = 5}, held{.touching = true, .held = true},
        slides{.touching = true, .approach = 5, .friction = FrictionState::slide_plus};
    const CoulombFriction rough{0.3, 0.05};
    const StickSlipFriction sticky{0.3, {}, 2e4};
    for (const JetCase& c :
         {JetCase{"flight"}, JetCase{"flight of a clamped shape", first_order, Basis::cantilever},
          JetCase{"touch", first_order, Basis::automatic, NoFriction{}, touch},
          JetCase{"rigid", rigid, Basis::automatic, rough, touch},
          JetCase{"zeroth-order", zeroth_order, Basis::automatic, rough, touch},
          JetCase{"clamped shapes", first_order, Basis::cantilever, rough, touch},
          JetCase{"stick", first_order, Basis::automatic, sticky, touch},
          JetCase{"slide", first_order, Basis::automatic, sticky, slides},
          JetCase{"held", first_order, Basis::automatic, NoFriction{}, held},
          JetCase{"held with friction", first_order, Basis::automatic, rough, held},
          JetCase{"held and rigid", rigid, Basis::automatic, rough, held},
          JetCase{"held, clamped shapes", first_order, Basis::cantilever, rough, held},
          JetCase{"profile", first_order, Basis::automatic, rough, touch, {}, lift_and_return()},
          JetCase{"profile, slide", first_order, Basis::automatic, sticky, slides, {}, tangent_arcs()},
          JetCase{"profile, held", first_order, Basis::automatic, rough, held, {}, lift_and_return()},
          JetCase{"driven", first_order, Basis::automatic, NoFriction{}, flight, ConstantSpeed{2}}})
        expect_the_same_field(c);
}

}  // namespace
}  // namespace beamcam::sim::testing
