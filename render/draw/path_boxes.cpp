#include "render/draw/path_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {

void PathBoxes::move_to(Vec2 p) { start_ = at_ = p, open_ = true; }

void PathBoxes::line_to(Vec2 p) {
    if (!open_) start_ = at_ = p;  // as Cairo does
    add_line(at_, p);
    at_ = p, open_ = true;
}

void PathBoxes::close() {
    if (open_) add_line(at_, start_);
    at_ = start_;
}

void PathBoxes::arc(Vec2 c, double radius, double from, double to) {
    const auto place = [&](double angle) { return c + Vec2{std::cos(angle), -std::sin(angle)} * radius; };
    if (!open_) start_ = at_ = place(from);
    add_line(at_, place(from));
    add_arc(c, radius, from, to);
    at_ = place(to), open_ = true;
}

void PathBoxes::circle(Vec2 c, double radius) {
    add_arc(c, radius, 0, 2 * std::numbers::pi);
    start_ = at_ = c + Vec2{radius, 0}, open_ = true;
}

void PathBoxes::rectangle(const Box& b) {
    add(b);
    start_ = at_ = {b.x, b.y}, open_ = true;
}

void PathBoxes::clear() {
    boxes_.clear();
    open_ = false;
}

Box PathBoxes::around() const {
    Bounds all;
    for (const Box& box : boxes_) all.add({box.x, box.y}), all.add({box.right(), box.bottom()});
    return all.box();
}

// Boxes about as long as a tile, so that a slanted line marks few tiles.
void PathBoxes::add_line(Vec2 from, Vec2 to) {
    constexpr double kPieceLength = 48, kMostPieces = 1000;
    const int pieces = static_cast<int>(std::clamp(std::ceil(norm(to - from) / kPieceLength), 1.0, kMostPieces));
    for (int i = 0; i < pieces; ++i) {
        const Vec2 a = from + (to - from) * (double(i) / pieces), b = from + (to - from) * (double(i + 1) / pieces);
        add({std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)});
    }
}

void PathBoxes::add_arc(Vec2 c, double radius, double from, double to) {
    const int pieces = static_cast<int>(std::clamp(std::ceil(std::abs(to - from) / 0.4), 1.0, 64.0));
    const double step = (to - from) / pieces;
    const double bulge = radius * (1 - std::cos(std::min(std::abs(step) / 2, std::numbers::pi)));
    for (int i = 0; i < pieces; ++i) {
        const double p = from + i * step, q = p + step;
        const double ax = radius * std::cos(p), ay = -radius * std::sin(p), bx = radius * std::cos(q),
                     by = -radius * std::sin(q);
        add(Box{c.x + std::min(ax, bx), c.y + std::min(ay, by), std::abs(bx - ax), std::abs(by - ay)}.inset(-bulge));
    }
}

}  // namespace beamcam::render
