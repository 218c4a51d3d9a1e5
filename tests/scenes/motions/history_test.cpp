// Measurements of earlier runs, and the estimates of plans.
#include "scenes/motions/history.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Folder;

TEST(History, KnowsWhatWasNotedAndTakesTheFirstNameItKnows) {
    const Folder folder;
    History history(folder / "c");
    EXPECT_FALSE(history.find({"a"}));
    history.note({"a", "kind of a"}, 4, 2, 100);
    history.save();
    const History later(folder / "c");
    EXPECT_EQ(later.find({"a"})->seconds, 0.5);
    EXPECT_EQ(later.find({"a"}, 3)->seconds, 1.5);
    EXPECT_EQ(later.find({"b", "kind of a"})->amount, 25);
    EXPECT_FALSE(later.find({"b"}));
    History other(folder / "c");
    other.note({"a"}, 1, 1.5, 75);
    EXPECT_EQ(other.find({"a"})->seconds, 1);  // between the runs
}

TEST(History, WhateverIsWrongWithTheFileNothingIsKnown) {
    for (const char* text : {"", "something else\n", "beamcam times 1\nno numbers\na\t1\nb\tnan\t1\nc\t-1\t1\n"}) {
        const Folder folder;
        folder.write("times", text);
        History history(folder / "");
        for (const char* name : {"no numbers", "a", "b", "c"}) EXPECT_FALSE(history.find({name})) << text;
        history.note({"a"}, 1, 1, 1);
        history.save();
        EXPECT_TRUE(History(folder / "").find({"a"})) << text;
    }
    History nowhere;
    nowhere.note({"a"}, 1, 1, 1);
    nowhere.save();
}

}  // namespace
}  // namespace beamcam::scenes
