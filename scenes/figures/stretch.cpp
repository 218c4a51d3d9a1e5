#include "scenes/figures/stretch.hpp"

namespace beamcam::scenes {

Stretch stretch(const Scene& scene, const FigureOutput& how, int count, int stations, Studies& studies) {
    Stretch out{how.series.from, how.series.to.value_or(scene.end_time), 0, 0};
    out.study = studies.of(scene.problem, out.to, how.figure);
    std::vector<sim::PoseRequest>& poses = studies.request(out.study).poses;
    out.poses = poses.size();
    poses.push_back({.times = instants({out.from, out.to, count}), .stations = stations});
    return out;
}

}  // namespace beamcam::scenes
