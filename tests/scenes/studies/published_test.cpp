// Published and closed-form numbers, scene in, number out: the program itself, as its users run it, or the library
// function behind it where a scene cannot pose the question. `published.json` holds the numbers with their sources;
// the check of each entry must read all of its numbers, or it fails.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

#include "sim/beam/model.hpp"
#include "sim/beam/shapes.hpp"
#include "sim/contact/impulse.hpp"
#include "sim/studies/paper.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using Json = nlohmann::ordered_json;
using testing::Finished, testing::Folder, testing::shell;

constexpr double kPi = std::numbers::pi;

// ---- the numbers ---------------------------------------------------------------------------------

const Json& published() {
    static const Json table = [] {
        std::ifstream in(BEAMCAM_TEST_DIR "/scenes/published.json");
        return Json::parse(in);
    }();
    return table;
}

bool is_number(const Json& leaf) {
    if (leaf.is_number()) return true;
    return leaf.is_string() && leaf.get<std::string>().find_first_not_of("0123456789.-+e") == std::string::npos;
}

// One entry of the table; records which of its numbers were read.
class Entry {
  public:
    explicit Entry(const std::string& key) : table_(published().at(key)) {}
    double number(const std::string& pointer) {
        const Json& leaf = table_.at(Json::json_pointer(pointer));
        used_.insert(&leaf);
        return leaf.is_string() ? std::stod(leaf.get<std::string>()) : leaf.get<double>();
    }
    std::vector<double> numbers(const std::string& pointer) {
        std::vector<double> all;
        for (std::size_t i = 0; i < size(pointer); ++i) all.push_back(number(fmt::format("{}/{}", pointer, i)));
        return all;
    }
    std::size_t size(const std::string& pointer) const { return table_.at(Json::json_pointer(pointer)).size(); }
    bool has(const std::string& pointer) const { return table_.contains(Json::json_pointer(pointer)); }
    const Json& operator[](const std::string& key) const { return table_.at(key); }

    // Numbers that were not read.
    std::vector<std::string> forgotten() const {
        std::vector<std::string> all;
        walk(table_, "", all);
        return all;
    }

  private:
    void walk(const Json& node, const std::string& path, std::vector<std::string>& all) const {
        if (node.is_structured()) {
            for (const auto& [key, child] : node.items())
                if (key != "digits") walk(child, path + "/" + key, all);
        } else if (is_number(node) && !used_.count(&node)) {
            all.push_back(path);
        }
    }
    const Json& table_;
    std::set<const Json*> used_;
};

// ---- the program ---------------------------------------------------------------------------------

std::string ask(const std::string& command, const Json& scene, const std::string& options) {
    const Folder folder;
    folder.write("s.json", scene.dump());
    const Finished finished = shell(folder, fmt::format("$BEAMCAM {} s.json -q {}", command, options));
    EXPECT_EQ(finished.code, 0) << finished.err;
    return finished.out;
}

Json summary(const Json& scene) { return Json::parse(ask("simulate", scene, "--summary -")); }
Json impacts(const Json& scene) { return Json::parse(ask("simulate", scene, "--impacts -")).at("impacts"); }

std::vector<double> column(const std::string& csv) {  // the second one
    std::istringstream rows(csv);
    std::vector<double> values;
    std::string line;
    std::getline(rows, line);
    while (std::getline(rows, line)) values.push_back(std::stod(line.substr(line.find(',') + 1)));
    return values;
}
std::vector<double> series(const Json& scene, const std::string& channel, const std::string& times) {
    return column(ask("simulate", scene, "--times " + times + " --channels " + channel));
}

// Natural frequencies in units of √(EI/ρAL⁴) of a beam for which that unit is 1 rad/s; NaN where stiffness is lost.
Json unit_beam(int modes) {
    return {{"cam", nullptr},
            {"beam", {{"area", 1}, {"second_moment", 1}, {"density", 1}, {"youngs_modulus", 1}, {"modes", modes}}}};
}
std::vector<double> frequencies(const Json& scene, const std::string& options = "") {
    std::vector<double> omega;
    const Json answer = Json::parse(ask("modes", scene, "--json " + options));
    for (const Json& mode : answer.at("modes"))
        omega.push_back(mode.at("omega").is_null() ? std::nan("") : mode.at("omega").get<double>());
    return omega;
}

