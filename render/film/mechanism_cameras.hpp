// The cameras of a mechanism's panel: the one that shows everything, the moving one of each frame, and in the solid
// view their projections.
#pragma once

#include <optional>
#include <vector>

#include "render/film/camera.hpp"
#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class MechanismCameras {
  public:
    explicit MechanismCameras(const MechanismView& home);
    // `parts`: of every frame.
    void follow(const std::vector<Followed>& parts);

    bool near() const { return !home_.whole && moves(); }  // at some frame the view does not show everything
    bool moves() const { return !shots_.empty(); }         // the view of a mechanism, which an overview accompanies
    // An overview fades in while the mechanism's view comes near: 0 to 1.
    double presence(int frame) const;
    bool move_at(int frame) const;  // since the previous frame
    MechanismView view(int frame) const;
    // Of the solid view; none in flat and lit films.
    std::optional<Projection> perspective(const MechanismView& at, int frame) const;

  private:
    void fit_solid_view();
    Projection looking(const MechanismView& at, double yaw, double pitch) const;

    const MechanismView& home_;
    Vec2 solid_shift_;                // of the projection in the solid view, so that everything is in the panel [px]
    double solid_zoom_ = 0.9;         // of the solid view; nearer parts are larger than in the flat view
    std::vector<CameraFrame> shots_;  // of every frame; empty: the camera always shows everything
};

}  // namespace beamcam::render
