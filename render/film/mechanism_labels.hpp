// Where the letters and numbers of a mechanism stand: each keeps one place over the whole film, the nearest to what it
// belongs to that nothing moving ever meets. One that stands far off gets a line to what it belongs to, unless it is
// the letter of the angle, which is left out; where no place is free, it fades while something moves through it.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/plot/placement.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {

struct MechanismView;

// An arrow of force.
struct ForceArrow {
    Vec2 foot, normal;  // [m]
    double force = 0;   // [N]
    bool is_peak = false;
};

struct LabelPlace {
    Vec2 middle, size;           // [m], [px]; where a camera that shows all has it
    Vec2 base;                   // what it stands beside, at the same distance in pixels however near the camera is [m]
    std::vector<float> opacity;  // of each frame; empty: always 1

    double opacity_at(int frame) const { return opacity.empty() ? 1 : opacity[static_cast<std::size_t>(frame)]; }
};

struct MechanismLabels {
    double speed_way = -0.30 * std::numbers::pi;  // from the cam's axis to its arrow [rad]
    double arc_radius = 0;                        // of the angle's arc [px]
    std::optional<LabelPlace> angle, speed, force;
};

// What of the mechanism moves, as the film shows it: its cells have weight 1.
class SweptRegion {
  public:
    SweptRegion(const MechanismView& at, const Box& area, double cell);

    void add_beam(const std::vector<Vec2>& face, const std::vector<Vec2>& back);  // edges of a section [px]
    void add_way(const std::vector<Vec2>& from, const std::vector<Vec2>& to);     // of one of the edges
    void add_disc(Vec2 centre, double radius);                                    // [px]
    void add_arrow(const ForceArrow& arrow);
    void add_fixed();  // hubs, supports, the horizontal, and the discs wherever they turn

    OccupancyGrid room;

  private:
    void add_piece(const std::array<Vec2, 4>& corners);

    const MechanismView& at_;
    std::vector<Vec2> shifts_;  // from the front of a body to the rest of it as the solid view shows it [px]
};

struct LabelNeeds {
    Range angles;                    // over the film, as the arc shows them [rad]
    double arc_room = 0;             // largest radius of the arc that fits [px]
    std::vector<ForceArrow> arrows;  // of every frame that has one
};

// Places the labels, and covers them in `swept`. `pressed`: what stands in the frames that show a force.
MechanismLabels place_labels(const MechanismView& at, const LabelNeeds& needs, SweptRegion& swept,
                             SweptRegion& pressed);

// As they are written.
std::string speed_label(const MechanismView& at);
std::string force_label(const MechanismView& at, const ForceArrow& arrow);
// Size of the letters of the cam's speed and of the force [px].
double label_size(const MechanismView& at);
// The least size of the letters on a mechanism [px].
double least_letter(const MechanismView& at);
// Of a design pixel of the angle's letter [px].
double angle_letter(const MechanismView& at);

}  // namespace beamcam::render
