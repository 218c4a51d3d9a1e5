#include "render/draw/vector_file.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <map>
#include <string_view>
#include <utility>

#include "render/draw/markup.hpp"

namespace beamcam::render {
namespace {

cairo_status_t collect(void* out, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

void describe(cairo_surface_t* pdf, const Document& d) {
    const auto add = [&](cairo_pdf_metadata_t key, const std::string& text) {
        if (!text.empty()) cairo_pdf_surface_set_metadata(pdf, key, text.c_str());
    };
    add(CAIRO_PDF_METADATA_TITLE, d.title);
    add(CAIRO_PDF_METADATA_SUBJECT, d.subject);
    add(CAIRO_PDF_METADATA_KEYWORDS, d.scene);
    add(CAIRO_PDF_METADATA_CREATOR, d.creator);
    const std::string when = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(d.created)));
    add(CAIRO_PDF_METADATA_CREATE_DATE, when);
    add(CAIRO_PDF_METADATA_MOD_DATE, when);
}

// Cairo numbers the surfaces and images of a whole program; here they are numbered in the order of the file.
std::string with_own_numbers(std::string_view svg) {
    std::string out;
    std::map<std::string_view, std::size_t> numbers;
    for (std::size_t at = 0;;) {
        std::size_t id = std::string_view::npos;
        std::size_t word = 0;
        for (const std::string_view name : {"\"surface", "\"image", "#image", "\"source-", "#source-"})
            if (const std::size_t found = svg.find(name, at); found < id) id = found, word = name.size();
        if (id == std::string_view::npos) return out.append(svg.substr(at));
        const std::size_t number = id + word, end = svg.find('"', number);
        const std::size_t own = numbers.try_emplace(svg.substr(number, end - number), numbers.size()).first->second;
        out.append(svg.substr(at, number - at)).append(std::to_string(own));
        at = end;
    }
}

}  // namespace

VectorFile::VectorFile(Medium medium, double width, double height, const Document& document)
    : medium_(medium), width_(width), height_(height), document_(document) {}

double VectorFile::unit() const { return medium_ == Medium::pdf ? 1 : kMillimetresPerInch / kPointsPerInch; }

cairo_surface_t* VectorFile::surface() {
    const double width = width_ * unit(), height = height_ * unit();
    if (medium_ == Medium::pdf) {
        cairo_surface_t* pdf = cairo_pdf_surface_create_for_stream(collect, &stream_, width, height);
        describe(pdf, document_);
        return pdf;
    }
    cairo_surface_t* svg = cairo_svg_surface_create_for_stream(collect, &stream_, width, height);
    cairo_svg_surface_set_document_unit(svg, CAIRO_SVG_UNIT_MM);
    return svg;
}

std::string VectorFile::take_bytes() {
    if (medium_ == Medium::pdf) return std::move(stream_);
    std::string file = with_own_numbers(stream_);
    // Cairo writes no metadata into an SVG; they go behind the opening tag.
    const std::size_t tag = file.find("<svg"), end = file.find('>', tag);
    if (end == std::string::npos) return file;
    file.insert(end + 1, fmt::format("\n<title>{}</title>\n<desc>{}</desc>\n<metadata>\n<creator>{}</creator>\n"
                                     "<scene>{}</scene>\n</metadata>",
                                     xml(document_.title), xml(document_.subject), xml(document_.creator),
                                     xml(document_.scene)));
    return file;
}

}  // namespace beamcam::render
