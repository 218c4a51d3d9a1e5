// The figure "series": any channels, of one motion or of several.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "output/data/table_reader.hpp"
#include "render/base/error.hpp"
#include "render/draw/markup.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/beam/modes.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using testing::Finished;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::shell;

// The figure of the first output of a scene.
Figure figure_of(const std::string& output, const std::string& mechanics = "") {
    return testing::simulated("{" + mechanics +
                              R"("time": {"end": 0.4}, "outputs": [{"type": "figure", "figure": "series", )" + output +
                              "}]}");
}

double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }

// The least and the largest of the values that are no gaps.
std::ranges::minmax_result<double> range_of(std::vector<double> values) {
    std::erase_if(values, [](double v) { return std::isnan(v); });
    return std::ranges::minmax(values);
}

TEST(Series, HasAPanelForEachUnit) {
    const Figure figure = figure_of(R"("channels": ["theta", "contact_force", "tip_deflection", "q1"])");
    ASSERT_EQ(figure.panels.size(), 3u);
    EXPECT_EQ(figure.panels[0].y.label, "$θ$ / rad");
    EXPECT_EQ(figure.panels[1].y.label, "$F$ / N");
    EXPECT_EQ(figure.panels[2].y.label, "$v$, $q_{1}$ / mm");
    EXPECT_EQ(figure.panels[2].series.size(), 2u);
    EXPECT_EQ(figure.panels[2].x.label, "$t$ / s");
    for (const auto& panel : figure.panels) EXPECT_NO_THROW(render::parse_markup(panel.y.label));
}

// Axes, measured data and the phase portrait have the units in which the scene states angles and speeds; --low and
// --high are in SI units in any scene.
TEST(Series, HasTheUnitsOfTheScene) {
    const char* mechanics = R"("cam": {"speed": "30 rpm"}, "initial": {"angle": "60 deg"},)";
    const Figure figure =
        figure_of(R"("panels": [{"channels": ["theta"], "high": 1.5}, {"channels": ["theta_dot"]}])", mechanics);
    EXPECT_EQ(figure.panels[0].y.label, "$θ$ / °");
    EXPECT_NEAR(figure.panels[0].series[0].y.front(), 60, 1e-9);
    EXPECT_NEAR(figure.panels[0].y.to.value(), 1.5 * 180 / M_PI, 1e-9);
    EXPECT_EQ(figure.panels[1].y.label, "$\\dot{θ}$ / rpm");
    EXPECT_LT(largest(figure.panels[1].series[0].x), 0.5);
    const Figure over = figure_of(R"("channels": ["theta_dot"], "x": "theta")", mechanics);
    EXPECT_EQ(over.panels[0].x.label, "$θ$ / °");
    EXPECT_NEAR(over.panels[0].series[0].x.front(), 60, 1e-9);
    const Figure phase = testing::simulated(
        R"({"cam": {"speed": "30 rpm"}, "initial": {"angle": "60 deg"}, "time": {"end": 0.4},
            "outputs": [{"type": "figure", "figure": "phase"}]})");
    EXPECT_EQ(phase.panels[0].x.label, "$θ$ / °");
    EXPECT_EQ(phase.panels[0].y.label, "$\\dot{θ}$ / rpm");
    EXPECT_NEAR(phase.panels[0].series[0].x.front(), 60, 0.1);
}

// Between equally spaced rows, 0.2 ms apart, its peaks would be cut off.
TEST(Series, CurvesReachTheTrueExtremes) {
    const Figure figure = figure_of(R"("channels": ["contact_force"])");
    const Reading reading = testing::read(R"({"time": {"end": 0.4}})");
    sim::Request request;
    request.end_time = 0.4;
    request.extrema = {{sim::ChannelKind::contact_force, 0}};
    const double peak = sim::simulate(reading.scene->problem, request).extrema.front().max;
    EXPECT_NEAR(largest(figure.panels[0].series[0].y), peak, 5e-3 * peak);
}

TEST(Series, RunsAgainstTurnsOrAChannel) {
    const Figure turns = figure_of(R"("channels": ["theta"], "x": "turns", "from": 0.1)", R"("cam": {"speed": -5},)");
    EXPECT_EQ(turns.panels[0].x.label, "turns of the cam");
    EXPECT_NEAR(turns.panels[0].series[0].x.front(), 0.1 * 5 / (2 * M_PI), 1e-12);
    EXPECT_NEAR(turns.panels[0].series[0].x.back(), 0.4 * 5 / (2 * M_PI), 1e-12);
    const Figure phase = figure_of(R"("channels": ["theta_dot"], "x": "theta")");
    EXPECT_EQ(phase.panels[0].x.label, "$θ$ / rad");
    EXPECT_EQ(phase.panels[0].y.label, "$\\dot{θ}$ / (rad s^{−1})");
    EXPECT_NEAR(phase.panels[0].series[0].x.front(), M_PI / 4, 1e-9);
}

