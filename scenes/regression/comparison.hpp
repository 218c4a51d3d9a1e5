// The comparison of two pictures, sequences of pictures, or tables, and its description as text and JSON.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/data/table_difference.hpp"
#include "output/image/picture_difference.hpp"
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
    std::string a, b;  // names of the two pictures
    Verdict verdict = Verdict::identical;
    std::string size_a, size_b;  // "1920x1080"; pictures of different sizes are not compared further
    output::PictureDifference difference;
    bool same_size() const { return size_a == size_b; }
    double weight() const;  // size of the difference; reports begin with the largest
};

// `tolerance`: largest difference of a channel, 0…255, that counts as none.
PictureComparison compare(const output::Raster& a, const output::Raster& b, int tolerance);

struct Comparison {
    std::string a, b;  // as the user named them
    Verdict verdict = Verdict::identical;
    // The pictures that are not identical, and the numbers of all pictures.
    std::vector<PictureComparison> pictures;
    std::size_t pictures_a = 0, pictures_b = 0;
    std::optional<output::TableDifference> table;
};

// "12 of 2073600 pixels (0.000579 %), largest channel difference 3 of 255, …"
std::string to_text(const output::PictureDifference& difference);
std::string to_text(const PictureComparison& comparison);  // without the names
std::string to_text(const output::TableDifference& difference);
std::string to_text(const Comparison& comparison);
std::string to_json(const Comparison& comparison);

}  // namespace beamcam::scenes
