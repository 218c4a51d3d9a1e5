#include "render/film/lit_mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beamcam::render {

Box lit_box(const Box& shapes, const Box& within, double unit) {
    const Box wide = shapes.inset(-26 * unit - 4);
    const double x0 = std::clamp(std::floor(wide.x), within.x, within.right() - 1),
                 y0 = std::clamp(std::floor(wide.y), within.y, within.bottom() - 1);
    const double x1 = std::clamp(std::ceil(wide.right()), x0 + 1, within.right()),
                 y1 = std::clamp(std::ceil(wide.bottom()), y0 + 1, within.bottom());
    return {x0, y0, x1 - x0, y1 - y0};
}

namespace {

LitScene lit_scene(const MechanismShape& shape, const MechanismLook& look, const Palette& palette, Vec2 origin) {
    LitScene scene;
    scene.unit = look.unit;
    scene.shadow = palette.shadow;
    const double u = look.unit;
    if (shape.disc) {
        const DiscShape& d = *shape.disc;
        // A small disc has no visible chamfer, so it is darker.
        const double small = std::clamp(1 - d.radius / (24 * u), 0.0, 1.0);
        const Color steel = mix(palette.steel, palette.pin, 0.7 * small);
        const double chamfer = std::min(4.5 * u, 0.06 * d.radius);
        if (d.outline.empty()) {
            scene.behind.push_back(
                {d.centre - origin, d.radius, d.axis - origin, d.bore, chamfer, steel, Finish::turned, true});
        } else {  // a boss covers the middle of the cam
            scene.cam.emplace();
            scene.cam->closed = true;
            scene.cam->chamfer = chamfer;
            for (const Vec2 p : d.outline) {
                scene.cam->face.push_back(p - origin);
                scene.cam->back.push_back(d.axis - origin);
                scene.cam->colors.push_back(steel);
            }
            scene.behind.push_back(
                {d.axis - origin, 1.9 * d.bore, d.axis - origin, d.bore, 0.4 * d.bore, steel, Finish::turned, false});
        }
        scene.behind.push_back(
            {d.mark - origin, d.mark_radius, {}, 0, 0, mix(palette.steel, rgb(0), 0.25), Finish::dimple, false});
    }
    for (std::size_t i = 0; i < shape.face.size(); ++i) {
        scene.strip.face.push_back(shape.face[i] - origin);
        scene.strip.back.push_back(shape.back[i] - origin);
    }
    scene.strip.colors = shape.colors;
    scene.strip.chamfer = std::min(6 * u, 0.2 * norm(shape.back[0] - shape.face[0]));
    scene.front.push_back(
        {shape.hinge - origin, shape.hub, {}, 0, 4 * u, mix(palette.steel, rgb(0xFFFFFF), 0.15), Finish::turned, true});
    scene.front.push_back({shape.hinge - origin, shape.pin, {}, 0, 0, palette.pin, Finish::dome, false});
    return scene;
}

// Adds the tiles that a disc intersects in a picture of this height.
void add_round(DirtyTiles& tiles, int height, Vec2 centre, double radius) {
    constexpr double kRow = DirtyTiles::kHeight;
    const double from = std::min<double>(height, std::max(0.0, centre.y - radius)),
                 to = std::min<double>(height, centre.y + radius);
    for (int row = static_cast<int>(std::floor(from / kRow)); row * kRow < to; ++row) {
        const double y = row * kRow;
        const double off = std::clamp(centre.y, y, y + kRow) - centre.y;
        const double half = std::sqrt(std::max(0.0, radius * radius - off * off));
        tiles.add({centre.x - half, y, 2 * half, kRow - 1});
    }
}

// The tiles that the scene, whose corner is at `origin`, can cover, shadows included.
DirtyTiles lit_tiles(const LitScene& scene, Vec2 origin, int width, int height) {
    DirtyTiles tiles(width, height);
    const double around = 26 * scene.unit + 4;
    for (const auto* rounds : {&scene.behind, &scene.front})
        for (const LitRound& r : *rounds) add_round(tiles, height, origin + r.centre, r.radius + around);
    if (scene.cam) {
        double reach = 0;
        for (const Vec2 p : scene.cam->face) reach = std::max(reach, norm(p - scene.cam->back.front()));
        add_round(tiles, height, origin + scene.cam->back.front(), reach + around);
    }
    const LitStrip& strip = scene.strip;
    for (std::size_t i = 0; i + 1 < strip.face.size(); ++i) {
        Bounds piece;
        for (Vec2 p : {strip.face[i], strip.face[i + 1], strip.back[i], strip.back[i + 1]})
            piece.add(origin + p, around);
        tiles.add(piece.box());
    }
    return tiles;
}

}  // namespace

LitRenderer& LitMechanism::renderer(const MechanismView& at, const Box& within) {
    if (!renderer_) {
        renderer_ = make_lit_renderer(static_cast<int>(within.w), static_cast<int>(within.h));
        ++at.context.counts->gl_contexts;
    }
    return *renderer_;
}

void LitMechanism::draw(Canvas& canvas, const MechanismShape& shape, const MechanismView& at, const Box& within) {
    LitRenderer& gl = renderer(at, within);
    const LitScene scene = lit_scene(shape, at.look, at.palette, {within.x, within.y});
    if (shape_ != shape) {
        const int width = static_cast<int>(within.w), height = static_cast<int>(within.h);
        const double before = gl.read_back;
        DirtyTiles now = lit_tiles(scene, {}, width, height), changed = now;
        const bool again = std::exchange(shape_, std::nullopt).has_value();
        if (again) changed.add(tiles_);
        gl.draw(scene, again ? &changed : nullptr, image_);
        tiles_ = std::move(now);
        shape_ = shape;
        at.context.counts->read_back += gl.read_back - before;
        ++at.context.counts->mechanisms_lit;
    }
    canvas.image_tiles(image_, static_cast<int>(within.x), static_cast<int>(within.y),
                       lit_tiles(scene, {within.x, within.y}, canvas.image().width, canvas.image().height));
}

void LitMechanism::draw_solid(const MechanismScene& s, const std::vector<Color>& rim) {
    LitRenderer& gl = renderer(s.at, s.at.box);
    Perspective inside = *s.view;
    inside.centre = inside.centre - Vec2{s.at.box.x, s.at.box.y};
    SolidScene scene = solid_scene(s.shape, s.at.palette, s.at.box, inside, s.at.wide, s.at.look.unit, rim);
    // A near camera cuts bodies at the edges of the panel, and their shadows as well.
    scene.fade *= std::clamp(2 - s.at.zoom(), 0.0, 1.0);
    if (SolidPicture now{s.shape, inside, rim}; !(solid_ == now)) {
        const double before = gl.read_back;
        solid_.reset();
        gl.draw(scene, image_);
        solid_ = std::move(now);
        s.at.context.counts->read_back += gl.read_back - before;
        ++s.at.context.counts->mechanisms_lit;
    }
    const int x = static_cast<int>(s.at.box.x), y = static_cast<int>(s.at.box.y);
    DirtyTiles where(s.canvas.image().width, s.canvas.image().height);
    scene.seen.for_each_run([&](double left, double top, double right, double bottom) {
        where.add({x + left, y + top, right - left - 1, bottom - top - 1});
    });
    s.canvas.image_tiles(image_, x, y, where);
}

}  // namespace beamcam::render