TEST(Series, ComparesMotions) {
    const Figure figure = figure_of(
        R"("channels": ["theta"], "compare": [{"label": "flexible"}, {"label": "rigid", "set": {"beam.model": "rigid"}}])");
    ASSERT_EQ(figure.panels[0].series.size(), 2u);
    EXPECT_EQ(figure.panels[0].series[0].label, "flexible");
    EXPECT_EQ(figure.panels[0].series[1].label, "rigid");
    EXPECT_EQ(figure.title, "Hub angle $θ$");
}

TEST(Series, CoincidingCurvesHaveOneLook) {
    const Figure figure = figure_of(
        R"("channels": ["theta"], "compare": [{"label": "a"}, {"label": "rigid", "set": {"beam.model": "rigid"}},
           {"label": "b", "set": {"solver.rtol": 1e-9}}])");
    const auto& curves = figure.panels[0].series;
    ASSERT_EQ(curves.size(), 3u);
    EXPECT_EQ(curves[0].look, curves[2].look);
    EXPECT_NE(curves[0].look, curves[1].look);
    EXPECT_TRUE(figure.panels[0].legend);
}

// The angles of all three coincide, but not the deflections, of which that of the rigid beam is zero and not drawn.
TEST(Series, MotionsKeepTheirLookFromPanelToPanel) {
    const Figure figure = figure_of(
        R"("channels": ["theta", "tip_deflection"], "to": 0.02, "compare": [{"label": "flexible"},
           {"label": "rigid", "set": {"beam.model": "rigid"}}, {"label": "4 modes", "set": {"beam.modes": 4}}])");
    ASSERT_EQ(figure.panels.size(), 2u);
    const auto &angles = figure.panels[0].series, &deflections = figure.panels[1].series;
    ASSERT_EQ(deflections.size(), 2u);
    EXPECT_EQ(deflections[0].look, angles.at(0).look);
    EXPECT_EQ(deflections[1].look, angles.at(2).look);
    EXPECT_NE(deflections[0].look, deflections[1].look);
}

TEST(Series, TakesLimitsInTheUnitsOfTheScene) {
    const Figure figure = figure_of(R"("panels": [{"channels": ["tip_deflection"], "low": -0.02, "high": 0.01}])");
    EXPECT_NEAR(*figure.panels[0].y.from, -20, 1e-12);
    EXPECT_NEAR(*figure.panels[0].y.to, 10, 1e-12);
}

TEST(Series, LimitsAndLinesMayHaveUnits) {
    const Figure figure = figure_of(
        R"("x": "theta_dot", "x_high": "3 rpm", "panels": [{"channels": ["theta"], "low": "20 deg", "lines": ["30 deg", 0.5]}])");
    EXPECT_NEAR(figure.panels[0].y.from.value(), M_PI / 9, 1e-12);
    EXPECT_NEAR(figure.panels[0].x.to.value(), 0.1 * M_PI, 1e-12);
    ASSERT_EQ(figure.panels[0].rules.size(), 2u);
    EXPECT_NEAR(figure.panels[0].rules[0].at, M_PI / 6, 1e-12);
    EXPECT_EQ(figure.panels[0].rules[1].at, 0.5);
    EXPECT_NEAR(figure_of(R"("channels": ["theta"], "x": "frequency", "x_high": "1 kHz")").panels[0].x.to.value(), 1000,
                1e-9);
}

TEST(Series, LimitsThatHideAllCurvesAreReported) {
    const Folder folder;
    folder.write("s.json", R"({"initial": {"angle": "60 deg"}, "time": {"end": 0.1}})");
    const auto figure = [&](const std::string& options) {
        return shell(folder, "$BEAMCAM figure s.json --channels theta -o f.svg " + options);
    };
    EXPECT_THAT(figure("--low 70deg").err,
                HasSubstr("warning: f.svg shows no curve: θ / ° is between 57.87 and 60, beyond the ends of its axis"));
    for (const char* limits : {"--x-low 1s --x-high 2s", "--x-low 1s", "--x-high=-1s"})
        EXPECT_THAT(figure(limits).err, HasSubstr("f.svg shows no curve: t / s is between 0 and 0.1")) << limits;
    EXPECT_THAT(figure("--low 59deg").err, Not(HasSubstr("warning")));
    const Finished wrong = figure("--x theta_dot --x-low 1mm");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--x-low = \"1mm\" has the wrong dimension (m); it is measured in rad/s"));
}

