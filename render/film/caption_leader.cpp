#include "render/film/caption_leader.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr int kTestedPieces = 64;  // of a line, whose ends are tested
constexpr int kRimSides = 96;
constexpr double kGrazing = 3;       // over or beside the rim [design px]
constexpr double kInsidePlate = 10;  // distance of its start from the edges of the box [design px]

Vec2 piece(Vec2 from, Vec2 to, int i) { return from + (to - from) * (static_cast<double>(i) / kTestedPieces); }

bool meets(const std::vector<Box>& labels, Vec2 from, Vec2 to, double u) {
    return std::ranges::any_of(labels, [&](const Box& label) {
        for (int i = 0; i <= kTestedPieces; ++i)
            if (const Vec2 at = piece(from, to, i); label.inset(-3 * u).overlaps({at.x, at.y, 1, 1})) return true;
        return false;
    });
}

// The projected rim of a disc of a larger or smaller radius [px].
std::vector<Vec2> rim_of(const MechanismScene& s, double more) {
    std::vector<Vec2> rim;
    for (int i = 0; s.shape.disc && i < kRimSides; ++i)
        rim.push_back(s.on(s.shape.disc->centre + down(2 * pi * i / kRimSides) * (s.shape.disc->radius + more)));
    return rim;
}

bool crosses(const std::vector<Vec2>& disc, Vec2 from, Vec2 to) {
    for (int i = 0; i <= kTestedPieces && !disc.empty(); ++i) {
        const Vec2 at = piece(from, to, i);
        bool inside = true;
        for (std::size_t k = 0; k < disc.size() && inside; ++k)
            inside = cross(disc[(k + 1) % disc.size()] - disc[k], at - disc[k]) < 0;
        if (inside) return true;
    }
    return false;
}

// The corner of a leader line to the contact that would otherwise cross the disc: a point of the tangent at the
// contact, on the caption's side. None if the straight line is clear, or no corner makes it so.
std::optional<Vec2> corner_of(const MechanismScene& s, Vec2 from, Vec2 to) {
    const double grazing = kGrazing * s.at.unit;  // a line to the rim itself always crosses it a little
    if (!crosses(rim_of(s, -grazing), from, to)) return std::nullopt;
    const std::vector<Vec2> around = rim_of(s, grazing);
    const Vec2 centre = s.on(s.shape.disc->centre), out = to - centre;
    const double radius = norm(out), side = dot(from - centre, Vec2{-out.y, out.x}) < 0 ? -1 : 1;
    if (!(radius > 0)) return std::nullopt;
    const Vec2 along = Vec2{-out.y, out.x} * (side / radius);
    for (int fifths = 2; fifths < 20; ++fifths)
        if (const Vec2 at = to + along * (0.2 * fifths * radius); !crosses(around, from, at)) return at;
    return std::nullopt;
}

// Moves the start of the line along the box.
CaptionLeader clear_of_labels(const MechanismScene& s, const std::vector<Box>& labels, const Box& plate,
                              std::vector<Vec2> points) {
    constexpr int kStarts = 16;
    const double inside = kInsidePlate * s.at.unit;
    if (points.size() > 2 && meets(labels, points[1], points[2], s.at.unit)) return {points, true};
    const auto is_clear = [&](Vec2 from) { return !meets(labels, from, points[1], s.at.unit); };
    if (is_clear(points[0])) return {points, false};
    for (int i = 0; i <= kStarts; ++i)
        if (const Vec2 from{plate.x + inside + (plate.w - 2 * inside) * i / kStarts, points[0].y}; is_clear(from)) {
            points[0] = from;
            return {points, false};
        }
    return {points, true};
}

}  // namespace

CaptionLeader straight_leader(const MechanismScene& s, const std::vector<Box>& labels, const Box& plate, Vec2 foot) {
    return clear_of_labels(s, labels, plate, {plate.centre(), foot});
}

CaptionLeader leader_around_disc(const MechanismScene& s, const std::vector<Box>& labels, const Box& plate, Vec2 foot) {
    const double inside = kInsidePlate * s.at.unit;
    const Vec2 from{plate.x + inside, plate.y + inside};
    if (const auto corner = corner_of(s, from, foot)) return clear_of_labels(s, labels, plate, {from, *corner, foot});
    return clear_of_labels(s, labels, plate, {from, foot});
}

}  // namespace beamcam::render
