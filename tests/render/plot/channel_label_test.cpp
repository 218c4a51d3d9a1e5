#include "render/plot/channel_label.hpp"

#include <gtest/gtest.h>

#include <set>

namespace beamcam::render {
namespace {

TEST(ChannelLabel, EveryChannelHasAName) {
    for (const sim::Channel& channel : sim::all_channels({}))
        for (const Lang lang : {Lang::en, Lang::zh}) EXPECT_GT(heading(channel.kind, lang).size(), 1u) << name(channel);
}

TEST(ChannelLabel, EveryChannelHasItsOwnSymbol) {
    std::set<std::string> seen;
    for (const sim::Channel& channel : sim::all_channels({}))
        EXPECT_TRUE(seen.insert(print_symbol(channel)).second) << name(channel);
}

}  // namespace
}  // namespace beamcam::render
