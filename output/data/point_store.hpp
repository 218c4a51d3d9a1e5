// Points of a sweep in a file that grows as they are made, in any order: what a killed program made stays, and what the
// next one does not make again. Few of the numbers are held in memory.
//
// Doubles in memory order, for the program and machine that wrote them; each point with its checksum. What follows the
// last whole point is cut off when the file is opened again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "output/files/descriptor.hpp"
#include "output/files/errors.hpp"

namespace beamcam::output {

struct StoredPoint {
    std::uint64_t point = 0;
    int kind = 0, period = 0;  // class, by its number; turns of the cam
    double impacts_per_period = std::numeric_limits<double>::quiet_NaN();
    double exponent = std::numeric_limits<double>::quiet_NaN(), exponent_error = exponent;
    std::vector<double> samples;  // row by row
    std::vector<double> state;    // to go on from
    std::string failure;
};

// The results of a point that tables contain, but its class and period.
struct PointNumber {
    const char *name, *unit, *meaning;
    double StoredPoint::*value;
};
inline constexpr PointNumber kPointNumbers[] = {
    {"impacts_per_period", "1", "Impacts in a period; in a turn of the cam where there is none",
     &StoredPoint::impacts_per_period},
    {"exponent", "s-1", "Largest Lyapunov exponent", &StoredPoint::exponent},
    {"exponent_error", "s-1", "Its standard error", &StoredPoint::exponent_error},
};

class PointStore {
  public:
    // `identity` names the sweep. Throws IoError, also when another program has the file open, the file is no store of
    // points, or it has points of another sweep and these are not to be replaced.
    PointStore(std::filesystem::path file, std::uint64_t points, const std::string& identity, bool replace = false);
    ~PointStore();  // removes a file without points
    PointStore(const PointStore&) = delete;
    PointStore& operator=(const PointStore&) = delete;

    bool has(std::uint64_t point) const { return places_[point] != 0; }
    std::uint64_t count() const { return count_; }
    std::uint64_t numbers(std::uint64_t point) const { return numbers_[point]; }  // of its samples
    StoredPoint read(std::uint64_t point) const;                                  // throws IoError
    void add(const StoredPoint& point);  // any thread, each a point of its own; throws IoError
    void remove();                       // its name, when the points are elsewhere; those that are open can be read

  private:
    void open_again(const std::string& head, bool replace);
    void place(std::uint64_t point, std::uint64_t samples, std::uint64_t size);
    std::string text_at(std::uint64_t at, std::size_t size) const;

    std::filesystem::path path_;
    Descriptor file_;
    std::mutex mutex_;  // of adding
    std::uint64_t end_ = 0, count_ = 0;
    std::vector<std::uint64_t> places_;   // by point; 0: not there
    std::vector<std::uint32_t> numbers_;  // by point
};

}  // namespace beamcam::output
