#include "render/base/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace beamcam::render {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Runs while the data of the process are limited to 8 GiB, far more than the tests need.
TEST(Limits, AShortMemoryIsNamedWithItsLimit) {
    rlimit before = {};
    getrlimit(RLIMIT_DATA, &before);
    if (before.rlim_cur == RLIM_INFINITY && !memory_limit()) {
        EXPECT_THAT(out_of_memory_message(), Not(HasSubstr("MiB")));
    }
    rlimit limited = before;
    limited.rlim_cur = rlim_t{8} << 30;
    ASSERT_EQ(setrlimit(RLIMIT_DATA, &limited), 0);
    const std::string message = out_of_memory_message();
    setrlimit(RLIMIT_DATA, &before);
    EXPECT_THAT(message, StartsWith("not enough memory; this process may use 8192 MiB (ulimit -v)"));
}

}  // namespace
}  // namespace beamcam::render
