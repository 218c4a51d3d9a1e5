#include "render/plot/placement.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace beamcam::render {
namespace {

TEST(Placement, ABoxGoesWhereNothingIs) {
    OccupancyGrid taken({0, 0, 100, 100}, 1.5);
    taken.cover(Box{50, 0, 50, 50});
    taken.cover(std::vector<Vec2>{{0, 90}, {100, 90}});
    const Place place = best_place(taken, 30, 20, 2);
    EXPECT_EQ(place.cost, 0);
    EXPECT_FALSE(place.box.overlaps({50, 0, 50, 50}));
}

}  // namespace
}  // namespace beamcam::render
