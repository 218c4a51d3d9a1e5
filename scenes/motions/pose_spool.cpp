#include "scenes/motions/pose_spool.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace beamcam::scenes {
namespace {

// A record: the numbers of the pose, then three of each station.
constexpr std::size_t kPoseNumbers = 19;

std::array<double, kPoseNumbers> numbers_of(const sim::Pose& p) {
    const sim::Nearest n = p.nearest.value_or(sim::Nearest{});
    return {p.t,
            p.theta,
            p.theta_dot,
            p.cam_centre.x,
            p.cam_centre.y,
            p.disc_centre.x,
            p.disc_centre.y,
            p.cam_angle,
            double(p.nearest.has_value()),
            n.x,
            n.s,
            n.point.x,
            n.point.y,
            n.normal.x,
            n.normal.y,
            n.gap,
            n.force,
            n.friction,
            double(n.touching)};
}

sim::Pose pose_of(std::span<const double> v) {
    sim::Pose p;
    p.t = v[0];
    p.theta = v[1];
    p.theta_dot = v[2];
    p.cam_centre = {v[3], v[4]};
    p.disc_centre = {v[5], v[6]};
    p.cam_angle = v[7];
    if (v[8] != 0)
        p.nearest = sim::Nearest{.x = v[9],
                                 .s = v[10],
                                 .point = {v[11], v[12]},
                                 .normal = {v[13], v[14]},
                                 .gap = v[15],
                                 .force = v[16],
                                 .friction = v[17],
                                 .touching = v[18] != 0};
    return p;
}

}  // namespace

std::uint64_t PoseSpool::place(std::size_t frame) const {
    return sizeof(double) * frame * (kPoseNumbers + 3 * stations_);
}

void PoseSpool::put(std::size_t frame, const sim::Pose& pose) {
    if (frame >= frames_ || pose.centreline.size() != stations_ || pose.moment.size() != stations_)
        throw std::invalid_argument("a pose outside the spool, or with another number of stations");
    const std::array<double, kPoseNumbers> numbers = numbers_of(pose);
    std::vector<double> record(numbers.begin(), numbers.end());
    for (const sim::Vec2 r : pose.centreline) record.push_back(r.x), record.push_back(r.y);
    record.insert(record.end(), pose.moment.begin(), pose.moment.end());
    spool_.write(place(frame), std::as_bytes(std::span(record)));
}

void SampledPoses::put(std::size_t row, const sim::Pose& pose) {
    if (row == 0) count_ = fixed_;
    poses_.put(row, pose);
    count_ = std::max(count_, row + 1);
}

double PoseSpool::time(std::size_t frame) const {
    double t = 0;
    spool_.read(place(frame), std::as_writable_bytes(std::span(&t, 1)));
    return t;
}

sim::Pose PoseSpool::pose(std::size_t frame) const {
    std::vector<double> record(kPoseNumbers + 3 * stations_);
    spool_.read(place(frame), std::as_writable_bytes(std::span(record)));
    sim::Pose p = pose_of(record);
    const double* at = record.data() + kPoseNumbers;
    p.centreline.reserve(stations_);
    for (std::size_t i = 0; i < stations_; ++i, at += 2) p.centreline.push_back({at[0], at[1]});
    p.moment.assign(at, at + stations_);
    return p;
}

}  // namespace beamcam::scenes