TEST(Series, LimitsOfATimeAxisSelectWhatIsDrawn) {
    const auto drawn = [](const std::string& limits) {
        return figure_of(R"("channels": ["theta"], "x": "t", )" + limits).panels[0];
    };
    const auto by_limits = drawn(R"("x_low": 0.05, "x_high": "60 ms")"),
               by_times = drawn(R"("from": 0.05, "to": 0.06)");
    EXPECT_EQ(by_limits.series[0].x, by_times.series[0].x);
    EXPECT_EQ(by_limits.series[0].y, by_times.series[0].y);
}

TEST(Series, LimitsOfTheAbscissaAreItsEndsAndItsPartIsDrawnFine) {
    const auto drawn = [](const std::string& limits) {
        return figure_of(R"("channels": ["theta_dot"], "x": "theta")" + limits).panels[0];
    };
    const auto whole = drawn(""), part = drawn(R"(, "x_low": 0.4, "x_high": 0.401)");
    EXPECT_EQ(part.x.from, 0.4);
    EXPECT_EQ(part.x.to, 0.401);
    const auto inside = [](const auto& panel) {
        return std::ranges::count_if(panel.series[0].x, [](double x) { return x > 0.4 && x < 0.401; });
    };
    EXPECT_GT(inside(part), 2 * inside(whole));
    EXPECT_LT(part.series[0].x.size(), whole.series[0].x.size());
}

// What a logarithmic panel leaves out stays on the axis that all panels share.
TEST(Series, PanelsShareOneAxis) {
    const Figure figure =
        figure_of(R"("panels": [{"channels": ["theta"]}, {"channels": ["contact_force"], "scale": "log"}])");
    for (const auto& panel : figure.panels) {
        EXPECT_EQ(panel.x.from, 0);
        EXPECT_NEAR(*panel.x.to, 0.4, 1e-12);
    }
}

TEST(Series, AChannelWithoutValuesIsReported) {
    EXPECT_THROW(figure_of(R"("channels": ["contact_x"])", R"("cam": null,)"), render::PictureError);
}

// Their potential energy is nothing by itself.
// A force that ends passes through all decades.
TEST(Series, ALogarithmicAxisLeavesOutTails) {
    const auto force = [](const std::string& keys) {
        return figure_of(R"("panels": [{"channels": ["contact_force"], "scale": "log")" + keys + "}]",
                         R"("beam": {"model": "rigid"}, )")
            .panels[0];
    };
    const auto panel = force("");
    const double most = range_of(panel.series[0].y).max;
    EXPECT_LT(range_of(panel.series[0].y).min, 1e-7 * most);
    EXPECT_NEAR(panel.y.from.value_or(0) / most, 1e-6, 1e-9);
    EXPECT_LT(force(R"(, "low": 1e-9)").y.from.value_or(1), 1e-8);
}

TEST(Series, DrawsSumsOfChannels) {
    const auto figure = figure_of(
        R"("panels": [{"channels": ["energy_elastic"],
                       "sums": [{"label": "stored", "plus": ["energy_elastic", "energy_contact"]},
                                {"label": "balance", "plus": ["energy_kinetic", "energy_potential", "energy_elastic",
                                 "energy_contact", "loss_contact"], "minus": ["work_cam"]}]}])");
    ASSERT_EQ(figure.panels[0].series.size(), 2u);
    EXPECT_EQ(figure.panels[0].series[0].label, "stored");
    EXPECT_EQ(figure.panels[0].y.label, "$E$ / J");  // not the symbol of one of the terms
    const auto [least, most] = std::ranges::minmax(figure.panels[0].series[1].y);
    EXPECT_NEAR(least, most, 1e-6 * std::abs(most));  // energy is conserved
    EXPECT_EQ(figure.title, "Stored, balance");
    EXPECT_THAT(testing::read(R"({"outputs": [{"type": "figure", "figure": "series", "panels": [
                    {"channels": ["theta"], "sums": [{"label": "a", "plus": ["theta", "contact_force"]}]}]}]})")
                    .report(),
                HasSubstr("a panel has one unit"));
}

TEST(Series, DrawsSumsAgainstAnyAbscissa) {
    const auto of = [](const std::string& x) {
        const std::string channel = R"("channels": ["energy_kinetic"])";
        const auto drawn = [&](const std::string& sums) {
            return figure_of("\"x\": \"" + x + "\", \"panels\": [{" + channel + sums + "}]").panels[0].series[0];
        };
        return std::pair(drawn(""), drawn(R"(, "sums": [{"label": "whole", "plus": ["energy_kinetic"]}])"));
    };
    for (const std::string x : {"theta", "energy_kinetic", "phase", "turns", "frequency"}) {
        const auto [channel, sum] = of(x);
        const auto [low, high] = range_of(channel.x);
        const auto [from, to] = range_of(sum.x);
        EXPECT_NEAR(from, low, 1e-3 * (high - low)) << x;
        EXPECT_NEAR(to, high, 1e-3 * (high - low)) << x;
        const double most_x = largest(sum.x), most_y = largest(sum.y);
        for (std::size_t i = 0; x == "energy_kinetic" && i < sum.x.size(); ++i)
            EXPECT_NEAR(sum.x[i] / most_x, sum.y[i] / most_y, 1e-9);
    }
}

