// Metadata of SVG and PDF figures, read without a library: only the elements that beamcam writes. Values are UTF-8;
// absent values are empty.
#pragma once

#include <filesystem>
#include <string>

#include "output/files/errors.hpp"

namespace beamcam::output {

struct DocumentMetadata {
    std::string title, subject, creator;
    std::string scene;  // JSON text
};

// Throw IoError if the file is unreadable or not such a document.
DocumentMetadata read_svg_metadata(const std::filesystem::path& file);
DocumentMetadata read_pdf_metadata(const std::filesystem::path& file);

}  // namespace beamcam::output
