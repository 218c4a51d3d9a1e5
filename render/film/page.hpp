// A self-contained HTML page that plays a motion: beam, cam, contact and trace on a canvas that fits any window,
// without network access or other files. Its script is player.html.
#pragma once

#include <string>
#include <string_view>

#include "render/film/film.hpp"

namespace beamcam::render {

// The setup's frames are the instants, increasing. Instants are omitted if linear interpolation between the stored ones
// reproduces every point within `kPageTolerance` of the beam's length, every angle within the same number [rad], the
// force within `kPageForceTolerance` of the largest, and moments, which are colours, within `kPageMomentTolerance` of
// their scale. The result depends only on the setup.
constexpr double kPageTolerance = 1e-3, kPageForceTolerance = 2e-3, kPageMomentTolerance = 0.05;
std::string html_page(const FilmSetup& setup);

std::string json_text(std::string_view text);  // as a JSON string that may be embedded in HTML

std::string_view player_html();  // the text of player.html, compiled in by CMake

}  // namespace beamcam::render
