// TIFF files of opaque pictures for print: RGB of 8 bits, deflate, with dots per inch. The same picture gives the same
// bytes. "TIFF Revision 6.0", Adobe 1992; compression 8 of its technical notes.
#pragma once

#include <string>

#include "render/draw/image.hpp"

namespace beamcam::output {

struct TiffOptions {
    double dpi = 600;  // [1/inch], > 0
    std::string description, software;
};
// The file's bytes. Throws UnsupportedOption above 4 GiB.
std::string encode_tiff(const render::Image& image, const TiffOptions& options);

}  // namespace beamcam::output
