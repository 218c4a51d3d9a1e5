// The panel of the mechanism: support, cam, beam, their marks and letters (mechanism_marks.hpp, mechanism_labels.hpp).
#pragma once

#include <memory>
#include <vector>

#include "render/film/body_picture.hpp"
#include "render/film/impact_rings.hpp"
#include "render/film/mechanism_cameras.hpp"
#include "render/film/mechanism_legend.hpp"
#include "render/film/tip_path.hpp"

namespace beamcam::render {

class MechanismPanel final : public FilmPanel {
  public:
    MechanismPanel(const FilmContext& context, const PanelSlot& slot);

    void draw_background(Canvas& canvas) const override;
    bool cuts_names() const override { return legend_.cuts_names(); }
    bool animates_while_paused(int frame) const override;
    void draw(Canvas& canvas, int frame, Style style, BodyPicture& bodies) const override;

    Camera camera(int frame) const { return cameras_.view(frame).look.camera; }
    int empty_frames() const;  // frames in which no part of the mechanism is in the camera's view
    DrawnBeam beam(int frame) const { return at_.beam_of(at_.member, frame); }

  private:
    bool has_marks(int frame) const;  // of contact, on beams and cams
    void draw_still(Canvas& canvas, const MechanismView& at) const;
    Trace trace_until(double t) const;
    void draw_moving(Canvas& canvas, const MechanismView& at, int frame, Style style, BodyPicture& bodies) const;

    MechanismView at_;
    MechanismLegend legend_;
    MechanismCameras cameras_;
    TipPath tip_path_;
    ImpactRings rings_;
};

}  // namespace beamcam::render