// ---- the checks ----------------------------------------------------------------------------------

void paper_beam(Entry& table) {
    const sim::Beam beam = testing::read("{}").scene->problem.beam;
    EXPECT_EQ(beam.length, table.number("/L"));
    EXPECT_EQ(beam.area, table.number("/A"));
    EXPECT_EQ(beam.second_moment, table.number("/I"));
    EXPECT_EQ(beam.density, table.number("/rho"));
    EXPECT_EQ(beam.youngs_modulus, table.number("/E"));
}

void clamped_free_eigenvalues(Entry& table) {
    const std::vector<double> beta = table.numbers("/betaL"), sigma = table.numbers("/sigma");
    const Json answer = Json::parse(ask("modes", unit_beam(static_cast<int>(beta.size())), "--json --speed 0"));
    for (std::size_t i = 0; i < beta.size(); ++i) {
        const Json& mode = answer.at("modes").at(i);
        EXPECT_NEAR(std::sqrt(mode.at("omega").get<double>()), beta[i], 1e-12 * beta[i]);
        if (i >= sigma.size()) continue;
        // ±y = cosh βx − cos βx − σ(sinh βx − sin βx) in the middle of the beam; the sign makes the tip positive.
        const double x = 0.5 * beta[i], y = (i % 2 ? -1 : 1) * mode.at("shape").at(50).at(1).get<double>();
        EXPECT_NEAR((std::cosh(x) - std::cos(x) - y) / (std::sinh(x) - std::sin(x)), sigma[i], 1e-11);
    }
}

void hinged_free_eigenvalues(Entry& table) {
    const std::vector<double> beta = table.numbers("/betaL");
    const std::vector<double> omega = frequencies(unit_beam(static_cast<int>(beta.size())));
    for (std::size_t i = 0; i < beta.size(); ++i) EXPECT_NEAR(std::sqrt(omega[i]), beta[i], 1e-12 * beta[i]);
}

// The matrices of the first-order model at the straight beam hold them: M_Θq = ∫(a+x)φ, and the centrifugal
// stiffness ∫[a(1−x) + ½(1−x²)]φ′φ′ᵀ − ∫φφᵀ.
void clamped_mode_integrals(Entry& table) {
    sim::Problem p = testing::read(unit_beam(4).dump()).scene->problem;
    p.beam.basis = sim::Basis::cantilever;
    p.hub.radius = 0;
    const sim::Linearization at_axis = sim::make_model(p)->linearize();
    p.hub.radius = 1;
    const sim::Linearization off_axis = sim::make_model(p)->linearize();
    const auto check = [&](const char* pointer, auto&& value) {
        const std::vector<double> row = table.numbers(pointer);
        for (std::size_t i = 0; i < row.size(); ++i)
            EXPECT_NEAR(value(static_cast<Eigen::Index>(i + 1)), row[i], 1e-12 * row.back()) << pointer;
    };
    check("/int_phi", [&](auto i) { return std::fabs(off_axis.mass(i, 0) - at_axis.mass(i, 0)); });
    check("/int_x_phi", [&](auto i) { return std::fabs(at_axis.mass(i, 0)); });
    check("/D_diagonal_int_half(1-x^2)phi'phi'", [&](auto i) { return at_axis.centrifugal(i, i) + 1; });
    check("/D0_diagonal_int_(1-x)phi'phi'",
          [&](auto i) { return off_axis.centrifugal(i, i) - at_axis.centrifugal(i, i); });
    double phi[4];
    sim::Shapes::cantilever(4, 1).evaluate(1, phi, nullptr, nullptr);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(std::fabs(phi[i]), 2, 1e-13);
}

