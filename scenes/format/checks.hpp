// Rules between the keys of a scene, beyond the range of each key. The reader applies them after it has read the keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/format/object_reader.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// The colours distinguish at most eight motions.
inline constexpr std::size_t kMostCompared = 8;
// Two or more motions; those without a label get their number.
List compared_motions(std::vector<Compared>& motions);

ValueFormat layout_format(std::optional<render::LayoutNode>& layout);

// The value of a key as it is written, or the first one of a sweep over it; null: none.
const Node* written_value(const Node& scene, const std::string& key);
// Warns about a formula in the text of a picture that cannot be parsed.
void check_words(ObjectReader& r, const char* key, const std::string& text);
// Labels and titles of figures contain markup.
void check_markup(ObjectReader& r, const std::string& key, const std::string& text);
void check_physics(ObjectReader& r, const sim::Problem& problem);
// Pictures use the units in which the scene gives its angle and its speed.
void infer_units(ObjectReader& r, render::Units& units);
// The unit of an option's angle or speed becomes theirs; a plain number leaves them.
void adopt_unit(std::string_view text, const Dimension& dimension, render::Units& units);
void check_camera(ObjectReader& r, const View& view);  // `r` reads "camera"
void check_picture(ObjectReader& r, Picture& picture);
void check_layout(ObjectReader& r, const Picture& picture);
void check_speed(ObjectReader& r, const Speed& speed);  // `r` reads "speed"
void check_span(ObjectReader& r, const FrameSpan& span, const Picture& picture);
// The latest end of a motion [s]: there a double resolves a tenth of a millisecond.
inline constexpr double kLatestEnd = 1e12;
// A time [s] after the end of the scene extends the motion; it may also be a slip of the unit.
void check_end(ObjectReader& r, const char* key, double t);
void set_default_codec(PictureOutput& video);  // that of its ending
void check_video(ObjectReader& r, PictureOutput& video);
void check_figure(ObjectReader& r, FigureOutput& figure);
void check_series_panel(ObjectReader& r, const SeriesPanel& panel);
void check_outputs(ObjectReader& r, Scene& scene);  // also stores the position of each

// Why a diagram cannot show this value of the points of the scene's sweep; empty if it can.
std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene);

}  // namespace beamcam::scenes
