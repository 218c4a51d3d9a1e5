// Messages about memory: what is known and what is a guess differ.
#include "render/base/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beamcam::render {
namespace {

using ::testing::StartsWith;

TEST(Limits, AShortMemoryIsOnlyPerhapsTheCauseOfAnError) {
    EXPECT_THAT(PerhapsOutOfMemory("the encoder rejects the film").what(),
                StartsWith("the encoder rejects the film; perhaps there was not enough memory"));
    EXPECT_THAT(out_of_memory_message(), StartsWith("not enough memory"));
}

}  // namespace
}  // namespace beamcam::render