void hub_beam_free_modes(Entry& table) {
    for (std::size_t row = 0; row < table.size("/rows"); ++row) {
        const std::string at = fmt::format("/rows/{}", row);
        Json scene = unit_beam(3);
        scene["hub"] = {{"radius", table.number(at + "/a~1L")}, {"inertia", table.number(at + "/h")}};
        const std::vector<double> values = table.numbers(at + "/values"), omega = frequencies(scene);
        for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(omega[i], values[i], 1e-12 * values[i]);
    }
    Json two = unit_beam(2);
    two["beam"]["basis"] = "cantilever";
    const std::vector<double> values = table.numbers("/two_cantilever_modes_a0_h0"), omega = frequencies(two);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(omega[i], values[i], 5e-8);  // as many digits are printed
}

void rotating_cantilever(Entry& table) {
    Json scene = unit_beam(14);
    scene["beam"]["model"] = "exact";  // polynomials converge faster than modes of the resting beam
    for (std::size_t row = 0; row < table.size("/rows"); ++row) {
        const std::string at = fmt::format("/rows/{}", row);
        const double speed = table.number(at + "/gamma");
        const std::vector<double> flapwise = table.numbers(at + "/flapwise"),
                                  omega = frequencies(scene, fmt::format("--speed {}", speed));
        for (std::size_t i = 0; i < flapwise.size(); ++i)
            EXPECT_NEAR(std::hypot(omega[i], speed), flapwise[i], 5e-9 * flapwise[i])
                << speed;  // nine digits are trusted
        const std::string chordwise = fmt::format("/chordwise_first/{}", speed);
        if (!table.has(chordwise)) continue;
        EXPECT_NEAR(omega[0], table.number(chordwise), 1e-8);
    }
    const double limit = table.number("/zeroth_order_divergence_gamma");
    Json zeroth = unit_beam(2);
    zeroth["beam"]["model"] = "zeroth-order";
    EXPECT_NEAR(std::hypot(frequencies(zeroth, "--speed 3")[0], 3), limit, 1e-9);
    EXPECT_FALSE(std::isnan(frequencies(zeroth, fmt::format("--speed {}", limit * (1 - 1e-9)))[0]));
    EXPECT_TRUE(std::isnan(frequencies(zeroth, fmt::format("--speed {}", limit * (1 + 1e-9)))[0]));
}

void spin_up(Entry& table) {
    const auto scene = [](const std::string& model, double speed, int modes, double end) -> Json {
        return {{"cam", nullptr},
                {"gravity", 0},
                {"initial", {{"angle", 0}}},
                {"hub", {{"drive", {{"type", "prescribed"}, {"law", "spin-up"}, {"speed", speed}, {"duration", 15}}}}},
                {"beam", {{"length", 8}, {"density", 2766.67}, {"modes", modes}, {"model", model}}},
                {"time", {{"end", end}}}};
    };
    for (std::size_t row = 0; row < table.size("/rows"); ++row) {
        const std::string at = fmt::format("/rows/{}", row);
        const Json posed =
            scene("first-order", table.number(at + "/Os"), static_cast<int>(table.number(at + "/modes")), 15);
        const Json tip = summary(posed).at("extrema").at("tip_deflection");
        EXPECT_NEAR(tip.at("min").get<double>(), table.number(at + "/tip_peak"), 2e-8) << row;
        EXPECT_NEAR(tip.at("t_min").get<double>(), table.number(at + "/t_peak"), 2e-5) << row;
        if (!table.has(at + "/tip_5s")) continue;
        const std::vector<double> on_the_way = series(posed, "tip_deflection", "5,10");
        EXPECT_NEAR(on_the_way[0], table.number(at + "/tip_5s"), 6e-8) << row;
        EXPECT_NEAR(on_the_way[1], table.number(at + "/tip_10s"), 6e-8) << row;
    }
    // The classical linear model: "bounded at 2.9 rad/s, diverges at 3.0 (threshold 2.9108)".
    ASSERT_EQ(table["zeroth_order"], "bounded at 2.9 rad/s, diverges at 3.0 (threshold 2.9108)");
    const auto largest = [&](double speed, double end) {
        const Json tip = summary(scene("zeroth-order", speed, 2, end)).at("extrema").at("tip_deflection");
        return std::max(-tip.at("min").get<double>(), tip.at("max").get<double>());
    };
    EXPECT_LT(largest(2.9, 60), 1.2 * largest(2.9, 30));
    EXPECT_GT(largest(3.0, 60), 1e6 * largest(3.0, 15));
    const Json still = scene("zeroth-order", 1, 2, 1);
    EXPECT_FALSE(std::isnan(frequencies(still, "--speed 2.91075")[0]));
    EXPECT_TRUE(std::isnan(frequencies(still, "--speed 2.91085")[0]));
}

