// Kymograph, spectrogram, strobe, maps of impacts; and the table of states at impacts.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "output/data/table_reader.hpp"
#include "render/draw/fonts.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/plan/plan.hpp"
#include "sim/beam/modes.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf;
using testing::Finished;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::shell;
using ::testing::StartsWith;

render::figure::Figure overview_of(const std::string& name, const std::string& keys) {
    return testing::simulated(R"({"time": {"end": 0.4}, "outputs": [{"type": "figure", "figure": ")" + name + "\"" +
                              keys + "}]}");
}

TEST(Overviews, AKymographHasAColourForEachPlaceAndInstant) {
    const auto figure = overview_of("kymograph", R"(, "from": 0.2, "to": 0.3)");
    const auto& cells = figure.panels[0].cells.at(0);
    EXPECT_EQ(cells.colors.size(), (cells.x.size() - 1) * (cells.y.size() - 1));
    EXPECT_NEAR(cells.x.front(), 0.2, 1e-12);
    EXPECT_NEAR(cells.x.back(), 0.3, 1e-12);
    EXPECT_EQ(cells.y.back(), 1);
    ASSERT_EQ(figure.panels[0].series.at(0).x.size(), 1u);  // an impact
    EXPECT_NEAR(figure.panels[0].series[0].x[0], 0.277394, 1e-6);
}

// A stiff impact lasts less than equally spaced rows of ten seconds are apart, of which one pair spans 0.8 of the
// range.
TEST(Overviews, APhasePortraitHasRowsInImpacts) {
    const auto figure = testing::simulated(R"({"beam": {"model": "rigid"}, "contact": {"stiffness": 1e10},
        "time": {"end": 10}, "outputs": [{"type": "figure", "figure": "phase"}]})");
    double low = 0, high = 0, jump = 0;
    for (const auto& curve : figure.panels.at(0).series)
        for (std::size_t i = 0; i < curve.y.size(); ++i) {
            if (std::isnan(curve.y[i])) continue;
            low = std::min(low, curve.y[i]), high = std::max(high, curve.y[i]);
            if (i > 0 && !std::isnan(curve.y[i - 1])) jump = std::max(jump, std::abs(curve.y[i] - curve.y[i - 1]));
        }
    EXPECT_GT(jump, 0);
    EXPECT_LT(jump, 0.4 * (high - low));
}

Plan resolved_plan(const Scene& scene, const AttemptOutput& attempt = attempt_or_throw) {
    const auto find = [](const sim::Problem& problem, const sim::Request& request) {
        return sim::simulate(problem, request);
    };
    return plan(resolve(scene, {}, find, attempt));
}

