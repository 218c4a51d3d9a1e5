// The comparison of two pictures or tables, and its description as text and JSON.
#pragma once

#include <span>
#include <string>

#include "output/data/table_difference.hpp"
#include "output/image/picture_difference.hpp"
#include "output/json/tree.hpp"
#include "sim/base/named.hpp"

namespace beamcam::scenes {

enum class Verdict {  // the worse, the greater
    identical,
    equivalent,  // not identical, but within the tolerance
    different,
    missing,  // there is no reference yet
    not_run   // not compared, for example without its scene
};
constexpr sim::Named<Verdict> kVerdicts[] = {{Verdict::identical, "identical"},
                                             {Verdict::equivalent, "equivalent"},
                                             {Verdict::different, "different"},
                                             {Verdict::missing, "missing"},
                                             {Verdict::not_run, "not-run"}};
inline std::span<const sim::Named<Verdict>> names(Verdict) { return kVerdicts; }
using sim::name;

struct PictureComparison {
    std::string size_a, size_b;  // "1920x1080"; pictures of different sizes are not compared further
    output::PictureDifference difference;
    bool same_size() const { return size_a == size_b; }
    bool identical() const { return same_size() && difference.identical(); }
    double weight() const;  // size of the difference; reports begin with the largest
};

// `tolerance`: largest difference of a channel, 0…255, that counts as none.
PictureComparison compare(const output::Raster& a, const output::Raster& b, int tolerance);

// "12 of 2073600 pixels (0.000579 %), largest channel difference 3 of 255, …"
std::string to_text(const PictureComparison& comparison);
std::string to_text(const output::TableDifference& difference);
// "the times (column t) differ first in row 3: 0.005 became 0.006"
std::string to_text(const output::OtherInstant& other);
Node to_node(const PictureComparison& comparison);
Node to_node(const output::TableDifference& difference);

}  // namespace beamcam::scenes
