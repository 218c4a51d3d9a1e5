// The page is taken apart as its own program does, and compared with the motion.
#include "render/film/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "render/film/film.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/plot/ticks.hpp"
#include "tests/scenes/outputs/filmed.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::HasSubstr, ::testing::Not;

render::FilmSetup setup_until(double end, double rate) {
    render::FilmSetup setup = testing::filmed_until(end, rate);
    setup.title = "a </script> & \"b\"";
    setup.fps = rate;
    return setup;
}

template <class Number>
std::vector<Number> decoded(const std::string& base64) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : base64) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
        count += 6;
        if (count >= 8) count -= 8, bytes += static_cast<char>(bits >> count & 255);
    }
    std::vector<Number> out(bytes.size() / sizeof(Number));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(Number));
    return out;
}

nlohmann::json data_of(const std::string& page) {
    const std::string before = "const d = ";
    const std::size_t from = page.find(before) + before.size();
    return nlohmann::json::parse(page.substr(from, page.find(";\n", from) - from));
}

// The texts of the user are put in as they are, also those that look like the names in player.html.
TEST(Page, ATitleMayLookLikeAPlaceOfThePage) {
    render::FilmSetup setup = setup_until(0.05, 100);
    for (const char* title : {"@DATA@", "@PAPER@ @TITLE@", "a@b@c", "@", "@@", "@INK"}) {
        setup.title = title;
        const std::string page = render::html_page(setup);
        EXPECT_THAT(page, HasSubstr("<title>" + std::string(title) + "</title>"));
        EXPECT_THAT(page, HasSubstr("<h1>" + std::string(title) + "</h1>"));
        EXPECT_THAT(page, HasSubstr("frictionless</span>"));  // the last parameter
        EXPECT_EQ(data_of(page)["title"], title);
    }
}

// The end of the scale: 1, 2 or 5 times a power of ten.
double largest_moment(const render::FilmSetup& setup) {
    double largest = 0;
    for (const sim::Pose& pose : setup.poses)
        for (const double moment : pose.moment) largest = std::max(largest, std::abs(moment));
    return render::round_up_125(largest);
}

TEST(Page, ItsPosesAgreeWithTheMotionToTheToleranceThatItStates) {
    const render::FilmSetup setup = setup_until(0.6, 1000);
    const nlohmann::json d = data_of(render::html_page(setup));
    const auto times = decoded<std::uint32_t>(d["times"]);
    const auto values = decoded<float>(d["values"]);
    const auto points = decoded<std::int16_t>(d["points"]);
    const auto roots = decoded<std::int8_t>(d["moments"]);
    const auto n = d["instants"].get<std::size_t>(), m = d["stations"].get<std::size_t>();
    ASSERT_EQ(times.size(), n);
    ASSERT_EQ(values.size(), 3 * n);
    ASSERT_EQ(points.size(), 2 * (m + 1) * n);
    ASSERT_EQ(roots.size(), m * n);
    std::vector<double> moments;
    for (const std::int8_t root : roots) moments.push_back(root * std::abs(root) / (127.0 * 127));
    const double scale = largest_moment(setup);
    EXPECT_LT(n, setup.poses.size());
    const double tick = d["tick"], quantum = d["quantum"], tolerance = d["tolerance"];
    EXPECT_EQ(tolerance, 1e-3);
    const double depth = beam_depth(setup.problem.beam);
    std::size_t low = 0;
    for (const sim::Pose& pose : setup.poses) {
        while (low + 2 < n && times[low + 1] * tick < pose.t - 1e-9) ++low;
        const double from = times[low] * tick, to = times[low + 1] * tick, share = (pose.t - from) / (to - from);
        const auto mix = [&](const auto& all, std::size_t row, std::size_t i) {
            return all[row * low + i] * (1 - share) + all[row * (low + 1) + i] * share;
        };
        EXPECT_NEAR(mix(values, 3, 0), pose.theta, tolerance + 1e-6) << pose.t;
        EXPECT_NEAR(mix(values, 3, 1), pose.cam_angle, tolerance + 1e-6) << pose.t;
        const render::DrawnBeam beam = render::drawn_beam(setup.problem, pose, d["factor"], depth);
        for (std::size_t i = 0; i < m; ++i) {
            const std::size_t at = i * (beam.line.size() - 1) / (m - 1);
            const sim::Vec2 middle = beam.line[at] + beam.left[at] * ((beam.low + beam.high) / 2);
            const sim::Vec2 found{quantum * mix(points, 2 * (m + 1), 2 * i),
                                  quantum * mix(points, 2 * (m + 1), 2 * i + 1)};
            EXPECT_LE(norm(found - middle), tolerance + quantum) << pose.t << " s, station " << i;
            EXPECT_NEAR(mix(moments, m, i), pose.moment[at] / scale, render::kPageMomentTolerance + 2 / 127.0)
                << pose.t;
        }
    }
}

// At a first touch, between two poses, there is no force yet.
TEST(Page, ForcesBeginAndEndWithTheirContacts) {
    const render::FilmSetup setup = setup_until(0.3, 1000);
    const nlohmann::json d = data_of(render::html_page(setup));
    const auto times = decoded<std::uint32_t>(d["times"]);
    const auto values = decoded<float>(d["values"]);
    const double tick = d["tick"];
    ASSERT_FALSE(setup.impacts.empty());
    int found = 0;
    for (const sim::Impact& impact : setup.impacts)
        for (const double t : {impact.t_start, impact.t_end.value_or(impact.t_start)})
            for (std::size_t i = 0; i < times.size(); ++i)
                if (std::abs(times[i] * tick - t) < 1e-9) {
                    EXPECT_EQ(values[3 * i + 2], 0) << t;
                    ++found;
                }
    EXPECT_EQ(found, 2 * static_cast<int>(setup.impacts.size()));
}