// Zero is the height of O, as in a trajectory; sums are in J.
TEST(Series, CountsPotentialEnergyFromO) {
    const Figure alone = figure_of(R"("channels": ["energy_potential"])"),
                 sum = figure_of(R"("panels": [{"channels": ["energy_potential"],
                           "sums": [{"label": "V", "plus": ["energy_potential"]}]}])");
    EXPECT_EQ(alone.panels[0].y.label, "$V$ / mJ");
    EXPECT_NEAR(alone.panels[0].series[0].y.front(), 1e3 * sum.panels[0].series[0].y.front(), 1e-9);
}

TEST(Series, MarksImpacts) {
    const Figure figure = figure_of(R"("channels": ["theta"], "impacts": true)");
    ASSERT_EQ(figure.panels[0].rules.size(), 1u);
    EXPECT_NEAR(figure.panels[0].rules[0].at, 0.277394, 1e-6);
}

TEST(Series, ShowsMotionsApartOnOneScale) {
    const Figure figure = figure_of(
        R"("panels": [{"channels": ["theta"], "lines": [0.4], "label": "angle"}], "comparison": "panels",
           "compare": [{"label": "slow"}, {"label": "fast", "set": {"cam.speed": 5}}])");
    ASSERT_EQ(figure.panels.size(), 2u);
    for (const auto& panel : figure.panels) {
        EXPECT_EQ(panel.series.size(), 1u);
        EXPECT_EQ(panel.y.label, "angle / rad");
        EXPECT_EQ(panel.rules.front().at, 0.4);
        EXPECT_EQ(panel.y.from, figure.panels.front().y.from);
        EXPECT_EQ(panel.y.to, figure.panels.front().y.to);
    }
    EXPECT_EQ(figure.panels[1].title, "fast");
    // One unit, however much smaller the values of one motion are.
    const Figure forces = figure_of(R"("channels": ["contact_force"], "comparison": "panels",
           "compare": [{"label": "flexible"}, {"label": "rigid", "set": {"beam.model": "rigid"}}])");
    EXPECT_EQ(forces.panels[0].y.label, "$F$ / kN");
    EXPECT_EQ(forces.panels[1].y.label, "$F$ / kN");
    EXPECT_LT(largest(forces.panels[0].series[0].y), 0.5);
    EXPECT_THAT(testing::read(R"({"outputs": [{"type": "figure", "figure": "series", "channels": ["theta"],
                                 "comparison": "panels"}]})")
                    .report(),
                HasSubstr("needs several motions"));
}

// Without a cam the tip swings in its natural frequencies alone.
TEST(Series, SpectraHaveTheirPeaksAtTheNaturalFrequencies) {
    const Figure figure =
        figure_of(R"("x": "frequency", "x_high": 600, "panels": [{"channels": ["tip_deflection"], "scale": "log"}])",
                  R"("cam": null,)");
    const auto& s = figure.panels[0].series[0];
    EXPECT_EQ(figure.panels[0].x.label, "$f$ / Hz");
    EXPECT_LE(s.x.back(), 600);
    const double bin = s.x[1] - s.x[0];
    EXPECT_NEAR(bin, 1 / 0.4, 1e-9);
    for (const sim::Mode& mode : sim::natural_modes(testing::read("{}").scene->problem)) {
        const auto at = static_cast<std::size_t>(std::lround(mode.omega / (2 * M_PI) / bin));
        const double peak = std::max({s.y[at - 1], s.y[at], s.y[at + 1]});
        EXPECT_GT(peak, 20 * std::max(s.y[at - 12], s.y[at + 12])) << mode.omega;
    }
}

// A scene of a folder with measurements: of θ, shifted, in degrees and milliseconds.
constexpr const char* kRig = R"({"time": {"end": 0.4}, "data": [{"file": "rig.csv", "label": "rig", "t": "time",
    "theta": "angle", "units": {"angle": "deg", "time": "ms"}, "offset": "-100 ms"}], "outputs": [
    {"type": "figure", "figure": "series", "channels": ["theta"], "residuals": true, "file": "f.svg"},
    {"type": "summary", "file": "s.json"}]})";

