#include "scenes/regression/result.hpp"

#include <algorithm>

namespace beamcam::scenes {

bool PassRule::passes(Verdict verdict) const {
    return verdict == Verdict::identical || (verdict == Verdict::equivalent && !strict) ||
           (verdict == Verdict::new_renderer && new_renderer != NewRenderer::fail);
}

bool PassRule::passes(const EntryResult& entry) const {
    return passes(entry.picture.value_or(Verdict::identical)) && passes(entry.motion.value_or(Verdict::identical));
}

Verdict EntryResult::verdict() const {
    return std::max(picture.value_or(Verdict::identical), motion.value_or(Verdict::identical));
}

ChangedFrames EntryResult::changed_frames() const {
    ChangedFrames changed;
    for (const auto& [number, frame] : frames)
        if (frame.verdict != Verdict::identical) changed.emplace_back(number, &frame);
    std::ranges::stable_sort(changed, std::greater(), [](const auto& each) { return each.second->weight(); });
    return changed;
}

}  // namespace beamcam::scenes
