// What SVG and PDF figures say of themselves, without a library for either: the few elements that beamcam's own figures
// have. Values are UTF-8; absent ones are empty.
#pragma once

#include <filesystem>
#include <string>

#include "output/files/errors.hpp"

namespace beamcam::output {

struct DocumentMetadata {
    std::string title, subject, creator;
    std::string scene;  // JSON text
};

// Throws IoError: unreadable, or no such document.
DocumentMetadata read_svg_metadata(const std::filesystem::path& file);
DocumentMetadata read_pdf_metadata(const std::filesystem::path& file);

}  // namespace beamcam::output
