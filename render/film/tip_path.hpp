// The path of the beam's tip: a fading trail of the last second.
#pragma once

#include <cstddef>
#include <vector>

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class TipPath {
  public:
    // A position of the drawn tip [px], with the hub angle [rad].
    struct Knot {
        double t;
        Vec2 at;
        double angle;
    };
    void add_frame(const Knot& knot);
    void add_between_frames(const Knot& knot);  // after the last frame that was added
    // To be called when all are added. Leaves out the knots between frames where the curve through the frames passes
    // within a pixel of them. A film of a period that was passed before it begins loops: its trail at the first frame
    // is the one at the last.
    void complete(const MechanismView& home);
    // The curve from the tip's position at a frame to the next one, in the view `home` of the fixed camera.
    std::vector<Vec2> piece(const MechanismView& home, std::size_t frame) const;
    void draw_trail(const MechanismScene& s, const MechanismView& home) const;

  private:
    struct Knots {
        std::vector<double> times;
        std::vector<Vec2> points;
        std::vector<double> angles;
        void add(const Knot& knot);
    };
    static std::vector<Vec2> curve_between(const MechanismView& home, const Knots& knots, std::size_t k);
    bool needs_between(const MechanismView& home, const Knots& of_frames, std::size_t frame) const;
    bool closes(const MechanismView& home) const;

    Knots knots_;
    std::vector<std::size_t> frames_;  // the knot of each
    std::vector<Vec2> seam_;           // of a film that loops: the curve from its last frame to its first
};

TipPath::Knot knot_of(const MechanismView& home, const sim::Pose& pose);

}  // namespace beamcam::render
