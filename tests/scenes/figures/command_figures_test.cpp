// Figures of commands: exponents and the assessment of accuracy.
#include "scenes/figures/command_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/base/error.hpp"
#include "render/draw/markup.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished;
using testing::Folder;
using ::testing::HasSubstr;
using testing::shell;

TEST(ExponentsFigure, ShowsTheErrorsOfItsValuesAndNotTheStart) {
    sim::Exponents e;
    e.lambda = {3.4412345, -8.21}, e.error = {0.0702, 1.3};
    e.time = {0.1, 1, 2}, e.history = {{30, 3.5, 3.44}, {-80, -8, -8.2}}, e.duration = 2;
    const auto figure = exponents_figure(e, {});
    ASSERT_EQ(figure.panels.size(), 2u);  // the largest, and the others
    EXPECT_EQ(figure.panels[1].series.at(0).y, (std::vector{-8, -8.2}));
    EXPECT_EQ(figure.panels[0].series.at(0).label, "$λ$_{1} = 3.441 ± 0.070 s^{−1}");
    EXPECT_EQ(figure.panels[1].series.at(0).label, "$λ$_{2} = −8.2 ± 1.3 s^{−1}");
    EXPECT_NEAR(figure.panels[1].bands.at(0).low.at(0), -8.21 - 1.3, 1e-12);
    EXPECT_THROW(exponents_figure(sim::Exponents{}, {}), render::PictureError);
}

sim::Accuracy measured() {
    sim::Accuracy a;
    a.until = a.end_time = 1;
    a.reference_error = 1e-9;
    a.target = 1e-4;
    a.most_modes = 8;
    const auto row = [](auto& r, double error, double seconds) {
        r.error = error;
        r.time = {seconds, 0.9 * seconds, 1.2 * seconds, 5};
    };
    for (const sim::Method method : {sim::Method::automatic, sim::Method::cvode_bdf})
        for (int digits = 3; digits <= 12; ++digits) {
            sim::WorkRow work;
            work.method = method;
            work.rtol = std::pow(10.0, -digits);
            row(work, work.rtol, (method == sim::Method::automatic ? 1e-3 : 1e-1) * digits);
            if (method == sim::Method::cvode_bdf && digits > 8) work.error.reset();  // took too long
            a.work.push_back(work);
        }
    for (const int modes : {2, 4, 8}) {
        sim::ModesRow count;
        count.modes = modes;
        row(count, std::pow(10.0, -modes), 1e-3 * modes);
        a.modes.push_back(count);
    }
    sim::ContactRow stiffer;
    stiffer.change = "stiffness +1 %";
    stiffer.error = 2e-3;
    a.contact.push_back(stiffer);
    return a;
}

TEST(AccuracyFigure, HasAPointForEachRunAndNoneForThoseLeftOut) {
    const render::figure::Figure figure = accuracy_figure(measured(), {});
    ASSERT_EQ(figure.panels.size(), 2u);
    const auto& work = figure.panels[0].series;
    ASSERT_EQ(work.size(), 2u);
    EXPECT_EQ(work[0].label, "auto");
    EXPECT_EQ(work[0].x.size(), 10u);
    EXPECT_DOUBLE_EQ(work[0].x[0], 3);  // ms
    EXPECT_EQ(work[0].y.back(), 1e-9);  // not below the error of the reference
    EXPECT_EQ(work[1].x.size(), 6u);
    EXPECT_THAT(figure.panels[1].series[0].x, ::testing::ElementsAre(2, 4));  // 8 is what they are compared with
    EXPECT_THROW(accuracy_figure({}, {}), render::PictureError);
}

TEST(AccuracyFigure, IsWrittenInEveryFormatWithItsScene) {
    const Folder folder;
    folder.write("s.json", R"({"cam": null, "beam": {"model": "rigid"}, "time": {"end": 0.05}})");
    const Finished made = shell(
        folder, "$BEAMCAM accuracy s.json --repeats 1 -o a.png -o a.svg -o a.pdf -o a.json --lang zh --column ieee");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(testing::slurp(folder / "a.svg"), HasSubstr("width=\"88.9mm\""));
    for (const char* file : {"a.png", "a.svg", "a.pdf"})
        EXPECT_THAT(shell(folder, std::string("$BEAMCAM info --scene ") + file).out, HasSubstr("\"rigid\"")) << file;
    EXPECT_EQ(shell(folder, "$BEAMCAM accuracy s.json -o a.eps").code, 2);
}

}  // namespace
}  // namespace beamcam::scenes
