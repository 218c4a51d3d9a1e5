// Units of axes that suit their numbers.
#pragma once

#include "render/plot/figure.hpp"

namespace beamcam::scenes {

// Axes and colour bars in m, N, J, s or Hz, with or without a prefix, whose numbers would need a power of ten beside
// them get another prefix: "$w$ / mm" with 10^{−6} becomes "$w$ / nm". Thousandths become millionths. Others stay as
// they are.
void choose_prefixes(render::figure::Figure& figure);

}  // namespace beamcam::scenes
