#include "render/film/offscreen.hpp"

#include <cmath>

namespace beamcam::render {

template <class Visit>
void Offscreen::each_byte(const Box& box, const Visit& visit) {
    const auto x = static_cast<std::ptrdiff_t>(box.x), w = static_cast<std::ptrdiff_t>(box.w);
    std::size_t i = 0;
    for (auto y = static_cast<std::ptrdiff_t>(box.y); y < static_cast<std::ptrdiff_t>(box.bottom()); ++y) {
        auto* row = reinterpret_cast<std::uint8_t*>(image_.pixels.data() + y * image_.width + x);
        for (std::ptrdiff_t k = 0; k < 4 * w; ++k) visit(row[k], i++);
    }
}

void Offscreen::fill(const Canvas& like, const Box& box, const Draw& draw) {
    const Image& whole = like.image();
    if (image_.width != whole.width || image_.height != whole.height) image_ = Image(whole.width, whole.height);
    each_byte(box, [](std::uint8_t& byte, std::size_t) { byte = 0; });
    Canvas canvas(image_, like.fonts());
    canvas.outline = like.outline;
    canvas.casing = like.casing;
    canvas.record = like.record;
    draw(canvas);
}

void Offscreen::put(Canvas& onto, const Box& box, const Draw& draw, double opacity) {
    fill(onto, box, draw);
    const auto share = static_cast<unsigned>(std::lround(256 * opacity));
    if (share < 256) each_byte(box, [&](std::uint8_t& byte, std::size_t) { byte = std::uint8_t((byte * share) >> 8); });
    onto.image_part(image_, 0, 0, box);
}

void Offscreen::put_mean(Canvas& onto, const Box& box, std::size_t count,
                         const std::function<void(Canvas&, std::size_t)>& draw) {
    sums_.assign(4 * static_cast<std::size_t>(box.w) * static_cast<std::size_t>(box.h), 0);
    for (std::size_t which = 0; which < count; ++which) {
        fill(onto, box, [&](Canvas& canvas) { draw(canvas, which); });
        each_byte(box, [&](std::uint8_t& byte, std::size_t i) { sums_[i] = std::uint16_t(sums_[i] + byte); });
    }
    each_byte(box, [&](std::uint8_t& byte, std::size_t i) { byte = std::uint8_t((sums_[i] + count / 2) / count); });
    onto.image_part(image_, 0, 0, box);
}

}  // namespace beamcam::render