TEST(Measured, DataAreDrawnAndJudged) {
    const Folder folder;
    folder.write("base.json", R"({"time": {"end": 0.4}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM simulate base.json --times 0,0.1,0.2,0.3,0.35 --channels theta > a.csv").code, 0);
    std::istringstream rows(testing::slurp(folder / "a.csv"));
    std::string line, rig = "time,angle,other\n";
    std::getline(rows, line);
    while (std::getline(rows, line)) {
        const double t = std::stod(line), theta = std::stod(line.substr(line.find(',') + 1));
        rig += fmt::format("{},{:.12f},1\n", t * 1e3 + 100, (theta + (t < 0.25 ? 0.01 : -0.03)) * 180 / M_PI);
    }
    folder.write("rig.csv", rig);
    folder.write("m.json", kRig);
    const Finished made = shell(folder, "$BEAMCAM run m.json -o . -q");
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string summary = testing::slurp(folder / "s.json");
    const auto number = [&](const std::string& key) {
        const std::size_t at = summary.find("\"" + key + "\": ", summary.find("\"data\""));
        return at == std::string::npos ? -1 : std::stod(summary.substr(at + key.size() + 4));
    };
    EXPECT_EQ(number("rows"), 5);
    EXPECT_NEAR(number("rms"), std::sqrt((3 * 1e-4 + 2 * 9e-4) / 5), 1e-9);
    // The same with data that changed is not up to date.
    EXPECT_THAT(shell(folder, "$BEAMCAM run m.json -o . 2>&1").out, Not(HasSubstr("wrote")));
    folder.write("rig.csv", rig + "490,20,1\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM run m.json -o . 2>&1").out, AllOf(HasSubstr("wrote"), Not(HasSubstr("rows"))));
    folder.write("rig.csv", "time,angle\n0,20\n100,20\n490,20\n510,20\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM check m.json 2>&1").out,
                HasSubstr("data.0.file: 2 of 4 rows lie outside the motion, which is from 0 to 0.4 s"));
    const Finished drawn = shell(folder, "$BEAMCAM figure m.json angle -o a.svg --data d.csv");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_THAT(testing::slurp(folder / "d.csv"), HasSubstr("t / s,rig: θ / rad,θ / rad\n"));
}

TEST(Measured, AnglesWithoutAUnitArePerhapsInDegrees) {
    const Folder folder;
    folder.write("m.json", R"({"time": {"end": 0.4}, "data": [{"file": "rig.csv"}]})");
    for (const auto& [rig, doubtful] : {std::pair{"t,theta\n0,30\n0.1,NA\n0.2,15\n", true},
                                        {"t,theta [deg]\n0,30\n0.1,20\n0.2,15\n", false},
                                        {"t,theta\n0,0.5\n0.1,NA\n0.2,0.3\n", false}}) {
        folder.write("rig.csv", rig);
        const std::string report = shell(folder, "$BEAMCAM check m.json 2>&1").out;
        EXPECT_EQ(
            report.find(R"(the column "theta" is read in rad and contains 30; write "units": {"theta": "deg"})") !=
                std::string::npos,
            doubtful)
            << report;
    }
}

// Data of t and θ, drawn over either and over the phase of the cam at t.
TEST(Measured, DataAreDrawnOverThePhaseOfTheCam) {
    const Folder folder;
    folder.write("rig.csv", "t,theta\n0,0.7\n0.1,0.6\n0.2,0.5\n0.35,0.3\n");
    folder.write("m.json", R"({"time": {"end": 0.4}, "cam": {"speed": -20, "phase": "90 deg"},
                               "data": [{"file": "rig.csv", "label": "rig", "theta": "theta"}]})");
    const auto drawn = [&](const std::string& options) {
        const Finished made = shell(folder, "$BEAMCAM figure m.json " + options + " -o a.svg --data d.csv");
        EXPECT_EQ(made.code, 0) << made.err;
        std::vector<std::pair<double, double>> points;
        const output::ColumnTable table = output::read_table(folder / "d.csv");
        for (std::size_t c = 0; c + 1 < table.columns.size() && points.empty(); ++c)
            if (table.columns[c].name.starts_with("rig: "))  // x, then y
                for (std::size_t row = 0; row < table.rows(); ++row)
                    if (const double x = table.columns[c].values[row]; std::isfinite(x))
                        points.emplace_back(x, table.columns[c + 1].values[row]);
        return std::pair(points, made.err);
    };
    const auto [phases, quiet] = drawn("--channels theta --x phase");
    ASSERT_EQ(phases.size(), 4u);
    const double times[] = {0, 0.1, 0.2, 0.35}, angles[] = {0.7, 0.6, 0.5, 0.3};
    for (std::size_t i = 0; i < 4; ++i) {
        const double turns = 20 * times[i] / (2 * M_PI);
        EXPECT_NEAR(phases[i].first, turns - std::floor(turns), 1e-9);
        EXPECT_NEAR(phases[i].second, angles[i] * 180 / M_PI, 1e-12);  // the scene states degrees
    }
    EXPECT_EQ(quiet.find("rig"), std::string::npos) << quiet;
    EXPECT_EQ(drawn("--channels theta,theta_dot --x theta").first.size(), 4u);
    // Data are not drawn over a channel that they do not hold, which a message states.
    const auto [none, report] = drawn("--channels theta --x theta_dot");
    EXPECT_EQ(none.size(), 0u);
    EXPECT_THAT(report, HasSubstr("x = \"theta_dot\": the data \"rig\" have no theta_dot; they are not drawn"));
}