Json falling(const std::string& model, double gravity, double end) {
    return {{"cam", nullptr},
            {"beam", {{"model", model}}},
            {"gravity", gravity},
            {"solver", {{"rtol", 1e-13}, {"atol", 1e-16}}},
            {"time", {{"end", end}}}};
}

void rigid_rod_fall(Entry& table) {
    for (const char* gravity : {"9.81", "9.80665"}) {
        const Json zero = summary(falling("rigid", std::stod(gravity), 0.4)).at("events").at("theta_zero").at(0);
        const double time = table.number(fmt::format("/time_to_horizontal/{}", gravity));
        EXPECT_NEAR(zero.at("t").get<double>(), time, 1e-13);
        EXPECT_NEAR(sim::rod_fall_time(1, std::stod(gravity), kPi / 4, 1), time, 1e-14);
        if (gravity != std::string("9.81")) continue;
        EXPECT_NEAR(zero.at("theta_dot").get<double>(), table.number("/rate_at_horizontal_9.81"), 1e-12);
    }
    // Twice the torque of gravity is twice the gravity.
    const Json doubled = summary(falling("rigid", 19.62, 0.3)).at("events").at("theta_zero").at(0);
    EXPECT_NEAR(doubled.at("t").get<double>(), table.number("/doubled_torque_9.81"), 1e-12);
    EXPECT_NEAR(sim::rod_fall_time(1, 9.81, kPi / 4, 2), table.number("/doubled_torque_9.81"), 1e-12);
}

void flexible_fall(Entry& table) {
    for (std::size_t row = 0; row < table.size("/rows"); ++row) {
        const std::string at = fmt::format("/rows/{}", row);
        Json scene = falling("first-order", 9.81, 0.4);
        scene["beam"]["basis"] = "cantilever";
        scene["beam"]["modes"] = table.number(at + "/modes");
        scene["solver"] = {{"rtol", 1e-11}, {"atol", 1e-14}};
        const Json zero = summary(scene).at("events").at("theta_zero").at(0);
        EXPECT_NEAR(zero.at("t").get<double>(), table.number(at + "/t_theta_zero"), 1e-9);
        if (table.has(at + "/theta_dot")) {
            EXPECT_NEAR(zero.at("theta_dot").get<double>(), table.number(at + "/theta_dot"), 5e-8);
        }
        // The published largest deflections are the largest of samples 20 µs apart; the true ones lie 1e-9 m above.
        scene["time"]["end"] = 0.36999;
        const std::vector<double> tip = column(ask("simulate", scene, "--rate 5e4 --channels tip_deflection"));
        const double largest = *std::max_element(tip.begin(), tip.end()), published_tip = table.number(at + "/tip_max");
        EXPECT_NEAR(largest, published_tip, 5e-12);
        const double exact = summary(scene).at("extrema").at("tip_deflection").at("max").get<double>();
        EXPECT_GE(exact, largest);
        EXPECT_NEAR(exact, largest, 3e-9);
    }
    // A free rod bends about +ρAgL⁴cos θ/(80EI), a clamped one to −ρAgL⁴cos θ/(8EI).
    const sim::Beam beam;
    const double unit = beam.line_density() * 9.81 / beam.bending_stiffness();
    ASSERT_EQ(table["mean_tip_deflection_free_rod"], "+rhoA g L^4 cos(theta)/(80 EI)");
    Json damped = falling("first-order", 9.81, 0.1);
    damped["beam"].update({{"modes", 12}, {"damping_ratio", 0.2}});
    damped["solver"] = {{"rtol", 1e-8}, {"atol", 1e-11}};
    const double theta = series(damped, "theta", "0.05")[0];
    EXPECT_NEAR(series(damped, "tip_deflection", "0.05")[0] / (unit * std::cos(theta) / 80), 1, 0.02);
    ASSERT_EQ(table["clamped_rod"], "-rhoA g L^4 cos(theta)/(8 EI)");
    Json clamped = falling("first-order", 9.81, 0.1);
    clamped["beam"]["modes"] = 12;
    clamped["hub"]["drive"] = {{"type", "prescribed"}, {"law", "constant"}, {"speed", 0}};
    clamped["initial"] = {{"shape", "static"}, {"angle", 0}};
    EXPECT_NEAR(series(clamped, "tip_deflection", "0")[0] / (-unit / 8), 1, 1e-5);
}

