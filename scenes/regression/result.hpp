// The results of a regression test: of each picture, of each entry, and of all; and the rule by which they pass.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"

namespace beamcam::scenes {

struct FrameResult {
    Verdict verdict = Verdict::identical;
    std::string sha256;  // of the drawn pixels
    PictureComparison comparison;
    bool compared = false;                               // with a reference picture
    std::filesystem::path expected, actual, difference;  // files, if they exist
    double weight() const { return compared ? comparison.weight() : 1e300; }
    bool has_same_pixels() const { return compared && comparison.identical(); }
};

using ChangedFrames = std::vector<std::pair<long, const FrameResult*>>;  // with their numbers

struct EntryResult {
    std::string name;
    std::optional<Verdict> picture, motion;                // absent: not compared
    std::map<long, FrameResult> frames;                    // by number, from 0
    std::vector<std::string> picture_lines, motion_lines;  // messages
    std::vector<std::filesystem::path> written, removed;   // by an update
    double seconds = 0;                                    // drawing and comparison
    int exit_code = 0;  // of the program if the entry could not be compared; 0: it was compared

    Verdict verdict() const {
        return std::max(picture.value_or(Verdict::identical), motion.value_or(Verdict::identical));
    }
    bool could_not_run() const { return verdict() == Verdict::not_run; }
    bool is_updated() const { return !written.empty() || !removed.empty(); }
    bool differs() const { return verdict() >= Verdict::different; }  // or was not compared
    std::vector<std::string> digests() const {                        // of all frames
        std::vector<std::string> all;
        for (const auto& [number, frame] : frames) all.push_back(frame.sha256);
        return all;
    }
    // The frames that are not identical; those that changed most come first.
    ChangedFrames changed_frames() const {
        ChangedFrames changed;
        for (const auto& [number, frame] : frames)
            if (frame.verdict != Verdict::identical) changed.emplace_back(number, &frame);
        std::ranges::stable_sort(changed, std::greater(), [](const auto& each) { return each.second->weight(); });
        return changed;
    }
};

// The rule by which verdicts pass.
struct PassRule {
    bool strict = false;  // only identical pictures and motions pass
    bool passes(Verdict verdict) const {
        return verdict == Verdict::identical || (verdict == Verdict::equivalent && !strict);
    }
    bool passes(const EntryResult& entry) const {  // its picture and its motion pass
        return passes(entry.picture.value_or(Verdict::identical)) && passes(entry.motion.value_or(Verdict::identical));
    }
};

struct RegressionResult {
    std::string baselines;  // file name as given
    std::vector<EntryResult> entries;
    std::size_t simulations = 0, pictures = 0;
    double seconds = 0;
    bool is_updated() const { return std::ranges::any_of(entries, &EntryResult::is_updated); }
};

}  // namespace beamcam::scenes
