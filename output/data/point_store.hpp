// Points of a sweep in a file, in any order. PointStore grows as the points are made: those that a killed program made
// stay, and are not made again. A finished file holds the points of one part of a sweep, which `beamcam collect` joins.
//
// "beamcam points 2 IDENTITY SIZE\n", SIZE bytes that describe the sweep, then the points: doubles in memory order, for
// machines of the same kind, each point with its checksum. Every count and number that is read is checked: a file that
// somebody else made may be incomplete or refused, but never leads to a point that the sweep cannot have.
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

// The head of a file of points.
struct PointHead {
    std::string identity;     // names the sweep: a word without spaces
    std::string description;  // any text
};
// The part that all points of a sweep share.
struct PointShape {
    std::uint64_t points = 0;  // in the sweep
    std::size_t columns = 1;   // numbers in a row of samples
    int classes = 0;           // the numbers of classes are below
};

// The points in a file, which are read one by one: few of their numbers are in memory.
class PointFile {
  public:
    // Opens a finished file and reads its head. Throws IoError for a file that is no file of points.
    explicit PointFile(std::filesystem::path file);
    const PointHead& head() const { return head_; }
    // To be called once, before the functions below. Throws IoError if a point does not fit the shape or is damaged.
    void find_points(const PointShape& shape);

    bool has(std::uint64_t point) const { return places_[point] != 0; }
    std::uint64_t count() const { return count_; }
    std::uint64_t numbers(std::uint64_t point) const { return numbers_[point]; }  // of its samples
    StoredPoint read(std::uint64_t point) const;                                  // throws IoError

  protected:
    PointFile(std::filesystem::path file, int flags);  // neither reads nor checks
    bool read_head();                                  // false: the file does not begin with one
    void index_points(const PointShape& shape);        // up to the first point that is damaged or does not fit
    void place(std::uint64_t point, std::uint64_t samples, std::uint64_t size);
    std::string text_at(std::uint64_t at, std::size_t size) const;

    std::filesystem::path path_;
    Descriptor file_;
    PointHead head_;
    std::uint64_t end_ = 0, count_ = 0;
    std::vector<std::uint64_t> places_;   // by point; 0: not there
    std::vector<std::uint32_t> numbers_;  // by point
};

class PointStore : public PointFile {
  public:
    // Keeps the points of a file with the same identity. Throws IoError, also when another program has the file open,
    // the file is no file of points, or it has points of another sweep and these are not to be replaced.
    PointStore(std::filesystem::path file, const PointShape& shape, const PointHead& head, bool replace = false);
    ~PointStore();  // removes a file without points
    PointStore(const PointStore&) = delete;
    PointStore& operator=(const PointStore&) = delete;

    void add(const StoredPoint& point);  // any thread, each a point of its own; throws IoError
    void remove();                       // its name, when the points are elsewhere; those that are open can be read

  private:
    void begin(const PointHead& head);

    std::mutex mutex_;  // of adding
};

// The bytes of a head and of a point in a file.
std::string text_of(const PointHead& head);
std::string text_of(const StoredPoint& point);

}  // namespace beamcam::output