// A rigid rod swings without gravity onto a tiny disc at rest: the contact point moves on a straight line
// up to terms of θ² ~ (R/D)² = 1e-8 (the lever only sets the mass that strikes).
Json strike(const Json& contact, double speed, double density = 2766.7) {
    return {{"gravity", 0},
            {"beam", {{"model", "rigid"}, {"density", density}}},
            {"cam", {{"centre", {0.5, 0}}, {"radius", 1e-4}, {"eccentricity", 0}, {"speed", 0}}},
            {"contact", contact},
            {"initial", {{"angle", 0.001}, {"angular_velocity", -speed / 0.5}}},
            {"solver", {{"rtol", 1e-12}, {"atol", 1e-18}}},
            {"time", {{"end", 20}}}};
}

void hertz_impact(Entry& table) {
    for (const char* exponent : {"1", "1.5"}) {
        const Json hit = impacts(strike({{"damping", "none"}, {"exponent", std::stod(exponent)}}, 1e-4)).at(0);
        EXPECT_NEAR(hit.at("duration").get<double>() * -hit.at("v_n_before").get<double>() /
                        hit.at("penetration_peak").get<double>(),
                    table.number(fmt::format("/T_v0_over_delta_max/n={}", exponent)), 3e-7);
    }
    // 1 kg at 1 m/s on 1e8 N/m^1.5: at a hundredth of the speed depth, force and duration scale as v^0.8, v^1.2,
    // v^−0.2; so shallow a touch stays straight. The rod's inertia seen at its middle is ρA/3/0.5².
    const double v = 1e-4;
    const Json hit = impacts(strike({{"damping", "none"}}, v, 0.75 / 7.2968e-5)).at(0);
    const double straight = 5e-7;  // what the disc's roundness leaves
    const auto scaled = [&](const char* key, double power) {
        return hit.at(key).get<double>() / std::pow(-hit.at("v_n_before").get<double>(), power);
    };
    const double depth = table.number("/m1_K1e8_v1_n1.5/delta_max"), force = table.number("/m1_K1e8_v1_n1.5/F_max"),
                 duration = table.number("/m1_K1e8_v1_n1.5/duration");
    EXPECT_NEAR(scaled("penetration_peak", 0.8), depth, straight * depth);
    EXPECT_NEAR(scaled("force_peak", 1.2), force, straight * force);
    EXPECT_NEAR(scaled("duration", -0.2), duration, straight * duration);
}