TEST(Measured, BadFilesAreReportedWithTheirPlace) {
    const Folder folder;
    folder.write("m.json", kRig);
    const auto report = [&](const std::string& rig) {
        folder.write("rig.csv", rig);
        const Finished checked = shell(folder, "$BEAMCAM check m.json");
        EXPECT_EQ(checked.code, 3);
        return checked.out + checked.err;
    };
    EXPECT_THAT(shell(folder, "$BEAMCAM check m.json").err, HasSubstr("rig.csv: No such file or directory; correct"));
    EXPECT_THAT(report("time,angle\n100,45\n200,x\n"), HasSubstr("rig.csv:3:5: \"x\" is not a number"));
    EXPECT_THAT(report("time,angle\n100,45\n90,44\n"), HasSubstr("line 3: the time does not increase"));
    EXPECT_THAT(report("time,angel\n100,45\n"), HasSubstr("the file has no column \"angle\"; did you mean \"angel\"?"));
    EXPECT_THAT(report("time,angle\n1000,45\n"), HasSubstr("no row lies between 0 and 0.4 s"));
    EXPECT_THAT(report(""), HasSubstr("the file is empty"));
    EXPECT_THAT(report("time,angle\n"), HasSubstr("the file has no rows below the names of the columns"));
    EXPECT_THAT(report("time,angle\n100,45\n200,inf\n"), HasSubstr("rig.csv:3:5: \"inf\" is not a finite number"));
    EXPECT_THAT(report("time,angle\n100,nan\n200,\n"), HasSubstr("the column \"angle\" contains no number"));
    folder.write("rig.csv", "time,angle\n100,45\n");
    EXPECT_THAT(shell(folder, R"(sed 's/"deg"/"mm"/' m.json > n.json; $BEAMCAM check n.json)").err,
                HasSubstr("\"mm\" is not a unit of the column \"angle\", which is measured in rad"));
    EXPECT_THAT(shell(folder, R"(mkdir d.csv; sed 's/rig.csv/d.csv/' m.json > n.json; $BEAMCAM check n.json)").err,
                HasSubstr("not a regular file"));
}

TEST(Series, OptionsAreKeysOfTheScene) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    const std::string command = "$BEAMCAM figure s.json -q ";
    EXPECT_EQ(shell(folder, command + "--channels theta,gap --from 0.1 --to '300 ms' --height 60mm -o a.pdf").code, 0);
    EXPECT_EQ(shell(folder, command + "series --channels theta -o b.png --width 90mm --height 60mm --dpi 254").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM info b.png").out, HasSubstr("900x600"));
    EXPECT_EQ(shell(folder, command + "--channels contact_force --log -o l.pdf").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM info l.pdf --scene").out, HasSubstr("\"scale\": \"log\""));
    EXPECT_EQ(shell(folder, command + "schematic --log -o l.svg").code, 2);
    folder.write("fast.json", R"({"cam": {"speed": 5}, "time": {"end": 0.4}})");
    EXPECT_EQ(
        shell(folder, command + "--channels theta --compare fast.json --set cam.speed=2 -o m.pdf --caption m.txt").code,
        0);
    EXPECT_THAT(testing::slurp(folder / "m.txt"), ::testing::StartsWith("Hub angle θ. "));
    const std::string compared = shell(folder, "$BEAMCAM info m.pdf --scene").out;
    EXPECT_THAT(compared, HasSubstr("\"speed\": 2.0"));
    EXPECT_THAT(compared, HasSubstr("\"speed\": 5.0"));
    const Finished wrong = shell(folder, command + "--channels thetta -o c.png");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--channels = \"thetta\" is not a channel; did you mean \"theta\"?"));
    EXPECT_THAT(shell(folder, command + "--channels force -o c.png").err,
                HasSubstr("did you mean \"contact_force\" or \"friction_force\" or \"pivot_force\"?"));
    EXPECT_EQ(shell(folder, command + "--channels theta --from 0.5 -o c.png").code, 2);
    EXPECT_EQ(shell(folder, command + "phase --channels theta -o c.png").code, 2);
    EXPECT_EQ(shell(folder, command + "series -o c.png").code, 2);
}

