#include "render/film/body_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beamcam::render {
namespace {

// The panel's box in whole pixels; that of the lit view, whose bodies end inside it, with the gap around it for
// shadows.
Box picture_box(const MechanismScene& s) {
    const MechanismView& at = s.at;
    const Box wide = at.moved || s.view ? at.box : at.box.inset(-std::floor(10 * at.unit));
    const double x0 = std::clamp(std::floor(wide.x), 0.0, s.canvas.width() - 1.0),
                 y0 = std::clamp(std::floor(wide.y), 0.0, s.canvas.height() - 1.0);
    return {x0, y0, std::clamp(std::ceil(wide.right()), x0 + 1, double(s.canvas.width())) - x0,
            std::clamp(std::ceil(wide.bottom()), y0 + 1, double(s.canvas.height())) - y0};
}

// Pixels of the bodies in a pixel of the picture: vector graphics are enlarged and printed.
int fineness(const MechanismScene& s, const Box& box) {
    constexpr double kFinest = 3, kLargest = 4096;  // 288 dpi; [px]
    return s.canvas.is_vector() ? static_cast<int>(std::clamp(kLargest / std::max(box.w, box.h), 1.0, kFinest)) : 1;
}

BodyScene scaled(BodyScene scene, int fine, const Box& box) {
    if (fine == 1) return scene;
    const auto enlarge = [&](auto& vertices) {
        for (auto& v : vertices)
            for (float& each : v.pixel) each *= static_cast<float>(fine);
    };
    enlarge(scene.vertices), enlarge(scene.shadows);
    scene.fade *= fine;
    scene.seen = DirtyTiles(fine * static_cast<int>(box.w), fine * static_cast<int>(box.h));
    scene.seen.add_all();
    return scene;
}

}  // namespace

void BodyPicture::draw(const MechanismScene& s) {
    const MechanismView& at = s.at;
    const Box box = picture_box(s);
    DrawingCounts& counts = *at.context.counts;
    const int fine = fineness(s, box);
    if (!renderer_ || fine_ != fine) {
        renderer_ = make_body_renderer(fine * static_cast<int>(box.w), fine * static_cast<int>(box.h));
        fine_ = fine;
        drawn_.reset();
        ++counts.gl_contexts;
    }
    // Bodies have the panel's middle as their origin.
    Projection view = s.view ? *s.view : Projection::front(at.box.centre());
    view.centre = view.centre - Vec2{box.x, box.y};
    if (Drawn now{s.shape, view}; !(drawn_ == now)) {
        const Ground ground = !s.view ? Ground::wall : at.over_floor ? Ground::floor : Ground::none;
        const Stage stage{box, at.box.centre(), ground, at.wide, at.marks * at.zoom()};
        const BodyScene scene = scaled(body_scene(s.shape, at.palette, stage, view), fine, box);
        drawn_.reset();
        renderer_->draw(scene, image_);
        drawn_ = std::move(now), seen_ = scene.seen;
        ++counts.bodies_drawn;
    }
    if (s.canvas.is_vector()) return s.canvas.pixels(image_, box);
    DirtyTiles where(s.canvas.width(), s.canvas.height());
    seen_.for_each_run([&](double left, double top, double right, double bottom) {
        where.add({box.x + left, box.y + top, right - left - 1, bottom - top - 1});
    });
    s.canvas.image_tiles(image_, static_cast<int>(box.x), static_cast<int>(box.y), where);
}

}  // namespace beamcam::render
