// The texts of a film: within the picture, apart, and in every script.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/film/panel.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

void texts_keep_apart(FilmSetup setup) {
    const Box all{0, 0, double(setup.width), double(setup.height)};
    Film film(std::move(setup));
    for (int frame : {0, 20, 25, 40}) {
        const std::vector<Box> texts = film.geometry(frame).texts;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_TRUE(all.contains(texts[i], 0.5)) << frame << ": " << i;
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(texts[i].overlaps(texts[j]))
                    << "frame " << frame << ": texts " << i << " and " << j << " at " << texts[i].x << "," << texts[i].y
                    << " and " << texts[j].x << "," << texts[j].y;
        }
    }
}

TEST(PanelTexts, TextKeepsWithinThePictureAndApart) {
    texts_keep_apart(everything());
    texts_keep_apart(with_data());
}
TEST(PanelTexts, TextOfComparisonsKeepsApart) {
    texts_keep_apart(compared(Comparison::panels));
    texts_keep_apart(compared(Comparison::ghosts));
}

// All texts of the user choose the fonts, also the names of measured data.
TEST(Films, DataWithAChineseNameShowIt) {
    FilmSetup setup = with_data();
    ASSERT_FALSE(setup.data.empty());
    const auto widest_text = [&](const std::string& label) {
        setup.data.front().label = label;
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        Image scratch(1, 1);
        Canvas canvas(scratch, *context.fonts);
        return canvas.measure(context.data_labels.front(), {.size = 20}).w;
    };
    EXPECT_GT(widest_text("测量数据"), 60);
}

// Characters that no font has are removed instead of drawn as boxes.
TEST(PanelTexts, PictographsLeaveNoBoxes) {
    FilmSetup plain = test::synthetic_film({.duration = 0.1}), decorated = plain;
    for (FilmSetup* setup : {&plain, &decorated}) {
        setup->width = 960, setup->height = 540;
        setup->view.style = Style::flat;
    }
    plain.title = "Fall θ₀ = 45°";
    decorated.title = "Fall\U0001F680 θ₀ = 45°\U0001F44D\uFE0F";
    Film a(std::move(plain)), b(std::move(decorated));
    EXPECT_EQ(drawn(a, 2), drawn(b, 2));
}

TEST(Plates, OnlyAPictureWithRoomStatesTheFactor) {
    const auto states = [](int width, int height) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, width, height);
        setup.view.exaggeration = 5;
        return Film(std::move(setup)).states_exaggeration();
    };
    EXPECT_TRUE(states(1280, 720));
    EXPECT_FALSE(states(90, 60));
}

}  // namespace
}  // namespace beamcam::render
