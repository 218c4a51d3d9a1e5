// The mechanism in its plane: support, cam, beam, and what is written on them: angle, force arrow, traces, flashes.
#pragma once

#include <memory>
#include <vector>

#include "render/draw/growing.hpp"
#include "render/film/panel.hpp"
#include "render/gl/lit.hpp"
#include "render/mechanism/mechanism.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render {

class MechanismPanel final : public Panel {
  public:
    MechanismPanel(const FilmFacts& facts, const PanelSlot& slot);

    std::unique_ptr<State> make_state() const override;
    void draw_ground(Canvas& canvas) const override;
    void grow(Canvas& kept, const Image& ground, int frame, bool anew, State* state) const override;
    Box growing() const override { return whole_path() ? box_ : Box{}; }
    bool plays(int frame) const override;
    void draw(Canvas& canvas, int frame, Style style, State* state) const override;

    // Of what stands beside the mechanism without moving: which motion it is, the scale bar [px].
    std::vector<Box> words() const;
    const Camera& camera() const { return look_.camera; }
    DrawnBeam beam(int frame) const { return beam_of(member_, frame); }

  private:
    struct Threads;  // State
    struct Flash {
        int frame = 0;              // the first that shows it
        double material_angle = 0;  // on the disc, from its mark [rad]
    };
    // One frame as it is being drawn.
    struct Scene {
        Canvas& canvas;
        int frame;
        const sim::Pose& pose;
        const DrawnBeam& beam;
        const MechanismShape& shape;
        const MechanismPanel& panel;
        const Perspective* view;  // of the solid view; null: as it is

        Vec2 on(Vec2 flat) const;  // where a point of the plane of motion [px of the flat view] is seen
        Vec2 px(Vec2 world) const { return on(panel.px(world)); }
        void arc(Vec2 flat_centre, double radius, double from, double to) const;
    };
    Perspective view_of(int frame) const;
    void draw_solid(const Scene& s, const Trace& trace, Threads& threads) const;
    std::vector<Color> rim_colors(const Trace& trace, double now) const;

    DrawnBeam beam_of(int member, int frame) const;
    DrawnBeam surveyed_beam(int member, std::size_t k) const;
    const Motion& motion() const { return facts_.motion(member_); }
    const sim::Problem& problem() const { return motion().problem; }
    Vec2 px(Vec2 world) const { return look_.camera.to_pixels(world); }

    void place_camera();
    OccupancyGrid still_room() const;
    void take_beam(OccupancyGrid& room, const std::vector<Vec2>& face, const std::vector<Vec2>& back) const;
    void note_extent(OccupancyGrid& room);
    bool has_label() const;
    bool has_bar() const;
    void place_words(OccupancyGrid room);
    void note_path();
    void find_flashes();
    void draw_lit(const MechanismShape& shape, Canvas& canvas, Threads& threads) const;
    void scale_bar(Canvas& canvas) const;
    void label(Canvas& canvas) const;
    double scale_length() const;
    TextStyle label_style() const;
    std::string label_words(Canvas& canvas, int member) const;

    void ghosts(const Scene& s) const;
    void ghost_bodies(const Scene& s) const;
    struct Outline {
        std::vector<Vec2> edge, foot;  // [px]
    };
    Outline ghost_outline(const Scene& s, const DrawnBeam& beam) const;
    bool whole_path() const;  // of the tip, instead of a trail
    void trail(const Scene& s) const;
    void angle_arc(const Scene& s) const;
    void turning_arrow(const Scene& s) const;
    Vec2 seen(Vec2 flat, const Perspective* view) const;
    Box speed_box(Vec2 axis, double w, const Perspective* view) const;
    void base_line(const Scene& s) const;
    void disc_marks(const Scene& s, const Trace& trace) const;
    void disc_letters(const Scene& s, Color ink) const;
    void beam_trace(const Scene& s, const Trace& trace) const;
    double flash_frames() const;
    void flash(const Scene& s) const;
    void force_arrow(const Scene& s) const;
    void callout(const Scene& s) const;

    const FilmFacts& facts_;
    const Palette& palette_;
    Box box_;
    int member_;
    bool ghosts_;             // the other motions are drawn here as outlines
    std::vector<int> shown_;  // the motions that the camera has to show
    double u_;
    double marks_ = 1;  // mark_unit
    bool small_;
    std::optional<Box> label_, bar_;  // where they stand
    MechanismLook look_;
    Box lit_box_;             // what the lit mechanism ever covers, shadows included; whole pixels
    double wide_ = 0;         // of the beam across the plane of motion, in the solid view [px]
    double arc_room_ = 0;     // largest radius of the angle's arc that stays in the box at every frame [px]
    std::vector<Vec2> tips_;  // drawn tip of every frame [px]
    std::vector<int> moved_;  // of every frame: how many before it moved, so that a freeze costs the trail nothing
    GrowingPath path_;        // the same in the panel's box
    std::vector<Flash> flashes_;
};

}  // namespace beamcam::render