// Between poses of a millisecond most of an impact would be missed.
TEST(Page, StatesTheForceOfImpacts) {
    const testing::Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.6}})");
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM render s.json -o s.html").code, 0);
    const nlohmann::json d = data_of(testing::slurp(folder / "s.html"));
    const auto times = decoded<std::uint32_t>(d["times"]);
    const auto values = decoded<float>(d["values"]);
    const double tick = d["tick"];

    sim::Request impacts;
    impacts.end_time = 0.6;
    const sim::Result motion = sim::simulate({}, impacts);
    ASSERT_FALSE(motion.impacts.empty());
    sim::Request forces;
    forces.tables.push_back({{}, {*sim::channel_named("contact_force")}});
    for (const sim::Impact& i : motion.impacts)
        for (double share = 0.03; share < 1; share += 0.07)
            forces.tables.front().times.push_back(i.t_start + share * (i.t_end.value_or(0.6) - i.t_start));
    const std::vector<double> at = forces.tables.front().times;
    const std::vector<double> expected = sim::simulate({}, forces).tables.front().values.front();
    const double largest = std::ranges::max(expected);
    EXPECT_GT(largest, 100);
    for (std::size_t k = 0; k < at.size(); ++k) {
        const double t = at[k];
        const auto after = static_cast<std::size_t>(
            std::ranges::upper_bound(times, t, {}, [&](std::uint32_t ticks) { return ticks * tick; }) - times.begin());
        ASSERT_LT(after, times.size());
        const double low = times[after - 1] * tick, share = (t - low) / (times[after] * tick - low),
                     force = values[3 * after - 1] * (1 - share) + values[3 * after + 2] * share;
        EXPECT_NEAR(force, expected[k], 5e-3 * largest) << t;
    }
}

// The arc of the angle and its letter are clear of the disc, wherever it has turned, and outside a large hub.
TEST(Page, TheArcOfTheAngleIsBetweenHubAndCam) {
    render::FilmSetup setup = setup_until(0.05, 500);
    EXPECT_NEAR(data_of(render::html_page(setup))["arc"], 0.86 * (0.25 - 0.1 - 0.02), 1e-9);
    setup.problem.cam->centre = {0.6, 0};
    EXPECT_EQ(data_of(render::html_page(setup))["arc"], 0.14);
    setup.problem.cam.reset();
    EXPECT_EQ(data_of(render::html_page(setup))["arc"], 0.14);
    setup.problem.hub.radius = 0.3;
    EXPECT_NEAR(data_of(render::html_page(setup))["arc"], 0.4, 1e-9);
}

TEST(Page, TheSameMotionGivesTheSameBytes) {
    const render::FilmSetup setup = setup_until(0.3, 500);
    EXPECT_EQ(render::html_page(setup), render::html_page(setup));
}

TEST(Page, StandsAloneAndItsTitleIsText) {
    const std::string page = render::html_page(setup_until(0.05, 500));
    for (const char* outside : {"http:", "https:", "src=", "@import", "url("})
        EXPECT_THAT(page, Not(HasSubstr(outside)));
    EXPECT_THAT(page, HasSubstr("<title>a &lt;/script&gt; &amp; \"b\"</title>"));
    EXPECT_EQ(data_of(page)["title"], "a </script> & \"b\"");
    EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
}

TEST(Page, NamesTheSpeedOfTheCamInTheUnitsOfTheScene) {
    render::FilmSetup setup = setup_until(0.05, 500);
    setup.problem.cam->speed = 10;
    EXPECT_EQ(data_of(render::html_page(setup))["cam"]["turning"], " = 10\u00A0rad/s");
    setup.units.speed = render::SpeedUnit::rpm;
    EXPECT_EQ(data_of(render::html_page(setup))["cam"]["turning"], " = 95.5\u00A0rpm");
}

// No mark of player.html is left.
TEST(Page, SpeaksTheLanguageOfTheScene) {
    const testing::Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "page", "lang": "zh"}]})");
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM run s.json").code, 0);
    const std::string page = testing::slurp(folder / "s.html");
    EXPECT_THAT(page, HasSubstr("<html lang=\"zh\">"));
    for (const char* words : {">播放</button>", "\"暂停\"", ">速度 ", "\"挠度 ×\""})
        EXPECT_THAT(page, HasSubstr(words));
    EXPECT_THAT(page, ::testing::Not(::testing::ContainsRegex("@[A-Z]+@")));
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM render s.json -o t.html --lang zh").code, 0);
    EXPECT_EQ(page, testing::slurp(folder / "t.html"));
}

// A still motion is two instants.
TEST(Page, WhatAStraightLineTellsIsLeftOut) {
    render::FilmSetup setup = setup_until(0.001, 1000);
    const sim::Pose pose = setup.poses.front();
    setup.poses.assign(101, pose);
    for (int k = 0; k <= 100; ++k) setup.poses[static_cast<std::size_t>(k)].t = 0.01 * k;
    EXPECT_EQ(data_of(render::html_page(setup))["instants"], 2);
}

TEST(Page, IsAnOutputAndAFileOfRender) {
    const testing::Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}, "outputs": [{"type": "page", "theme": "dark"}]})");
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM run s.json").code, 0);
    EXPECT_THAT(testing::slurp(folder / "s.html"), HasSubstr("color-scheme: dark"));
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM render s.json -o t.html --theme dark").code, 0);
    EXPECT_EQ(testing::slurp(folder / "s.html"), testing::slurp(folder / "t.html"));
    EXPECT_THAT(testing::shell(folder, "$BEAMCAM run s.json").err, HasSubstr("kept ./s.html: up to date"));
}

}  // namespace
}  // namespace beamcam::scenes
