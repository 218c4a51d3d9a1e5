// The Pango side of Fonts, for the two files that talk to Pango.
#pragma once

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include "render/fonts.hpp"

namespace beamcam::render {

struct Fonts::Handles {
    FcConfig* config = nullptr;
    PangoFontMap* map = nullptr;
    PangoContext* context = nullptr;
    PangoLayout* layout = nullptr;  // reused for every text

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles();
};

}  // namespace beamcam::render
