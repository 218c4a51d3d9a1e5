#include <cmath>

#include "output/data/table_difference.hpp"
#include "output/image/picture_difference.hpp"
#include "output/image/png.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

Raster plain(int width, int height, std::uint8_t grey) {
    Raster r(width, height);
    for (std::size_t i = 0; i < r.rgba.size(); ++i) r.rgba[i] = i % 4 == 3 ? 255 : grey;
    return r;
}
void set(Raster& r, int x, int y, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    std::uint8_t* p = r.rgba.data() + (r.at(x, y) - r.rgba.data());
    p[0] = red, p[1] = green, p[2] = blue;
}

TEST(PictureDifference, OfAPictureWithItselfIsNothing) {
    const PictureDifference d = difference(plain(20, 10, 90), plain(20, 10, 90));
    EXPECT_TRUE(d.identical());
    EXPECT_EQ(d.changed, 0u);
    EXPECT_EQ(d.ssim, 1);
    EXPECT_TRUE(d.box.empty());
}

TEST(PictureDifference, CountsPixelsBoxAndLargestChannel) {
    const Raster a = plain(40, 30, 200);
    Raster b = a;
    set(b, 7, 3, 200, 190, 200);
    set(b, 12, 20, 0, 200, 201);
    const PictureDifference d = difference(a, b);
    EXPECT_EQ(d.changed, 2u);
    EXPECT_EQ(d.largest, 200);
    EXPECT_EQ(d.box.left, 7);
    EXPECT_EQ(d.box.top, 3);
    EXPECT_EQ(d.box.right, 13);
    EXPECT_EQ(d.box.bottom, 21);
    EXPECT_DOUBLE_EQ(d.share(), 2.0 / 1200);
}

TEST(PictureDifference, TheThresholdExcusesSmallStepsOnly) {
    const Raster a = plain(16, 16, 100);
    Raster b = a;
    set(b, 3, 3, 102, 100, 100);
    set(b, 9, 9, 103, 100, 100);
    EXPECT_EQ(difference(a, b, 2).changed, 1u);
    EXPECT_EQ(difference(a, b, 2).box.left, 9);
    EXPECT_EQ(difference(a, b, 3).changed, 0u);
    EXPECT_EQ(difference(a, b, 3).largest, 3);
    EXPECT_FALSE(difference(a, b, 3).identical());
}

// Two plain pictures have no variance: (2ab + c₁)/(a² + b² + c₁).
TEST(PictureDifference, SimilarityOfPlainPicturesIsTheClosedForm) {
    const double c1 = 0.01 * 255 * 0.01 * 255;
    for (const auto& [width, height] : {std::pair{64, 48}, {5, 7}}) {
        const PictureDifference d = difference(plain(width, height, 100), plain(width, height, 140));
        EXPECT_NEAR(d.ssim, (2 * 100 * 140 + c1) / (100 * 100 + 140 * 140 + c1), 1e-9);
    }
}

TEST(PictureDifference, SimilarityAgreesWithFFmpegs) {
    Scratch scratch;
    Raster a = plain(64, 48, 0), b = a;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto grey = static_cast<std::uint8_t>((x * 13 + y * 7) % 256);
            const auto other = static_cast<std::uint8_t>(std::min(255, grey + (x * y) % 30));
            set(a, x, y, grey, grey, grey);
            set(b, x, y, other, other, other);
        }
    write_png(scratch / "a.png", to_image(a));
    write_png(scratch / "b.png", to_image(b));
    // Both as plain grey, so that FFmpeg's one plane is our brightness.
    const std::string text = output_of("cd '" + scratch.path().string() +
                                       "' && ffmpeg -v info -i a.png -i b.png -lavfi "
                                       "'[0]format=gray[a];[1]format=gray[b];[a][b]ssim' -f null - 2>&1");
    const std::size_t at = text.find("SSIM Y:");
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NEAR(difference(a, b).ssim, std::stod(text.substr(at + 7)), 2e-5);
}

