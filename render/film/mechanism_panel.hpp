// The panel of the mechanism: support, cam, beam, and their marks and labels (mechanism_marks.hpp).
#pragma once

#include <memory>
#include <vector>

#include "render/film/impact_rings.hpp"
#include "render/film/lit_mechanism.hpp"
#include "render/film/mechanism_cameras.hpp"
#include "render/film/mechanism_legend.hpp"
#include "render/film/swept_region.hpp"
#include "render/film/tip_path.hpp"

namespace beamcam::render {

class MechanismPanel final : public FilmPanel {
  public:
    MechanismPanel(const FilmContext& context, const PanelSlot& slot);

    std::unique_ptr<State> make_state() const override;
    void draw_background(Canvas& canvas) const override;
    bool animates_while_paused(int frame) const override;
    void draw(Canvas& canvas, int frame, Style style, State* state) const override;

    // Boxes of the legend and the scale bar [px].
    std::vector<Box> legend() const { return legend_.boxes(); }
    // Boxes of the labels of angle, speed and force in a frame, by drawing its flat view [px].
    std::vector<Box> labels(Canvas& canvas, int frame) const;
    Camera camera(int frame) const { return cameras_.view(frame).look.camera; }
    int empty_frames() const;  // frames in which no part of the mechanism is in the camera's view
    DrawnBeam beam(int frame) const { return at_.beam_of(at_.member, frame); }

  private:
    struct ThreadState;  // a FilmPanel::State
    void draw_still(Canvas& canvas, const MechanismView& at) const;
    void draw_bodies(const MechanismScene& s, Style style, ThreadState& threads) const;
    void draw_moving(Canvas& canvas, const MechanismView& at, int frame, Style style, ThreadState& threads,
                     std::vector<Box>* labels = nullptr) const;

    void add_survey(SweptRegion& swept) const;
    void add_tips_before(int frame);
    LabelNeeds add_frames(SweptRegion& swept, SweptRegion& in_contact, std::vector<Followed>& followed);
    std::vector<Box> moving_under(const Callout& caption) const;
    void place_captions();

    MechanismView at_;
    MechanismLegend legend_;
    MechanismCameras cameras_;
    Box lit_box_;  // contains the lit mechanism at all frames, shadows included; whole pixels
    MechanismLabels labels_;
    TipPath tip_path_;
    ImpactRings rings_;
};

}  // namespace beamcam::render
