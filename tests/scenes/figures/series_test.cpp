// The figure "series": any channels, of one motion or of several.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/base/error.hpp"
#include "render/plot/text.hpp"
#include "scenes/figures/recipes.hpp"
#include "tests/scenes/support.hpp"

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
    const Reading reading =
        testing::read("{" + mechanics + R"("time": {"end": 0.4}, "outputs": [{"type": "figure", "figure": "series", )" +
                      output + "}]}");
    if (!reading.scene) throw std::runtime_error(reading.report());
    Studies studies;
    const auto& how = std::get<FigureOutput>(reading.scene->outputs.front());
    const FigureMaker make = recipe_named("series")->prepare(*reading.scene, how, studies);
    std::vector<sim::Result> runs;
    for (const Study& study : studies.take()) runs.push_back(sim::simulate(study.problem, study.request));
    Results results;
    for (const sim::Result& run : runs) results.push_back(&run);
    return make(results);
}

double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }

TEST(Series, HasAPanelForEachUnit) {
    const Figure figure = figure_of(R"("channels": ["theta", "contact_force", "tip_deflection", "q1"])");
    ASSERT_EQ(figure.panels.size(), 3u);
    EXPECT_EQ(figure.panels[0].y.label, "$θ$ / rad");
    EXPECT_EQ(figure.panels[1].y.label, "$F$ / N");
    EXPECT_EQ(figure.panels[2].y.label, "$w$, $q_{1}$ / mm");
    EXPECT_EQ(figure.panels[2].series.size(), 2u);
    EXPECT_EQ(figure.panels[2].x.label, "$t$ / ms");
    for (const auto& panel : figure.panels) EXPECT_NO_THROW(render::figure::parse_markup(panel.y.label));
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
    EXPECT_THAT(figure.caption, HasSubstr("Hub angle $θ$: flexible; rigid."));
    const Figure both = figure_of(
        R"("panels": [{"channels": ["theta"], "right": ["gap"]}], "compare": [{"label": "a"}, {"label": "b"}])");
    ASSERT_EQ(both.panels[0].series.size(), 4u);
    EXPECT_EQ(both.panels[0].series[3].label, "b, $g$");
    EXPECT_TRUE(both.panels[0].series[3].right);
    EXPECT_EQ(both.panels[0].right->label, "$g$ / mm");
}

TEST(Series, TakesLimitsInTheUnitsOfTheScene) {
    const Figure figure = figure_of(R"("panels": [{"channels": ["tip_deflection"], "low": -0.02, "high": 0.01}])");
    EXPECT_NEAR(*figure.panels[0].y.from, -20, 1e-12);
    EXPECT_NEAR(*figure.panels[0].y.to, 10, 1e-12);
}

// What a logarithmic panel leaves out stays on the axis that all panels share.
TEST(Series, PanelsShareOneAxis) {
    const Figure figure =
        figure_of(R"("panels": [{"channels": ["theta"]}, {"channels": ["contact_force"], "scale": "log"}])");
    for (const auto& panel : figure.panels) {
        EXPECT_EQ(panel.x.from, 0);
        EXPECT_NEAR(*panel.x.to, 400, 1e-9);
    }
}

TEST(Series, AChannelWithoutValuesIsTold) {
    EXPECT_THROW(figure_of(R"("channels": ["contact_x"])", R"("cam": null,)"), render::PictureError);
}

// Their potential energy is nothing by itself.
TEST(Series, CountsPotentialEnergyFromItsLeast) {
    const Figure figure = figure_of(R"("channels": ["energy_potential"])");
    EXPECT_EQ(*std::ranges::min_element(figure.panels[0].series[0].y), 0);
}

TEST(Series, MarksImpacts) {
    const Figure figure = figure_of(R"("channels": ["theta"], "impacts": true)");
    ASSERT_EQ(figure.panels[0].rules.size(), 1u);
    EXPECT_NEAR(figure.panels[0].rules[0].at, 277.394, 1e-3);  // [ms]
    EXPECT_THAT(figure.caption, HasSubstr("Dashed lines: impacts begin."));
    EXPECT_THAT(figure_of(R"("channels": ["theta"])").caption, Not(HasSubstr("Dashed")));
}

TEST(Series, OptionsAreKeysOfTheScene) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    const std::string command = "$BEAMCAM figure s.json -q ";
    EXPECT_EQ(shell(folder, command + "--channels theta,gap --from 0.1 --to '300 ms' --height 60mm -o a.pdf").code, 0);
    EXPECT_EQ(shell(folder, command + "series --channels theta -o b.png --width 90mm --height 60mm --dpi 254").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM info b.png").out, HasSubstr("900x600"));
    const Finished wrong = shell(folder, command + "--channels thetta -o c.png");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--channels.0 = \"thetta\" is not a channel; did you mean \"theta\"?"));
    EXPECT_EQ(shell(folder, command + "--channels theta --from 0.5 -o c.png").code, 2);
    EXPECT_EQ(shell(folder, command + "phase --channels theta -o c.png").code, 2);
    EXPECT_EQ(shell(folder, command + "series -o c.png").code, 2);
}

}  // namespace
}  // namespace beamcam::scenes