// The same bytes, including the embedded scene.
TEST(Series, OptionsDescribeAPanelAsKeysDo) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    folder.write("k.json", R"({"time": {"end": 0.4}, "outputs": [{"type": "figure", "figure": "series", "file": "k.svg",
        "theme": "dark", "x_low": 0.1, "x_high": 0.35, "notes": [{"at": "impact:1", "text": "touch"}],
        "panels": [{"channels": ["theta"], "lines": [0.5, 0.7], "low": 0.3, "high": 1, "title": "Hub $θ$"}]}]})");
    const Finished made = shell(folder,
                                "$BEAMCAM run k.json -q && $BEAMCAM figure s.json -q --channels theta "
                                "--lines 0.5,0.7 --low 0.3 --high 1 --title 'Hub $θ$' --x-low 0.1 --x-high 0.35 "
                                "--note impact:1=touch --theme dark -o s.svg");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(testing::slurp(folder / "k.svg"), testing::slurp(folder / "s.svg"));
    const std::string command = "$BEAMCAM figure s.json -q -o a.svg ";
    EXPECT_EQ(shell(folder, command + "--channels theta --low 2 --high 1").code, 2);
    EXPECT_EQ(shell(folder, command + "--channels theta --note impact:x=a").code, 2);
    EXPECT_EQ(shell(folder, command + "schematic --title A").code, 2);
    EXPECT_EQ(shell(folder, command + "--channels theta --panels").code, 2);
}

// 0.4 s at 40 rad/s are 2.55 turns since the start, forwards in either sense and from any angle of the cam.
TEST(Series, RunsOverThePhaseOfTheCam) {
    for (const double speed : {40.0, -40.0}) {
        const Figure figure =
            figure_of(R"("channels": ["theta"], "x": "phase")",
                      fmt::format(R"("cam": {{"speed": {}, "phase": "180 deg", "centre": [-0.5, 0]}},)", speed));
        const auto& curve = figure.panels[0].series[0];
        EXPECT_EQ(figure.panels[0].x.label, "cam phase / turn");
        EXPECT_EQ(figure.panels[0].x.from, 0);
        EXPECT_EQ(figure.panels[0].x.to, 1);
        EXPECT_EQ(figure.title, "Hub angle $θ$ against the phase of the cam");
        std::size_t edges = 0;
        double turns = 0;
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            if (std::isnan(curve.x[i])) {
                ++edges;
                EXPECT_EQ(curve.x[i - 1] + curve.x[i + 1], 1);  // from one end of the axis to the other
                EXPECT_EQ(curve.y[i - 1], curve.y[i + 1]);
            } else {
                EXPECT_GE(curve.x[i], 0);
                EXPECT_LE(curve.x[i], 1);
                if (i > 0 && !std::isnan(curve.x[i - 1])) turns += curve.x[i] - curve.x[i - 1];
            }
        }
        EXPECT_NEAR(turns, 0.4 * 40 / (2 * M_PI), 1e-9);
        EXPECT_EQ(edges, 2u);
    }
    EXPECT_THAT(testing::read(R"({"cam": null, "outputs": [{"type": "figure", "figure": "series",
                                  "channels": ["theta"], "x": "phase"}]})")
                    .report(),
                HasSubstr("the scene has no cam"));
}

// Of the interval alone, whatever was lost before.
TEST(Series, BeyondTheHorizonIsPaleAndStatedWhereItShowsThat) {
    const std::string run = R"("cam": {"speed": 5}, "initial": {"angle": "45 deg"}, )";
    const auto figure = figure_of(R"("channels": ["theta"], "to": 6, "horizon": true)", run);
    EXPECT_THAT(figure.accuracy, HasSubstr("Where curves are paler, $θ$ is not reproducible to 10^{−6} rad."));
    ASSERT_EQ(figure.panels[0].series.size(), 2u);
    EXPECT_TRUE(figure.panels[0].series[0].faded);
    EXPECT_EQ(figure.panels[0].series[0].x.front(), figure.panels[0].series[1].x.back());
    for (const char* keys : {R"("channels": ["theta"], "to": 1, "horizon": true)", R"("channels": ["theta"], "to": 6)"})
        EXPECT_THAT(figure_of(keys, run).accuracy, Not(HasSubstr("not reproducible"))) << keys;
}