void effective_restitution(Entry& table) {
    const std::vector<double> preset = table.numbers("/preset");
    const std::map<std::string, sim::DampingLaw> laws{{"hunt-crossley", sim::DampingLaw::hunt_crossley},
                                                      {"lankarani-nikravesh", sim::DampingLaw::lankarani_nikravesh},
                                                      {"herbert-mcwhannell", sim::DampingLaw::herbert_mcwhannell},
                                                      {"lee-wang", sim::DampingLaw::lee_wang},
                                                      {"gonthier", sim::DampingLaw::gonthier},
                                                      {"flores", sim::DampingLaw::flores},
                                                      {"hu-guo", sim::DampingLaw::hu_guo},
                                                      {"zhang-sharf", sim::DampingLaw::zhang_sharf}};
    const auto struck = [&](const std::string& law, double c) {
        return impacts(strike({{"damping", law}, {"restitution", c}, {"approach_floor", {{"value", 1e-9}}}}, 1e-4))
            .at(0)
            .at("restitution")
            .get<double>();
    };
    for (std::size_t i = 0; i < preset.size(); ++i)
        for (const auto& [law, kind] : laws) {
            const double d = sim::damping_factor(kind, preset[i]);
            if (law == "zhang-sharf") {
                EXPECT_NEAR(d, table.number(fmt::format("/zhang-sharf_D/{}", i)), 1e-12);
            }
            const double e = law == "zhang-sharf" ? preset[i] : table.number(fmt::format("/{}/{}", law, i));
            // The balance of energy that relates both, D(1 + e) = ln((1 + D)/(1 − eD)).
            EXPECT_NEAR(std::log1p(d) - std::log1p(-e * d), d * (1 + e), 1e-12) << law;
            EXPECT_NEAR(struck(law, preset[i]), e, 2e-7) << law;
        }
    EXPECT_NEAR(struck("none", 0.5), 1, 2e-7);
}

// Free slender rod m = L = 1, lower end down at `angle` to the surface, its centre on the +t side.
sim::Compliance free_rod(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {1 + 3 * c * c, -3 * s * c, 1 + 3 * s * s};
}

void oblique_rigid_impact(Entry& table) {
    const double jam = table.number("/jam_friction_at_tan(angle to surface)=2");
    for (const auto law : {sim::ImpactLaw::newton, sim::ImpactLaw::poisson, sim::ImpactLaw::stronge}) {
        for (std::size_t row = 0; row < table.size("/rows"); ++row) {
            const std::string at = fmt::format("/rows/{}", row);
            const std::vector<double> expected = table.numbers(at + "/result");
            const sim::ImpactResult r = sim::resolve_impact(free_rod(kPi / 4), -1, table.number(at + "/v_t"),
                                                            table.number(at + "/mu"), 0.5, law);
            EXPECT_NEAR(r.v_t, expected[0], 1e-14);
            EXPECT_NEAR(r.v_n, expected[1], 1e-14);
            EXPECT_NEAR(r.impulse_t, expected[2], 1e-14);
            EXPECT_NEAR(r.impulse_n, expected[3], 1e-14);
        }
        // Sliding so fast that it never stops: below the friction of jamming the impulse is that of the approach,
        // above it grows with the speed of sliding until that is used up.
        const auto impulse = [&](double mu, double v_t) {
            return sim::resolve_impact(free_rod(std::atan(2.0)), -1, -v_t, mu, 0.5, law).impulse_n;
        };
        EXPECT_NEAR(impulse(jam * (1 - 1e-6), 1e9), impulse(jam * (1 - 1e-6), 2e9),
                    1e-9 * impulse(jam * (1 - 1e-6), 1e9));
        EXPECT_NEAR(impulse(jam * (1 + 1e-6), 2e9) / impulse(jam * (1 + 1e-6), 1e9), 2, 1e-2);
    }
}

