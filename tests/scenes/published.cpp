// Published and closed-form numbers, scene in, number out: the program itself, as its users run it.
// Sources: the table of public numbers that the project was given (each recomputed independently there):
// rigid and flexible fall, spin-up (Kane, Ryan & Banerjee 1987), Hertz impact, effective restitution of
// the dissipation laws, cam following, IFToMM's pendulum.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished;
using testing::Folder;
using testing::shell;

// The number after `key` in a JSON text, from the first place where all of `path` has gone by.
double number(const std::string& text, std::initializer_list<const char*> path) {
    std::size_t at = 0;
    for (const char* key : path) {
        const std::string quoted = fmt::format("\"{}\":", key);
        at = text.find(quoted, at);
        if (at == std::string::npos) {
            ADD_FAILURE() << key << " is missing in " << text.substr(0, 400);
            return std::nan("");
        }
        at += quoted.size();
    }
    return std::strtod(text.c_str() + at + text.substr(at).find_first_not_of(" \n[{"), nullptr);
}

std::string simulate(const std::string& scene, const std::string& options) {
    const Folder folder;
    folder.write("s.json", scene);
    const Finished finished = shell(folder, "$BEAMCAM simulate s.json -q " + options);
    EXPECT_EQ(finished.code, 0) << finished.err;
    return finished.out;
}

TEST(Published, RigidRodFall) {
    for (const auto& [gravity, time] :
         std::map<double, double>{{9.81, 0.369998497559697}, {9.80665, 0.370061688819225}}) {
        const std::string out = simulate(fmt::format(R"({{"cam": null, "beam": {{"model": "rigid"}}, "gravity": {},
            "solver": {{"rtol": 1e-13, "atol": 1e-16}}, "time": {{"end": 0.4}}}})",
                                                     gravity),
                                         "--summary -");
        EXPECT_NEAR(number(out, {"theta_zero", "t"}), time, 1e-12);
        if (gravity == 9.81) {
            EXPECT_NEAR(number(out, {"theta_zero", "theta_dot"}), -4.56181461376064, 1e-11);
        }
    }
}

TEST(Published, FlexibleFall) {
    // Until the beam is horizontal, in the frame of the root tangent; eight digits are trusted.
    const auto run = [](int modes, double end) {
        return simulate(fmt::format(R"({{"cam": null, "beam": {{"basis": "cantilever", "modes": {}}},
            "solver": {{"rtol": 1e-11, "atol": 1e-14}}, "time": {{"end": {:.12f}}}}})",
                                    modes, end),
                        "--summary -");
    };
    const std::string one = run(1, 0.4), two = run(2, 0.4);
    EXPECT_NEAR(number(one, {"theta_zero", "t"}), 0.369995468, 1e-9);
    EXPECT_NEAR(number(two, {"theta_zero", "t"}), 0.369993889, 1e-9);
    EXPECT_NEAR(number(two, {"theta_zero", "theta_dot"}), -4.5753468, 5e-8);
    // The published largest deflections are the largest of samples 20 µs apart; the true ones lie 1e-9 m above.
    for (const auto& [modes, published] : std::map<int, double>{{1, 6.778986e-05}, {2, 7.474911e-05}}) {
        const Folder folder;
        folder.write("s.json", fmt::format(R"({{"cam": null, "beam": {{"basis": "cantilever", "modes": {}}},
            "solver": {{"rtol": 1e-11, "atol": 1e-14}}, "time": {{"end": 0.36999}}}})",
                                           modes));
        std::istringstream rows(shell(folder, "$BEAMCAM simulate s.json -q --rate 5e4 --channels tip_deflection").out);
        double largest = 0;
        std::string line;
        std::getline(rows, line);
        for (; std::getline(rows, line);) largest = std::max(largest, std::stod(line.substr(line.find(',') + 1)));
        EXPECT_NEAR(largest, published, 5e-12);
        const double exact = number(run(modes, 0.36999), {"extrema", "tip_deflection", "max"});
        EXPECT_GE(exact, largest);
        EXPECT_NEAR(exact, largest, 3e-9);
    }
}

TEST(Published, SpinUp) {
    struct Row {
        double speed;
        int modes;
        double t_peak, tip_peak;
    };
    for (const Row& row : {Row{0.5, 6, 7.18801, -0.07132505}, Row{4, 2, 6.76126, -0.53383089},
                           Row{4, 4, 6.76549, -0.53437274}, Row{4, 6, 6.76567, -0.53439386}}) {
        const std::string scene = fmt::format(R"({{"cam": null, "gravity": 0, "initial": {{"angle": 0}},
            "hub": {{"drive": {{"type": "prescribed", "law": "spin-up", "speed": {}, "duration": 15}}}},
            "beam": {{"length": 8, "density": 2766.67, "modes": {}}}, "time": {{"end": 15}}}})",
                                              row.speed, row.modes);
        const std::string out = simulate(scene, "--summary -");
        EXPECT_NEAR(number(out, {"extrema", "tip_deflection", "min"}), row.tip_peak, 2e-8)
            << row.speed << " " << row.modes;
        EXPECT_NEAR(number(out, {"extrema", "tip_deflection", "t_min"}), row.t_peak, 2e-5);
    }
}

