#include "scenes/motions/pose_spool.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace beamcam::scenes {
namespace {

constexpr std::size_t kPoseNumbers = 19;  // of a record; then follow three numbers of each station

// The numbers of a record in their order, the time first.
template <class Pose, class Nearest, class Number>
std::array<Number*, kPoseNumbers> numbers_of(Pose& p, Nearest& n, Number& has_nearest, Number& touching) {
    return {&p.t,
            &p.theta,
            &p.theta_dot,
            &p.cam_centre.x,
            &p.cam_centre.y,
            &p.disc_centre.x,
            &p.disc_centre.y,
            &p.cam_angle,
            &has_nearest,
            &n.x,
            &n.s,
            &n.point.x,
            &n.point.y,
            &n.normal.x,
            &n.normal.y,
            &n.gap,
            &n.force,
            &n.friction,
            &touching};
}

}  // namespace

std::uint64_t PoseSpool::place(std::size_t row) const { return sizeof(double) * row * (kPoseNumbers + 3 * stations_); }

void PoseSpool::put(std::size_t row, const sim::Pose& pose) {
    if (row >= most_ || pose.centreline.size() != stations_ || pose.moment.size() != stations_)
        throw std::invalid_argument("a pose outside the spool, or with another number of stations");
    const sim::Nearest nearest = pose.nearest.value_or(sim::Nearest{});
    const double has_nearest = pose.nearest.has_value(), touching = nearest.touching;
    std::vector<double> record;
    for (const double* number : numbers_of(pose, nearest, has_nearest, touching)) record.push_back(*number);
    for (const sim::Vec2 r : pose.centreline) record.push_back(r.x), record.push_back(r.y);
    record.insert(record.end(), pose.moment.begin(), pose.moment.end());
    spool_.write(place(row), std::as_bytes(std::span(record)));
    count_ = std::max(row == 0 ? fixed_ : count_, row + 1);
}

double PoseSpool::time(std::size_t row) const {
    double t = 0;
    spool_.read(place(row), std::as_writable_bytes(std::span(&t, 1)));
    return t;
}

sim::Pose PoseSpool::pose(std::size_t row) const {
    std::vector<double> record(kPoseNumbers + 3 * stations_);
    spool_.read(place(row), std::as_writable_bytes(std::span(record)));
    sim::Pose p;
    sim::Nearest nearest;
    double has_nearest = 0, touching = 0;
    const double* at = record.data();
    for (double* number : numbers_of(p, nearest, has_nearest, touching)) *number = *at++;
    nearest.touching = touching != 0;
    if (has_nearest != 0) p.nearest = nearest;
    p.centreline.reserve(stations_);
    for (std::size_t i = 0; i < stations_; ++i, at += 2) p.centreline.push_back({at[0], at[1]});
    p.moment.assign(at, at + stations_);
    return p;
}

}  // namespace beamcam::scenes