void cam_following(Entry& table) {
    for (std::size_t row = 0; row < table.size("/rows"); ++row) {
        const std::string at = fmt::format("/rows/{}", row);
        const double critical = table.number(at + "/omega");
        const auto scene = [&](double speed) -> Json {
            return {{"beam", {{"model", "rigid"}}},
                    {"cam", {{"eccentricity", table.number(at + "/e")}, {"speed", speed}}},
                    {"contact", {{"model", "restitution"}}},
                    {"initial", {{"shape", "resting"}}},
                    {"solver", {{"rtol", 1e-11}, {"atol", 1e-14}}},
                    {"time", {{"end", 0.4}}}};
        };
        EXPECT_TRUE(impacts(scene(critical - 1e-6)).at(0).at("t_end").is_null());
        const double speed = critical + 1e-6;  // 6e-8 of it: the minimum of the force is passed by √ of the excess
        const double t = impacts(scene(speed)).at(0).at("t_end").get<double>();
        EXPECT_NEAR(2 * kPi - speed * t, 2.14809539, 1e-3);  // the table's note
        const std::string when = fmt::format("{:.17g}", t);
        EXPECT_NEAR(series(scene(speed), "theta", when)[0], table.number(at + "/theta"), 1e-4);
        EXPECT_NEAR(series(scene(speed), "contact_x", when)[0], table.number(at + "/x"), 1e-4);
    }
}

// A very long hinged rod strikes at two thirds of its length, `lever`: that point falls with g on what is, within
// (height/lever)² of itself, a straight line.
constexpr double kDisc = 1.0;
Json ball(double lever, double height, double restitution, double eccentricity, double speed, double phase,
          double end) {
    return {{"beam", {{"model", "rigid"}, {"length", 1.5 * lever}}},
            {"cam",
             {{"centre", {lever, -kDisc}},
              {"radius", kDisc},
              {"eccentricity", eccentricity},
              {"speed", speed},
              {"phase", phase}}},
            {"contact", {{"model", "restitution"}, {"restitution", restitution}}},
            {"initial", {{"angle", height / lever}}},
            {"solver", {{"rtol", 1e-11}, {"atol", 1e-11 * height / lever}}},
            {"time", {{"end", end}}}};
}

// On a table z = A sin ωt with Γ = Aω²/g the ball can strike once a period, at the phase with cos φ = π(1−r)/((1+r)Γ):
// it must arrive with V = πg/ω and leave with V, so the table moves with V(1−r)/(1+r) (Holmes 1982).
struct Bounces {
    std::vector<double> intervals, phases;  // in periods; [rad]
    double phase = 0;                       // of the orbit of period one
};
Bounces bounces(double gamma, double r, int periods, double lever = 1e6) {
    const double amplitude = 1e-2, omega = std::sqrt(gamma * 9.81 / amplitude), period = 2 * kPi / omega;
    Bounces b;
    b.phase = std::acos(std::min(1.0, kPi * (1 - r) / ((1 + r) * gamma)));
    // From the top of its flight, half a period after a bounce, a little too high.
    const double speed = kPi * 9.81 / omega, height = amplitude * std::sin(b.phase) + 1.003 * speed * period / 4;
    const Json list = impacts(ball(lever, height, r, amplitude, -omega, b.phase + kPi, periods * period));
    for (std::size_t i = 0; i < list.size(); ++i) {
        b.phases.push_back(std::remainder(list.at(i).at("cam_angle").get<double>(), 2 * kPi));
        if (i > 0)
            b.intervals.push_back(
                (list.at(i).at("t_start").get<double>() - list.at(i - 1).at("t_start").get<double>()) / period);
    }
    return b;
}