TEST(Published, Pendulum) {
    // A point mass on a metre of string from rest at x = −1 is a rod of 1.5 m watched at one metre.
    const std::string out =
        simulate(R"({"cam": null, "beam": {"model": "rigid", "length": 1.5}, "initial": {"angle": "180 deg"},
        "solver": {"rtol": 1e-13, "atol": 1e-16}})",
                 "--times 9.99 --channels theta");
    const double theta = std::stod(out.substr(out.find('\n') + out.substr(out.find('\n')).find(',') + 1));
    EXPECT_NEAR(std::cos(theta), -0.3164364699130323, 1e-11);
}

// A rigid rod swings without gravity onto a tiny disc at rest: the contact point moves on a straight line
// up to terms of θ² ~ (R/D)² = 1e-8 (the lever only sets the mass that strikes).
std::string strike(const std::string& contact, double speed) {
    return simulate(fmt::format(R"({{"gravity": 0, "beam": {{"model": "rigid"}},
        "cam": {{"centre": [0.5, 0], "radius": 1e-4, "eccentricity": 0, "speed": 0}},
        "contact": {{{}}}, "initial": {{"angle": 0.001, "angular_velocity": {:.17g}}},
        "solver": {{"rtol": 1e-12, "atol": 1e-18}}, "time": {{"end": 20}}}})",
                                contact, -speed / 0.5),
                    "--impacts -");
}

TEST(Published, EffectiveRestitutionOfEveryLaw) {
    const std::map<std::string, std::array<double, 3>> table{
        {"hunt-crossley", {0.6629622000015, 0.7679997890785, 0.9090157413492}},
        {"lankarani-nikravesh", {0.7252411140102, 0.7959725953653, 0.9131766778056}},
        {"herbert-mcwhannell", {0.59362426004, 0.7226826490879, 0.9008929856761}},
        {"lee-wang", {0.7991987821936, 0.8693431103471, 0.9523701528204}},
        {"gonthier", {0.4877412560153, 0.6695813197483, 0.8764354238618}},
        {"flores", {0.4704447793267, 0.6831841997307, 0.8939206926634}},
        {"hu-guo", {0.4877412560153, 0.6972969680609, 0.8998999430722}},
        {"zhang-sharf", {0.5, 0.7, 0.9}},
        {"none", {1, 1, 1}}};
    for (const auto& [law, published] : table)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string out = strike(fmt::format(R"("damping": "{}", "restitution": {},
                "approach_floor": {{"value": 1e-9}})",
                                                       law, std::array{0.5, 0.7, 0.9}[i]),
                                           1e-4);
            EXPECT_NEAR(number(out, {"restitution"}), published[i], 2e-7) << law;
        }
}

TEST(Published, HertzImpact) {
    for (const auto& [exponent, ratio] : std::map<double, double>{{1, 3.141592653589793}, {1.5, 2.9432751843247047}}) {
        const std::string out =
            strike(fmt::format(R"("damping": "none", "exponent": {}, "stiffness": 1e8)", exponent), 1e-4);
        EXPECT_NEAR(number(out, {"duration"}) * -number(out, {"v_n_before"}) / number(out, {"penetration_peak"}), ratio,
                    3e-7);
    }
}

TEST(Published, CamFollowing) {
    // The smallest speed at which the normal force of the following rod vanishes: 17.153238 rad/s at e = 10 mm.
    const auto first = [](double speed) {
        return simulate(fmt::format(R"({{"beam": {{"model": "rigid"}}, "cam": {{"eccentricity": 0.01, "speed": {}}},
            "contact": {{"model": "restitution"}}, "initial": {{"shape": "resting"}}, "solver": {{"rtol": 1e-11, "atol": 1e-14}},
            "time": {{"end": 0.5}}}})",
                                    speed),
                        "--impacts -");
    };
    EXPECT_NE(first(17.15323).find("\"t_end\": null"), std::string::npos);
    const std::string lifted = first(17.15325);
    const double t = number(lifted, {"t_end"});
    EXPECT_NEAR(2 * 3.14159265358979 - 17.15325 * t, 2.14809539, 3e-3);  // the minimum is flat: √ of the excess speed
}

}  // namespace
}  // namespace beamcam::scenes
