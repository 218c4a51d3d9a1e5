// What `beamcam diff` finds: two things of one kind, how they differ, and in which words that is told.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/data/table_difference.hpp"
#include "output/image/picture_difference.hpp"

namespace beamcam::scenes {

enum class Verdict {
    identical,
    equivalent,    // not identical, but within the tolerance
    new_renderer,  // drawn by libraries or fonts of which nothing is accepted yet; the pictures look alike
    different,
    missing  // one of the two is not there
};
const char* name(Verdict verdict);
// The worse of the two.
Verdict worse(Verdict a, Verdict b);

struct PictureComparison {
    std::string a, b;  // names of the two pictures
    Verdict verdict = Verdict::identical;
    std::string size_a, size_b;  // "1920x1080"; differ: a verdict of its own, nothing else is measured
    output::PictureDifference difference;
    bool same_size() const { return size_a == size_b; }
};

// `tolerance` is a difference of a channel, 0…255, that counts as none.
PictureComparison compare(const output::Raster& a, const output::Raster& b, int tolerance);

struct Comparison {
    std::string a, b;  // as the user named them
    Verdict verdict = Verdict::identical;
    // Of pictures: those that are not identical, and the numbers of all.
    std::vector<PictureComparison> pictures;
    std::size_t pictures_a = 0, pictures_b = 0;
    std::optional<output::TableDifference> table;
};

// "12 of 2073600 pixels (0.000579 %), largest channel difference 3 of 255, …"
std::string in_words(const output::PictureDifference& difference);
// Lines for people, without the names.
std::string in_words(const PictureComparison& comparison);
std::string in_words(const output::TableDifference& difference);

std::string to_text(const Comparison& comparison);
std::string to_json(const Comparison& comparison);

}  // namespace beamcam::scenes