void bouncing_ball(Entry& table) {
    const std::vector<double> times = table.numbers("/h1_e0.8_impacts");
    const Json list = impacts(ball(1e6, 1, 0.8, 0, 0, 0, 4.5));
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(list.at(i).at("t_start").get<double>(), times[i], 1e-11);
    for (const char* e : {"0.5", "0.8"}) {
        // The bounces below 1e-4 m/s are summed up: rest begins at their point of accumulation.
        const double zeno = table.number(fmt::format("/zeno/e={}", e)), r = std::stod(e);
        const Json rest = impacts(ball(1e6, 1, r, 0, 0, 0, zeno + 0.1)).back();
        EXPECT_TRUE(rest.at("t_end").is_null());
        EXPECT_NEAR(rest.at("t_start").get<double>(), zeno, 1e-9);
    }
    const double r = 0.5, exists = table.number("/vibrating_table_r0.5_Gamma/exists"),
                 doubles = table.number("/vibrating_table_r0.5_Gamma/doubles");
    // No orbit below: the ball comes to rest on the table, Zeno's way (and rests better on a shorter lever, whose
    // rounding is less). Just above it stays, at its phase.
    EXPECT_LT(bounces(0.999 * exists, r, 120, 1e4).intervals.back(), 0.9);
    for (double gamma : {1.001 * exists, 1.3, 0.99 * doubles}) {
        const Bounces regular = bounces(gamma, r, 300);
        ASSERT_GT(regular.intervals.size(), 290u) << gamma;
        for (std::size_t i = regular.intervals.size() - 10; i < regular.intervals.size(); ++i) {
            EXPECT_NEAR(regular.intervals[i], 1, 1e-7) << gamma;
            EXPECT_NEAR(regular.phases[i], regular.phase, 1e-6) << gamma;
        }
    }
    const Bounces alternating = bounces(1.005 * doubles, r, 300);
    for (std::size_t i = alternating.intervals.size() - 10; i + 2 < alternating.intervals.size(); ++i) {
        EXPECT_GT(std::fabs(alternating.intervals[i] - 1), 0.01);
        EXPECT_NEAR(alternating.intervals[i] + alternating.intervals[i + 1], 2, 1e-4);
        EXPECT_NEAR(alternating.intervals[i], alternating.intervals[i + 2], 1e-4);
    }
}

void simple_pendulum(Entry& table) {
    // A point mass on a metre of string from rest at x = −1 is a rod of 1.5 m watched at one metre.
    Json scene = falling("rigid", 9.81, 1);
    scene["beam"]["length"] = 1.5;
    scene["initial"]["angle"] = kPi;
    EXPECT_NEAR(std::cos(series(scene, "theta", fmt::format("{}", table.number("/t")))[0]), table.number("/x"), 1e-11);
    // It passes the lowest point after one, three, five quarters of a period.
    const double period = table.number("/period");
    for (double quarter : {0.25, 0.75, 1.25})
        EXPECT_NEAR(series(scene, "theta", fmt::format("{:.17g}", quarter * period))[0], 1.5 * kPi, 1e-11);
}

const std::map<std::string, std::function<void(Entry&)>> kChecks{
    {"paper_beam", paper_beam},
    {"clamped_free_eigenvalues", clamped_free_eigenvalues},
    {"hinged_free_eigenvalues", hinged_free_eigenvalues},
    {"clamped_mode_integrals_unit_length", clamped_mode_integrals},
    {"hub_beam_free_modes", hub_beam_free_modes},
    {"rotating_cantilever", rotating_cantilever},
    {"spin_up", spin_up},
    {"rigid_rod_fall", rigid_rod_fall},
    {"flexible_fall", flexible_fall},
    {"hertz_impact", hertz_impact},
    {"effective_restitution", effective_restitution},
    {"oblique_rigid_impact", oblique_rigid_impact},
    {"cam_following", cam_following},
    {"bouncing_ball", bouncing_ball},
    {"simple_pendulum", simple_pendulum}};

class Published : public ::testing::TestWithParam<std::string> {};

TEST_P(Published, NumbersAreReproducedEveryOne) {
    Entry entry(GetParam());
    kChecks.at(GetParam())(entry);
    EXPECT_THAT(entry.forgotten(), ::testing::IsEmpty());
}

std::vector<std::string> checked() {
    std::vector<std::string> keys;
    for (const auto& [key, check] : kChecks) keys.push_back(key);
    return keys;
}
INSTANTIATE_TEST_SUITE_P(Of, Published, ::testing::ValuesIn(checked()), [](const auto& key) { return key.param; });

TEST(PublishedTable, HasACheckForEveryEntry) {
    std::vector<std::string> keys;
    for (const auto& [key, entry] : published().items())
        if (key != "about") keys.push_back(key);
    EXPECT_THAT(checked(), ::testing::UnorderedElementsAreArray(keys));
}

}  // namespace
}  // namespace beamcam::scenes