TEST(Stretch, BeginsAndEndsAtEventsOfTheFirstMotion) {
    const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [
        {"type": "figure", "figure": "series", "channels": ["theta"], "from": "touch", "to": "apex:1"},
        {"type": "figure", "figure": "strobe", "to": "release"},
        {"type": "figure", "figure": "strobe", "to": "last", "file": "end.pdf"},
        {"type": "figure", "figure": "series", "channels": ["theta"], "from": "collision:1", "file": "two.pdf",
         "compare": [{"label": "higher", "set": {"initial.angle": "50 deg"}}, {"label": "own"}]},
        {"type": "figure", "figure": "kymograph"}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const auto impacts_of = [](sim::Problem problem) {
        sim::Request request;
        request.end_time = 1;
        return sim::simulate(problem, request);
    };
    const sim::Result own = impacts_of(reading.scene->problem);
    EXPECT_EQ(events_until(reading.scene->outputs[0], *reading.scene), 1);
    const Plan made = resolved_plan(*reading.scene);
    ASSERT_EQ(made.figures.size(), 5u);
    const auto times = [&](std::size_t figure) {
        return made.motions.at(made.figures[figure].motions.at(0)).request.tables.at(0).times;
    };
    EXPECT_NEAR(times(0).front(), own.impacts[0].t_start, 1e-12);
    // The apex: the hub is at rest between the first collision and the next.
    const double apex = times(0).back();
    EXPECT_GT(apex, *own.collisions[0].t_end);
    EXPECT_LT(apex, own.collisions[1].t_start);
    sim::Request at_apex;
    at_apex.end_time = apex;
    at_apex.tables = {{{apex}, {{sim::ChannelKind::theta_dot, 0}}}};
    EXPECT_NEAR(sim::simulate(reading.scene->problem, at_apex).tables[0].values[0][0], 0, 1e-6);
    const auto& released = made.motions.at(made.figures[1].motions.at(0)).request;
    EXPECT_NEAR(released.end_time, *own.impacts[0].t_end, 1e-12);
    EXPECT_EQ(made.motions.at(made.figures[2].motions.at(0)).request.end_time, 1);
    const sim::Result higher = impacts_of(made.motions.at(made.figures[3].motions.at(0)).problem);
    ASSERT_GT(std::abs(higher.collisions[0].t_start - own.collisions[0].t_start), 1e-4);
    EXPECT_NEAR(times(3).front(), higher.collisions[0].t_start, 1e-12);
    const auto& kymograph = made.motions.at(made.figures[4].motions.at(0)).request.poses.back().times;
    EXPECT_NEAR(kymograph.front(), own.collisions[0].t_start, 1e-12);
    EXPECT_NEAR(kymograph.back(), *own.collisions[0].t_end, 1e-12);
}

TEST(Stretch, OfAnEventThatDoesNotOccurIsRejectedAlone) {
    const Reading reading = testing::read(R"({"time": {"end": 0.4}, "outputs": [
        {"type": "figure", "figure": "strobe", "to": "impact:7", "file": "a.pdf"},
        {"type": "figure", "figure": "kymograph", "from": "release", "to": "touch", "file": "b.pdf"},
        {"type": "figure", "figure": "kymograph", "from": "touch", "file": "c.pdf"}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    std::vector<std::string> why;
    const Plan made = resolved_plan(*reading.scene, [&](std::size_t output, const std::function<void()>& work) {
        try {
            work();
        } catch (const render::PictureError& error) {
            why.push_back(std::to_string(output) + ": " + error.what());
        }
    });
    ASSERT_EQ(made.figures.size(), 1u);
    EXPECT_EQ(made.figures[0].file, "c.pdf");
    ASSERT_EQ(why.size(), 2u);
    EXPECT_THAT(why[0], HasSubstr("0: impact 7 does not occur: the motion has 1 of them until 0.4 s"));
    EXPECT_THAT(why[1], HasSubstr("1: figure kymograph: \"from\" = release 1 at 0.28"));
}

TEST(Stretch, OfEventsReadsBackAsItWasWritten) {
    const Reading reading = testing::read(R"({"outputs": [
        {"type": "figure", "figure": "strobe", "to": "collision:2"},
        {"type": "figure", "figure": "kymograph", "from": "touch", "to": "apex:3"}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const std::string text = to_json(*reading.scene);
    const Reading again = testing::read(text);
    ASSERT_TRUE(again.scene) << again.report();
    EXPECT_EQ(to_json(*again.scene), text);
    const auto& keys = std::get<FigureOutput>(again.scene->outputs[1]).series;
    EXPECT_EQ(keys.to_event, (Instant{.kind = Instant::Kind::apex, .number = 3}));
}

// The first run, and that of the figure, end with the event that bounds it; another output takes them further.
TEST(Stretch, ThatEndsAtAnEventIsIntegratedNoFurther) {
    const auto ends = [](const std::string& outputs, double& searched) {
        const Reading reading = testing::read(R"({"time": {"end": 2}, "outputs": [)" + outputs + "]}");
        EXPECT_TRUE(reading.scene) << reading.report();
        const auto find = [&](const sim::Problem& problem, const sim::Request& request) {
            sim::Result found = sim::simulate(problem, request);
            searched = found.end_time;
            return found;
        };
        const Plan made = plan(resolve(*reading.scene, find));
        double end = 0;
        for (const MotionRequest& each : made.motions) end = std::max(end, each.request.end_time);
        return end;
    };
    sim::Request all;
    all.end_time = 2;
    const Reading plain = testing::read(R"({"time": {"end": 2}})");
    const sim::Result whole = sim::simulate(plain.scene->problem, all);
    const double third = whole.impacts.at(2).t_start, second = whole.collisions.at(1).t_start;
    double searched = 0;
    constexpr const char* kFigure =
        R"({"type": "figure", "figure": "series", "channels": ["theta"], "to": "impact:3"})";
    EXPECT_EQ(ends(kFigure, searched), third);
    EXPECT_EQ(searched, third);
    EXPECT_EQ(
        ends(R"({"type": "video", "from": "touch", "to": "impact:3", "events": [{"at": "impact:9", "text": "later"}]})",
             searched),
        third);
    EXPECT_EQ(searched, third);
    EXPECT_EQ(
        ends(
            R"({"type": "video", "to": "collision:2", "compare": [{"label": "a"}, {"label": "b", "set": {"beam.modes": 3}}]})",
            searched),
        second);
    // The apex of a rebound is known when it is over.
    EXPECT_LT(ends(R"({"type": "figure", "figure": "strobe", "to": "apex:1"})", searched), second);
    EXPECT_EQ(searched, second);
    // An output that shows all impacts, or the end, needs the whole motion.
    EXPECT_EQ(ends(std::string(kFigure) + R"(, {"type": "video", "speed": "impacts"})", searched), 2);
    EXPECT_EQ(searched, 2);
}

// A column of 5 ms holds most of a period of the first mode: an instant of it would show a vibration that is not there.
TEST(Overviews, ColumnsOfAKymographHaveTheExtremesOfWhatIsFaster) {
    const auto figure = overview_of("kymograph", R"(, "to": 3)");
    double most = 0;
    for (const double v : figure.panels[0].cells[0].values) most = std::max(most, std::abs(v));
    sim::Request request;
    request.end_time = 3;
    request.extrema = {{sim::ChannelKind::tip_deflection, 0}};
    const sim::Extremum tip = sim::simulate(testing::read("{}").scene->problem, request).extrema.front();
    EXPECT_NEAR(most * 1e-3, std::max(tip.max, -tip.min), 0.05 * std::max(tip.max, -tip.min));
}

TEST(Overviews, DataOfAKymographAreItsDeflections) {
    const auto figure = overview_of("kymograph", R"(, "from": 0.2, "to": 0.3)");
    const auto& cells = figure.panels[0].cells.at(0);
    ASSERT_EQ(cells.values.size(), cells.colors.size());
    std::istringstream rows(render::figure::data_csv(figure));
    std::string line;
    std::size_t count = 0;
    double least = 0;
    while (std::getline(rows, line))
        if (line.starts_with("1,\"v(x, t) / mm\",t / s,"))
            ++count, least = std::min(least, std::stod(line.substr(line.rfind(',') + 1)));
    EXPECT_EQ(count, cells.values.size());
    EXPECT_NEAR(least, *std::ranges::min_element(cells.values), 1e-12);
    EXPECT_NEAR(least, *figure.panels[0].color_bar->from, 1e-12);
}

// The tip of a beam that falls free swings in its first natural frequency all along.
TEST(Overviews, ASpectrogramHasItsLargestAmplitudeAtTheFirstFrequency) {
    const Reading reading =
        testing::read(R"({"cam": null, "initial": {"shape": "static"}, "time": {"end": 2}, "outputs": [
        {"type": "figure", "figure": "spectrogram", "window": "0.2 s", "highest": 400}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const auto figure = testing::simulated(*reading.scene, std::get<FigureOutput>(reading.scene->outputs[0]));
    const auto& cells = figure.panels[0].cells.at(0);
    const std::size_t columns = cells.x.size() - 1, rows = cells.y.size() - 1;
    const double first = sim::natural_modes(reading.scene->problem).front().omega / (2 * M_PI);
    EXPECT_LE(cells.y.back(), 410);
    const double step = cells.y[2] - cells.y[1];
    for (std::size_t i = 0; i < columns; i += 29) {
        std::size_t best = 0;
        for (std::size_t k = 3; k < rows; ++k)  // the fall itself is below
            if (best == 0 || cells.values[k * columns + i] > cells.values[best * columns + i]) best = k;
        EXPECT_NEAR(0.5 * (cells.y[best] + cells.y[best + 1]), first, step) << cells.x[i];
    }
    EXPECT_THAT(figure.title, HasSubstr("Hann windows of"));
    EXPECT_THAT(
        testing::read(R"({"outputs": [{"type": "figure", "figure": "spectrogram", "channels": ["theta", "gap"]}]})")
            .report(),
        HasSubstr("shows one channel"));
    EXPECT_THAT(testing::read(R"({"outputs": [{"type": "figure", "figure": "strobe", "window": 0.1}]})").report(),
                HasSubstr("belongs to the figure \"spectrogram\""));
}

// The instants that a figure names on the page of a column.
std::vector<render::figure::PageCanvas::Written> instants_on(const render::figure::Figure& figure, const char* column) {
    const auto page = page_of(figure, *render::figure::column_named(column));
    const render::Fonts fonts(false, render::Typefaces::print);
    render::figure::PageCanvas sheet(
        render::Medium::png, {render::figure::points(page.width), render::figure::points(page.height), 72}, fonts);
    draw(figure, page, sheet);
    std::erase_if(sheet.written, [](const auto& text) { return !text.markup.ends_with(" s"); });
    return sheet.written;
}

TEST(Overviews, AStrobeNamesItsInstants) {
    const auto labels = [](const std::string& end) {
        const auto figure = overview_of("strobe", R"(, "to": )" + end);
        std::vector<std::string> out;
        for (const auto& shape : figure.panels[0].shapes)
            if (shape.kind == render::figure::Shape::Kind::label) out.push_back(shape.markup);
        return out;
    };
    EXPECT_THAT(labels("0.25"), ::testing::ElementsAre("$ω$", "0.000 … 0.100 s", "0.150 s", "0.200 s", "0.250 s", "$g$",
                                                       HasSubstr("200")));
    EXPECT_THAT(labels("0.05"), ::testing::ElementsAre("$ω$", "0.000 … 0.050 s", "$g$", HasSubstr("200")));
    EXPECT_THAT(labels(R"(5, "from": 3)"), ::testing::Contains(HasSubstr(", ")));  // close beams of instants apart
}

// Near the top, labels side by side need more room than their height.
TEST(Overviews, LabelsOfAStrobeKeepApart) {
    for (const char* angle : {"0.3", "0.8", "1.4", "2.5", "-1.6"})
        for (const char* column : {"nature", "elsevier", "slide"}) {
            const render::figure::Figure figure = testing::simulated(
                R"({"cam": null, "hub": {"drive": {"type": "prescribed", "law": "constant", "speed": 0.3}},
                    "initial": {"angle": )" +
                std::string(angle) +
                R"(}, "time": {"end": 1.4}, "outputs": [{"type": "figure", "figure": "strobe"}]})");
            const auto labels = instants_on(figure, column);
            EXPECT_FALSE(labels.empty()) << angle << ' ' << column;
            for (std::size_t i = 0; i < labels.size(); ++i)
                for (std::size_t k = 0; k < i; ++k)
                    EXPECT_FALSE(labels[i].box.overlaps(labels[k].box))
                        << angle << ' ' << column << ' ' << i << ' ' << k;
        }
}

TEST(Overviews, AStrobeShowsSixInstantsAndALength) {
    const render::figure::Figure figure = overview_of("strobe", "");
    const auto& shapes = figure.panels[0].shapes;
    EXPECT_EQ(std::ranges::count_if(shapes, [](const auto& s) { return s.points.size() > 2; }), 6);  // beams
    EXPECT_THAT(shapes.back().markup, HasSubstr("mm"));
}

// A bouncing rigid beam: each collision is one impact.
render::figure::Figure bounces(const std::string& cam_speed, const std::string& end) {
    return testing::simulated(R"({"cam": {"speed": )" + cam_speed +
                              R"(}, "beam": {"model": "rigid"}, "time": {"end": )" + end +
                              R"(}, "contact": {"restitution": 0.5},
        "outputs": [{"type": "figure", "figure": "impact-maps"}]})");
}

TEST(Overviews, MapsHaveAPointForEachImpact) {
    const auto figure = bounces("1", "1.2");
    ASSERT_EQ(figure.panels.size(), 4u);
    const std::size_t impacts = figure.panels[1].series[0].x.size();
    EXPECT_GE(impacts, 5u);
    EXPECT_NEAR(figure.panels[1].series[0].x[0], 0.277394 / (2 * M_PI), 1e-5);
    EXPECT_EQ(figure.panels[2].series[0].x.size(), impacts - 1);  // the last has no next
    EXPECT_EQ(figure.panels[3].series[0].x, figure.panels[1].series[0].x);
    EXPECT_LT(figure.panels[3].series[0].y[0], 0);     // the hub falls
    EXPECT_EQ(figure.panels[0].y.to, 1.05);            // restitutions below 1 have the axis up to 1
    EXPECT_EQ(bounces("0", "1.2").panels.size(), 2u);  // a cam at rest has no phases
}

TEST(Overviews, MapsOfFewImpactsAreRejected) {
    EXPECT_THAT([] { bounces("1", "0.4"); },
                ::testing::ThrowsMessage<render::PictureError>(HasSubstr("only 1 impact from 0 s to 0.4 s, too few")));
}

// One collision of many impacts has a row alone.
TEST(Overviews, MapsOfOneCollisionAreARow) {
    EXPECT_EQ(testing::simulated(R"({"beam": {"modes": 8}, "contact": {"model": "restitution"}, "time": {"end": 0.3},
                                     "outputs": [{"type": "figure", "figure": "impact-maps"}]})")
                  .panels.size(),
              2u);
}

TEST(Overviews, TakeAnIntervalAndNoOtherKeysOfSeries) {
    const auto report = [](const std::string& keys) {
        return testing::read(R"({"outputs": [{"type": "figure", )" + keys + "}]}").report();
    };
    EXPECT_THAT(report(R"("figure": "strobe", "channels": ["theta"])"), HasSubstr("belongs to the figure"));
    EXPECT_THAT(report(R"("figure": "deflection", "from": 0.1)"), HasSubstr("belongs to the figure"));
    EXPECT_THAT(report(R"("figure": "kymograph", "from": 0.1, "to": 0.1)"), HasSubstr("is not before the end"));
}

TEST(Overviews, KeysOfOtherFiguresAreRejectedWithTheNamesOfThese) {
    const std::map<std::string_view, std::string> values{{"channels", "[\"theta\"]"},
                                                         {"panels", "[{\"channels\": [\"theta\"]}]"},
                                                         {"x", "\"t\""},
                                                         {"comparison", "\"overlay\""},
                                                         {"compare", "[{}, {}]"},
                                                         {"notes", "[]"},
                                                         {"impacts", "true"},
                                                         {"residuals", "false"},
                                                         {"horizon", "true"},
                                                         {"value", "\"class\""}};
    for (const FigureType& type : figure_types())
        for (const std::string_view key : keys_of_figures()) {
            const std::string value = values.contains(key) ? values.at(key) : "1";
            const std::string report =
                testing::read(fmt::format(R"({{"outputs": [{{"type": "figure", "figure": "{}", "{}": {}}}]}})",
                                          type.name, key, value))
                    .report();
            const auto rejected = HasSubstr(fmt::format("{} belongs to the figure", key));
            if (type.takes(key))
                EXPECT_THAT(report, Not(rejected)) << type.name;
            else
                EXPECT_THAT(report, AllOf(rejected, HasSubstr(list_of_figures_with(key)))) << type.name;
        }
}

// The shape of `modes --json` is the deflection by its own coordinate q alone, in sign and form.
TEST(Exports, CoordinatesHaveTheSignOfTheModes) {
    for (const char* basis : {"cantilever", "hub-beam"}) {
        const Reading reading = testing::read(std::string(R"({"cam": null, "beam": {"modes": 3, "basis": ")") + basis +
                                              R"("}, "time": {"end": 0.02}})");
        ASSERT_TRUE(reading.scene) << reading.report();
        const sim::Problem& problem = reading.scene->problem;
        sim::Request request;
        request.end_time = 0.02;
        request.tables.push_back({{0.0003, 0.003, 0.005, 0.02},
                                  {{sim::ChannelKind::tip_deflection, 0},
                                   {sim::ChannelKind::q, 1},
                                   {sim::ChannelKind::q, 2},
                                   {sim::ChannelKind::q, 3}}});
        const sim::Result result = sim::simulate(problem, request);
        const bool held = std::string(basis) == "cantilever";
        const std::vector<sim::Mode> modes = sim::natural_modes(problem, held ? std::optional(0.0) : std::nullopt);
        ASSERT_EQ(modes.size(), 3u);
        const sim::Table& table = result.tables[0];
        for (std::size_t row = 0; row < table.rows(); ++row) {
            double tip = 0;  // from the tangent at the root; here each mode has one coordinate
            for (std::size_t k = 0; k < 3; ++k) {
                const std::vector<sim::Vec2>& s = modes[k].shape;
                const double h = s[1].x, slope = (-11 * s[0].y + 18 * s[1].y - 9 * s[2].y + 2 * s[3].y) / (6 * h);
                tip += table.values[k + 1][row] / modes[k].q[k] * (s.back().y - s.front().y - slope);
            }
            EXPECT_NEAR(tip, table.values[0][row], 1e-3 * std::abs(table.values[0][row])) << basis << " " << row;
        }
    }
}