TEST(Measured, DataOfTheContactNeedACam) {
    const Folder folder;
    folder.write("rig.csv", "t,gap\n0.1,0.05\n");
    folder.write("m.json", R"({"cam": null, "data": [{"file": "rig.csv"}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM check m.json").err,
                HasSubstr("gap is a channel of the contact, but the scene has no cam"));
}

// Names in the summary are plain, in figures markup.
TEST(Measured, NamesOfFilesAreLabelsAsTheyAre) {
    const Folder folder;
    folder.write("run_2$.csv", "t,theta\n0.1,0.7\n");
    folder.write("m.json", R"({"time": {"end": 0.2}, "data": [{"file": "run_2$.csv"}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM simulate m.json").out, HasSubstr("\"label\": \"run_2$\""));
    const Finished drawn = shell(folder, "$BEAMCAM figure m.json --channels theta -o a.svg --data a.csv");
    EXPECT_THAT(testing::slurp(folder / "a.csv"), HasSubstr("run_2$: θ"));
}

// A vibration of 50 Hz has its line there, in its own amplitude; unequal steps have no spectrum, which is reported.
TEST(Measured, DataHaveSpectraOfTheirOwn) {
    const Folder folder;
    std::string even = "t,tip_deflection\n", uneven = even;
    for (int k = 0; k < 400; ++k) {
        even += fmt::format("{:.4f},{:.9f}\n", k * 1e-3, 2e-3 * std::cos(2 * M_PI * 50 * k * 1e-3));
        uneven += fmt::format("{:.6f},{:.9f}\n", k * k * 2.5e-6, 1e-3);
    }
    folder.write("even.csv", even), folder.write("uneven.csv", uneven);
    folder.write("m.json", R"({"time": {"end": 0.4}, "data": [{"file": "even.csv"}, {"file": "uneven.csv"}]})");
    const Finished drawn = shell(folder,
                                 "$BEAMCAM figure m.json --channels tip_deflection --x frequency -o a.svg "
                                 "--data a.csv");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_THAT(drawn.err, HasSubstr("the instants of the data \"uneven\" are too few or not equally spaced"));
    EXPECT_THAT(drawn.err, Not(HasSubstr("\"even\"")));
    const output::ColumnTable table = output::read_table(folder / "a.csv");
    const std::vector<double>*f = table.find("f / Hz"), *amplitude = table.find("even: |v| / µm");
    ASSERT_TRUE(f && amplitude) << testing::slurp(folder / "a.csv").substr(0, 200);
    double at = 0, most = 0;
    for (std::size_t row = 0; row < table.rows(); ++row)
        if ((*amplitude)[row] > most) most = (*amplitude)[row], at = (*f)[row];
    EXPECT_NEAR(at, 50, 1);
    EXPECT_NEAR(most, 2000, 20);
}

TEST(Series, ASpectrumWithoutLinesIsReported) {
    EXPECT_THROW(figure_of(R"("channels": ["theta"], "x": "frequency", "x_high": 0.1)"), render::PictureError);
    EXPECT_THROW(figure_of(R"("channels": ["theta"], "x": "frequency")",
                           R"("cam": null, "gravity": 0, "initial": {"angle": 0},)"),
                 render::PictureError);
}

TEST(Series, MarksInstantsWithText) {
    const Figure figure =
        figure_of(R"("channels": ["theta", "gap"], "notes": [{"at": "impact:1", "text": "touch"}, {"at": 0.1}])");
    ASSERT_EQ(figure.panels[0].rules.size(), 2u);
    EXPECT_NEAR(figure.panels[0].rules[0].at, 0.277394, 1e-6);
    EXPECT_EQ(figure.panels[0].rules[0].label, "touch");
    EXPECT_EQ(figure.panels[0].rules[1].at, 0.1);
    ASSERT_EQ(figure.panels[1].rules.size(), 2u);
    EXPECT_EQ(figure.panels[1].rules[0].label, "");
    EXPECT_THROW(figure_of(R"("channels": ["theta"], "to": 0.2, "notes": [{"at": 0.3}])"), render::PictureError);
    EXPECT_THROW(figure_of(R"("channels": ["theta"], "notes": [{"at": "impact:99"}])"), render::PictureError);
}

TEST(Series, TooManyPanelsAreReportedWithTheLimit) {
    std::string panels;
    for (int k = 0; k < 60; ++k) panels += std::string(k > 0 ? "," : "") + R"({"channels": ["theta"]})";
    EXPECT_THAT(
        testing::read(R"({"outputs": [{"type": "figure", "figure": "series", "panels": [)" + panels + "]}]}").report(),
        HasSubstr("must be an array of at most 8 panels, not an array of 60 values"));
}

}  // namespace
}  // namespace beamcam::scenes
