// The mechanism in its plane: support, cam, beam, and what is written on them (mechanism_marks.hpp).
#pragma once

#include <memory>
#include <vector>

#include "render/film/impact_rings.hpp"
#include "render/film/lit_mechanism.hpp"
#include "render/film/mechanism_words.hpp"
#include "render/film/tip_path.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render {

class MechanismPanel final : public FilmPanel {
  public:
    MechanismPanel(const FilmContext& context, const PanelSlot& slot);

    std::unique_ptr<State> make_state() const override;
    void draw_background(Canvas& canvas) const override;
    void accumulate(Canvas& kept, const Image& background, int frame, bool restart, State* state) const override;
    Box accumulated_box() const override { return whole_path() ? at_.box : Box{}; }
    bool animates_while_paused(int frame) const override;
    void draw(Canvas& canvas, int frame, Style style, State* state) const override;

    // Of what stands beside the mechanism without moving: which motion it is, the scale bar [px].
    std::vector<Box> words() const { return words_.boxes(); }
    // Where the angle, the speed and the force are written in a frame of the flat view, which is drawn for it [px].
    std::vector<Box> labels(Canvas& canvas, int frame) const;
    const Camera& camera(int frame) const {
        return shots_.empty() ? at_.look.camera : shots_[static_cast<std::size_t>(frame)].camera;
    }
    int empty_frames() const;  // in which the camera sees no part of the mechanism
    DrawnBeam beam(int frame) const { return at_.beam_of(at_.member, frame); }

  private:
    struct ThreadState;  // State
    Perspective view_of(const MechanismView& at, int frame) const;
    void find_shots();
    void draw_still(Canvas& canvas, const MechanismView& at) const;
    void draw_bodies(const MechanismScene& s, Style style, ThreadState& threads) const;
    void draw_exposures(const MechanismScene& s, Style style, ThreadState& threads) const;
    void draw_moving(Canvas& canvas, const MechanismView& at, int frame, Style style, ThreadState& threads,
                     std::vector<Box>* labels = nullptr) const;

    void note_survey(SweptRegion& swept) const;
    LabelNeeds note_frames(SweptRegion& swept, SweptRegion& pressed);

    bool view_strobes() const { return at_.context.setup->view.strobe; }
    bool whole_path() const;  // of the tip, instead of a trail, on a layer of its own
    void draw_tip_path(const MechanismScene& s) const;

    MechanismView at_;
    MechanismWords words_;
    Box lit_box_;  // what the lit mechanism ever covers, shadows included; whole pixels
    MechanismLabels labels_;
    TipPath tip_path_;
    ImpactRings rings_;
    std::vector<Followed> followed_;  // of every frame
    std::vector<CameraFrame> shots_;  // of every frame; empty: always all of it
};

}  // namespace beamcam::render