TEST(PictureDifference, PictureShowsChangesInVermilionInsideAFrame) {
    const Raster a = plain(40, 40, 0);
    Raster b = a;
    set(b, 20, 20, 255, 255, 255);
    const Raster p = difference_picture(a, b);
    EXPECT_EQ(std::vector<int>(p.at(20, 20), p.at(20, 20) + 3), (std::vector<int>{0xd5, 0x5e, 0x00}));
    EXPECT_EQ(std::vector<int>(p.at(20, 16), p.at(20, 16) + 3), (std::vector<int>{0x00, 0x72, 0xb2}));
    EXPECT_EQ(int(p.at(0, 0)[0]), 191);  // black faded to a quarter
    // At the border the frame is cut, not written elsewhere.
    Raster corner = a;
    set(corner, 0, 39, 9, 9, 9);
    EXPECT_EQ(difference_picture(a, corner).width, 40);
}

TEST(PictureDifference, OfTwoSizesIsABug) {
    EXPECT_THROW(difference(plain(2, 3, 0), plain(3, 2, 0)), std::logic_error);
}

// ---- tables --------------------------------------------------------------------------------------

ColumnTable table(std::vector<double> t, std::vector<double> x) {
    return {{{"t", {}, {}, std::move(t)}, {"x", {}, {}, std::move(x)}}};
}

TEST(TableDifference, FindsWhereAColumnDiffersMostAndHowMuchOfItsRange) {
    const TableDifference d = difference(table({0, 1, 2}, {0, 4, 2}), table({0, 1, 2}, {0, 4.5, 2.1}));
    ASSERT_EQ(d.columns.size(), 2u);
    EXPECT_TRUE(d.columns[0].identical);
    EXPECT_DOUBLE_EQ(d.columns[1].largest, 0.5);
    EXPECT_EQ(d.columns[1].t, 1);
    EXPECT_DOUBLE_EQ(d.columns[1].share, 0.125);
    EXPECT_FALSE(d.identical());
    EXPECT_TRUE(d.within(0.2));
    EXPECT_FALSE(d.within(0.1));
}

TEST(TableDifference, ComparesTheInstantsThatBothHave) {
    const TableDifference d = difference(table({0, 0.5, 1}, {1, 2, 3}), table({1, 0}, {3, 1}));
    EXPECT_EQ(d.rows_compared, 2u);
    EXPECT_TRUE(d.columns[1].identical);
    EXPECT_FALSE(d.same_shape());
    EXPECT_FALSE(d.within(1));
    EXPECT_EQ(difference(table({0, 1, 2}, {0, 0, 0}), table({0, 1, 2}, {0, 0, 9}), 1.5).columns[1].largest, 0);
}

TEST(TableDifference, AnEmptyCellIsNoNumber) {
    const TableDifference d = difference(table({0, 1}, {NAN, NAN}), table({0, 1}, {NAN, 2}));
    EXPECT_EQ(d.columns[1].undefined, 1u);
    EXPECT_FALSE(d.within(1));
    EXPECT_TRUE(difference(table({0}, {NAN}), table({0}, {NAN})).identical());
    EXPECT_FALSE(difference(table({0}, {0.0}), table({0}, {-0.0})).identical());  // every bit
    EXPECT_TRUE(difference(table({0}, {0.0}), table({0}, {-0.0})).within(0));
}

TEST(TableDifference, RowsWithoutAnInstantBelongTogetherByTheirOrder) {
    const double inf = std::numeric_limits<double>::infinity();
    const ColumnTable some = table({1, NAN, 0.5, NAN, inf, -inf, 0}, {1, 2, 3, 4, 5, 6, 7});
    EXPECT_TRUE(difference(some, some).identical());
    EXPECT_EQ(difference(some, some).rows_compared, 7u);
    EXPECT_EQ(difference(some, table({1, NAN, 0.5, NAN, inf, -inf, 0}, {1, 2, 3, 9, 5, 6, 7})).columns[1].largest, 5);
    EXPECT_FALSE(difference(some, table({1, NAN, 0.5, 2, inf, -inf, 0}, {1, 2, 3, 4, 5, 6, 7})).same_shape());
    const ColumnTable none = table({NAN, NAN, NAN}, {1, 2, 3});
    EXPECT_TRUE(difference(none, none).identical());
}

TEST(TableDifference, MissingColumnsAreTold) {
    ColumnTable other = table({0}, {1});
    other.columns[1].name = "y";
    const TableDifference d = difference(table({0}, {1}), other);
    EXPECT_EQ(d.only_in_a, std::vector<std::string>{"x"});
    EXPECT_EQ(d.only_in_b, std::vector<std::string>{"y"});
    EXPECT_FALSE(d.within(1));
}

}  // namespace
}  // namespace beamcam::output
