// Poses and trajectories in unnamed temporary files (output/files/spool.hpp), so that memory does not grow with the
// film.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "output/files/spool.hpp"
#include "render/film/film.hpp"
#include "sim/observe/trajectory.hpp"

namespace beamcam::scenes {

// The numbers of a growing trajectory.
class NumberSpool final : public sim::NumberSource {
  public:
    void add(std::span<const double> numbers) {
        spool_.write(sizeof(double) * size_, std::as_bytes(numbers));
        size_ += numbers.size();
    }
    std::uint64_t size() const override { return size_; }
    void read(std::uint64_t from, std::span<double> into) const override {
        spool_.read(sizeof(double) * from, std::as_writable_bytes(into));
    }

  private:
    output::Spool spool_;
    std::uint64_t size_ = 0;
};

// A fixed number of poses, stored without loss.
class PoseSpool final : public render::PoseStore {
  public:
    PoseSpool(std::size_t frames, int stations) : frames_(frames), stations_(static_cast<std::size_t>(stations)) {}

    // Frames in any order, also repeatedly, from one thread. Throws std::invalid_argument for another number of
    // stations.
    void put(std::size_t frame, const sim::Pose& pose);
    std::size_t size() const override { return frames_; }
    double time(std::size_t frame) const override;
    sim::Pose pose(std::size_t frame) const override;

  private:
    std::uint64_t place(std::size_t frame) const;

    output::Spool spool_;
    std::size_t frames_, stations_;
};

// Poses at fixed times, and poses in contact up to a limit, for the choice of scales.
class SampledPoses final : public render::PoseStore {
  public:
    SampledPoses(std::size_t fixed, std::size_t contacts, int stations)
        : poses_(fixed + contacts, stations), fixed_(fixed), count_(fixed) {}

    // Rows as in sim::PoseRequest; row 0 discards the earlier contact poses.
    void put(std::size_t row, const sim::Pose& pose);
    std::size_t size() const override { return count_; }
    double time(std::size_t k) const override { return poses_.time(k); }
    sim::Pose pose(std::size_t k) const override { return poses_.pose(k); }

  private:
    PoseSpool poses_;
    std::size_t fixed_, count_;
};

}  // namespace beamcam::scenes
