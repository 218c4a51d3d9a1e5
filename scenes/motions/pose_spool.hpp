// What a long film needs of its motions, kept in files without a name (output/spool.hpp): memory does not grow with
// the film.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "output/files/spool.hpp"
#include "render/film/film.hpp"
#include "sim/observe/trajectory.hpp"

namespace beamcam::scenes {

// A trajectory that grows at its end.
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

// So many poses of so many stations, to the bit.
class PoseSpool final : public render::PoseStore {
  public:
    PoseSpool(std::size_t frames, int stations) : frames_(frames), stations_(static_cast<std::size_t>(stations)) {}

    // Any frame at any time, again and again; by one thread. Throws std::invalid_argument for other stations.
    void put(std::size_t frame, const sim::Pose& pose);
    std::size_t size() const override { return frames_; }
    double time(std::size_t frame) const override;
    sim::Pose pose(std::size_t frame) const override;

  private:
    std::uint64_t place(std::size_t frame) const;

    output::Spool spool_;
    std::size_t frames_, stations_;
};

// So many poses at fixed instants, and those in contact, as many as come up to a limit.
class SampledPoses final : public render::PoseStore {
  public:
    SampledPoses(std::size_t fixed, std::size_t contacts, int stations)
        : poses_(fixed + contacts, stations), fixed_(fixed), count_(fixed) {}

    // By sim::PoseRequest; row 0 begins anew.
    void put(std::size_t row, const sim::Pose& pose);
    std::size_t size() const override { return count_; }
    double time(std::size_t k) const override { return poses_.time(k); }
    sim::Pose pose(std::size_t k) const override { return poses_.pose(k); }

  private:
    PoseSpool poses_;
    std::size_t fixed_, count_;
};

}  // namespace beamcam::scenes
