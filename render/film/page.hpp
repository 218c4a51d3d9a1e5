// One self-contained HTML page that plays a motion: the beam as films draw it, the cam, the contact and its trace, on a
// canvas that fits any window; without network, fonts or other files. Its program is player.html.
#pragma once

#include <string>
#include <string_view>

#include "render/film/film.hpp"

namespace beamcam::render {

// The setup's frames are the instants looked at, increasing. Those are left out that a straight line between kept ones
// tells to within `kPageTolerance` of the beam's length for every point and the same angle [rad]. The same setup gives
// the same bytes.
constexpr double kPageTolerance = 1e-3;
std::string html_page(const FilmSetup& setup);

std::string json_text(std::string_view text);  // as JSON, which may stand in HTML

}  // namespace beamcam::render
