// The figures by name: the motions that each needs, and the figure that it makes from their results. A type neither
// integrates nor draws.
#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/base/error.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/motion_requests.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Parts of figures, by their short names.
using render::figure::Figure;
using render::figure::Panel;
using render::figure::Series;
using sim::ChannelKind;

using FigureDrawing = std::function<Figure(const Subject&, const MotionResults&)>;
using FigureMaker = std::function<Figure(const MotionResults&)>;  // of one subject

class SweptPoints;

struct FigureType {
    const char* name;
    const char* title;
    // Why the scene has no such figure, with the remedy; nothing when it has.
    std::optional<std::string> (*refusal)(const Scene& scene);
    // Requests the motions of the figure, and returns the function that draws their results. Null for a figure of a
    // sweep.
    FigureDrawing (*maker)(const Scene& scene, const FigureOutput& how, MotionRequests& requests) = nullptr;
    // Draws the points of the scene's sweep. Null for a figure of motions.
    Figure (*draw)(const SweptPoints& points, const FigureOutput& how) = nullptr;
    // The keys of its output that only some figures have: "from", "to".
    std::vector<std::string_view> keys = {};
    // The part of the motion shown without "from" and "to", as far as it has these events.
    std::optional<Instant> begins = {}, ends = {};

    bool of_sweep() const { return draw != nullptr; }
    bool takes(std::string_view key) const { return std::ranges::find(keys, key) != keys.end(); }
    // "belongs to the figures "map" and "basins"; remove it", for a key that others have; nothing for one of its own
    // or of all figures.
    std::optional<std::string> misplaced(std::string_view key) const;
    // Adds the motions of the figure to the requests; the maker reads their results. The figure has the type's name,
    // and the title of `how`, or else its own or that of the type.
    FigureMaker prepare(const Scene& scene, const FigureOutput& how, MotionRequests& requests) const;
};

std::span<const FigureType> figure_types();
std::vector<std::string> figure_names();
const FigureType* figure_type(std::string_view name);  // nullptr: none

// The keys that only some figures have, and the names of the figures that have one of them.
std::vector<std::string_view> keys_of_figures();
std::vector<std::string> figures_with(std::string_view key);
std::string list_of_figures_with(std::string_view key);  // "\"map\" and \"basins\""

// Why a figure that also computes these variants of a scene is refused: one of them is impossible.
std::optional<std::string> refusal_of_variants(std::initializer_list<sim::Problem> variants);

// ---- what they share ------------------------------------------------------------------------------

inline std::optional<std::string> no_refusal(const Scene&) { return std::nullopt; }
std::optional<std::string> needs_cam(const Scene& scene);
std::optional<std::string> needs_bending(const Scene& scene);
std::optional<std::string> needs_free_hub(const Scene& scene);
std::optional<std::string> needs_start_off_the_cam(const Scene& scene);

// Gives the panels their letters, from "a", if there are several.
std::vector<Panel> lettered(std::vector<Panel> panels);

// Whether an impact or a collision is a strike. A beam that rests on the cam at the start touches it without striking
// it.
template <class Touch>
bool strikes(const sim::Problem& problem, const Touch& touch) {
    return touch.t_start > 0 || problem.initial.shape != sim::InitialShape::resting;
}
// The strikes that begin within an interval.
template <class Touch>
std::vector<Touch> strikes(const sim::Problem& problem, const std::vector<Touch>& touches, double from, double to) {
    std::vector<Touch> out;
    std::ranges::copy_if(touches, std::back_inserter(out), [&](const Touch& touch) {
        return touch.t_start >= from && touch.t_start <= to && strikes(problem, touch);
    });
    return out;
}

// Counted from 1; null: there are fewer.
const sim::Collision* collision_of(const sim::Problem& problem, const sim::Result& result, int number);
// Rows over the scene: an impact lasts a few tenths of a millisecond.
int contact_rows(double end);

// Draws the result of the scene's own motion, and adds caption and accuracy.
using MotionDrawing = std::function<Figure(const Subject&, const sim::Result&)>;
FigureDrawing figure_of_motion(std::size_t motion, MotionDrawing draw);

// Poses of the scene's motion, equally spaced over the interval that a figure shows, both ends included.
struct ShownPoses {
    double from = 0, to = 0;            // [s]
    std::size_t motion = 0, poses = 0;  // poses: index into the motion's Result::poses
};
// `stations`: points along the beam.
ShownPoses request_poses(const Scene& scene, const FigureOutput& how, int count, int stations,
                         MotionRequests& requests);

// Natural frequencies of the bending vibrations [Hz], ascending; none of a rigid beam.
std::vector<double> frequencies_of(const sim::Problem& problem);

sim::Problem without_cam(sim::Problem problem);
sim::Problem rigid(sim::Problem problem);

std::vector<double> scaled(std::vector<double> values, double factor);

}  // namespace beamcam::scenes