TEST(Exports, ImpactsCarryTheirStates) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM simulate s.json --impacts i.csv -q").code, 0);
    const output::ColumnTable impacts = output::read_table(folder / "i.csv");
    ASSERT_GE(impacts.rows(), 1u);
    const auto at = [&](const char* name) { return impacts.find(name)->front(); };
    const Reading reading = testing::read(R"({"time": {"end": 0.4}})");
    sim::Request request;
    request.end_time = 0.4;
    const std::vector<sim::Channel> channels = {{sim::ChannelKind::theta, 0},
                                                {sim::ChannelKind::theta_dot, 0},
                                                {sim::ChannelKind::contact_s, 0},
                                                {sim::ChannelKind::q, 1},
                                                {sim::ChannelKind::q, 2}};
    request.tables.push_back({{at("t_start"), at("t_end")}, channels});
    const sim::Result result = sim::simulate(reading.scene->problem, request);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::string key = name(channels[c]);
        const std::vector<double>& values = result.tables[0].values[c];
        EXPECT_NEAR(at(key.c_str()), values[0], 1e-9 * std::abs(values[0])) << key;
        EXPECT_NEAR(at((key + "_after").c_str()), values[1], 1e-9 * std::abs(values[1])) << key;
    }
}

TEST(Exports, LettersAreSerifOnRequest) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json angle -o a.pdf --font serif -q").code, 0);
    const std::string fonts = shell(folder, "pdffonts a.pdf 2>&1 || strings a.pdf").out;
    EXPECT_THAT(fonts, HasSubstr("LiberationSerif"));
    EXPECT_THAT(fonts, ::testing::Not(HasSubstr("LiberationSans")));
}

}  // namespace
}  // namespace beamcam::scenes
