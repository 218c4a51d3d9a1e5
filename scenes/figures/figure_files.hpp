// The files of a figure: picture, data and caption, as bytes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Names and bytes of the files that a figure's output writes, as written_by. `scene` is the resolved scene as JSON,
// which the figure carries. PDF and SVG hold the instant of SOURCE_DATE_EPOCH, 1970 without it, so that the same figure
// has the same bytes.
std::vector<std::pair<std::string, std::string>> figure_files(const render::figure::Figure& figure,
                                                              const FigureOutput& how, const std::string& scene);

// Of vector graphics, by the ending of the file: .pdf, else SVG.
render::Medium medium_of(const std::string& file);

// The metadata of a figure's file. `title`, `subject`: plain text.
render::Document document_of(std::string title, std::string subject, std::string scene);

// Its pixels at `how.dpi`, as a .png has them.
render::Image figure_image(const render::figure::Figure& figure, const FigureOutput& how);

// The scene that is embedded in a figure: its physics and this figure, without the name of its file.
std::string scene_of_figure(Scene scene, FigureOutput how);

// Messages: for each axis whose limits hide all curves "no curve: θ / rad is between 0.1 and 0.8, beyond the ends of
// its axis", and for each panel whose motions have none "no points".
std::vector<std::string> missing_data(const render::figure::Figure& figure);

}  // namespace beamcam::scenes
