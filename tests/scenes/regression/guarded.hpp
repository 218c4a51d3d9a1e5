// A folder with baselines of four entries.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes::testing {

// Two pictures and a table of one motion, and one of another; written as people write it.
inline constexpr const char* kBaselines = R"({
  // guarded since the beginning
  "entries": {
    "fall": {"scene": "s.json", "output": {"type": "still", "at": "0.2 s", "size": [480, 270], "view": {"style": "flat"}}},
    "hit": {"scene": "s.json", "output": {"type": "frames", "from": 0.25, "to": 0.35, "fps": 20, "size": [480, 270],
            "view": {"style": "flat"}}, /* the first touch */},
    "motion": {"scene": "s.json", "output": {"type": "trajectory", "rate": 50, "channels": ["theta"]}},
    "fast": {"scene": {"time": {"end": 0.1}}, "set": ["cam.speed=5"], "output": {"type": "still", "at": 0.1, "size": [96, 96], "view": {"style": "flat"}}},
  },
}
)";

struct Guarded : Folder {
    Guarded() {
        write("b.json", kBaselines);
        write("s.json", R"({"time": {"end": 0.35}})");
    }
    // The tolerance of all entries: "\"channel\": 2".
    void allow(const std::string& tolerance) const {
        const std::string text = slurp(*this / "b.json");
        write("b.json", "{\"tolerance\": {" + tolerance + "},\n" + text.substr(text.find("//")));
    }
    Finished update() const { return shell(*this, "$BEAMCAM test b.json --update fall hit motion fast"); }
    void swap(const std::string& file, const std::string& from, const std::string& to) const {
        std::string text = slurp(*this / file);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << text;
        write(file, text.replace(at, from.size(), to));
    }
};

}  // namespace beamcam::scenes::testing
