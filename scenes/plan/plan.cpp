#include "scenes/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::scenes {

bool Plan::needs_gl() const {
    return std::ranges::any_of(pictures, [](const PlannedPictures& p) { return p.view.style != render::Style::flat; });
}

std::string too_small(const Size& size) {
    return fmt::format("{} × {} is too small for them; increase \"size\", or remove panels", size.width, size.height);
}

std::string characters_without_font(const PictureOutput& p, const Scene& scene) {
    if (p.kind == PictureOutput::Kind::page) return {};
    std::string written = scene.title;
    for (const FilmEvent& event : p.span.events) written += event.text;
    for (const Compared& motion : p.compare) written += motion.label;
    for (const Measurement& data : scene.data) written += data.label;
    const std::string lost = render::characters_without_font(written);
    return lost.empty() ? lost : fmt::format("{} omits {}: no font has these characters", p.file, lost);
}

}  // namespace beamcam::scenes
