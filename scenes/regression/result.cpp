#include "scenes/regression/result.hpp"

#include <algorithm>

namespace beamcam::scenes {

double FrameResult::weight() const {
    if (verdict == Verdict::identical) return -1;
    if (!compared || !comparison.same_size()) return 1e300;
    return static_cast<double>(comparison.difference.changed) + comparison.difference.largest / 256.0;
}

bool PassRule::passes(Verdict verdict) const {
    switch (verdict) {
        case Verdict::identical:
            return true;
        case Verdict::equivalent:
            return !strict;
        case Verdict::new_renderer:
            return new_renderer != NewRenderer::fail;
        case Verdict::different:
        case Verdict::missing:
            break;
    }
    return false;
}

bool PassRule::passes(const EntryResult& entry) const {
    return passes(entry.picture.value_or(Verdict::identical)) && passes(entry.motion.value_or(Verdict::identical));
}

Verdict EntryResult::verdict() const {
    return worse(picture.value_or(Verdict::identical), motion.value_or(Verdict::identical));
}

const std::pair<const long, FrameResult>* EntryResult::worst() const {
    const std::pair<const long, FrameResult>* worst = nullptr;
    for (const auto& frame : frames)
        if (frame.second.verdict != Verdict::identical && (!worst || frame.second.weight() > worst->second.weight()))
            worst = &frame;
    return worst;
}

std::size_t EntryResult::frames_with(Verdict verdict) const {
    return static_cast<std::size_t>(
        std::count_if(frames.begin(), frames.end(), [verdict](const auto& f) { return f.second.verdict == verdict; }));
}

}  // namespace beamcam::scenes
