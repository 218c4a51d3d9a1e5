// Poses in unnamed temporary files (output/files/spool.hpp), so that memory does not grow with the film.
#pragma once

#include <cstddef>
#include <cstdint>

#include "output/files/spool.hpp"
#include "render/film/film.hpp"
#include "sim/observe/request.hpp"

namespace beamcam::scenes {

// Poses, stored without loss.
class PoseSpool final : public render::PoseStore {
  public:
    // Poses at the times of the request, which count from the beginning, and those in contact, up to its limit.
    explicit PoseSpool(const sim::PoseRequest& request)
        : fixed_(request.times.size()),
          most_(fixed_ + request.contacts),
          stations_(static_cast<std::size_t>(request.stations)),
          count_(fixed_) {}

    // Rows of the request in any order, also repeatedly, from one thread; row 0 discards the earlier contact poses.
    // Throws std::invalid_argument for another number of stations.
    void put(std::size_t row, const sim::Pose& pose);
    std::size_t size() const override { return count_; }
    double time(std::size_t row) const override;
    sim::Pose pose(std::size_t row) const override;

  private:
    std::uint64_t place(std::size_t row) const;

    output::Spool spool_;
    std::size_t fixed_, most_, stations_, count_;
};

}  // namespace beamcam::scenes
