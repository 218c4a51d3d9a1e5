#include "render/film/offscreen.hpp"

#include <algorithm>
#include <cstddef>

namespace beamcam::render {

void Offscreen::put(Canvas& onto, const Box& box, const std::function<void(Canvas&)>& draw) {
    const Image& whole = onto.image();
    if (image_.width != whole.width || image_.height != whole.height) image_ = Image(whole.width, whole.height);
    const auto x = static_cast<std::ptrdiff_t>(box.x), w = static_cast<std::ptrdiff_t>(box.w);
    for (auto y = static_cast<std::ptrdiff_t>(box.y); y < static_cast<std::ptrdiff_t>(box.bottom()); ++y)
        std::fill_n(image_.pixels.begin() + y * image_.width + x, w, 0u);
    Canvas canvas(image_, onto.fonts());
    canvas.halo_of_all = onto.halo_of_all;
    canvas.record = onto.record;
    draw(canvas);
    onto.image_part(image_, 0, 0, box);
}

}  // namespace beamcam::render
