#include "render/plot/sheet.hpp"

#include <cairo-pdf.h>
#include <cairo-ps.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <numbers>

#include "render/base/error.hpp"
#include "render/draw/cairo_status.hpp"
#include "render/draw/font_handles.hpp"
#include "render/draw/surface.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text.hpp"

namespace beamcam::render::figure {
namespace {

// Sub- and superscripts: size, and shift of the baseline, by the size of the text they belong to.
constexpr double kScriptSize = 0.72, kRaise = 0.36, kLower = 0.17;
// Fractions and roots, by the same: height of their line, what is left free beside lines, width of the sign, the line.
constexpr double kAxis = 0.26, kGap = 0.12, kRoot = 0.55, kRule = 0.055;
// Liberation Serif looks smaller than Liberation Sans; this brings the x-heights together.
constexpr double kSymbolSize = 1.12;
constexpr double kLargestSide = 16384;  // [px]: a picture beyond it is a mistake, and 1 GB

cairo_status_t collect(void* out, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

std::string xml(std::string_view text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            default:
                out += c;
        }
    return out;
}

}  // namespace

struct Sheet::Handles {
    std::string stream;  // of PDF, EPS and SVG; outlives the surface
    std::string texts;   // of SVG, where they are no outlines
    Color ink;           // of the label that is shown
    Image image;
    cairo_surface_t* surface = nullptr;
    // Writes what is left of a document.
    void finish() {
        cairo_surface_finish(surface);
        require_success(cairo_surface_status(surface));
    }
    ~Handles() { cairo_surface_destroy(surface); }
};

struct Sheet::Set::Piece {
    Run run;
    double x = 0, y = 0, size = 0, advance = 0;  // of the baseline's start
};

namespace {

// By the name's and the file's own words; in comments of EPS lines end and are short.
void describe_eps(cairo_surface_t* eps, const Document& d) {
    const auto say = [&](const char* key, const std::string& text) {
        constexpr std::size_t kLongest = 200;  // a line has 255 characters
        std::string line;
        for (const char c : text.substr(0, kLongest)) line += c >= ' ' && c <= '~' ? c : ' ';
        if (!line.empty()) cairo_ps_surface_dsc_comment(eps, fmt::format("%%{}: {}", key, line).c_str());
    };
    say("Title", d.title);
    say("For", d.creator);
}

void describe(cairo_surface_t* pdf, const Document& d) {
    const auto say = [&](cairo_pdf_metadata_t key, const std::string& text) {
        if (!text.empty()) cairo_pdf_surface_set_metadata(pdf, key, text.c_str());
    };
    say(CAIRO_PDF_METADATA_TITLE, d.title);
    say(CAIRO_PDF_METADATA_SUBJECT, d.subject);
    say(CAIRO_PDF_METADATA_KEYWORDS, d.scene);
    say(CAIRO_PDF_METADATA_CREATOR, d.creator);
    const std::string when = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(d.created)));
    say(CAIRO_PDF_METADATA_CREATE_DATE, when);
    say(CAIRO_PDF_METADATA_MOD_DATE, when);
}

}  // namespace

Sheet::Sheet(Medium medium, const Paper& paper, const Fonts& fonts, const Document& document)
    : medium_(medium), paper_(paper), document_(document), fonts_(fonts), handles_(std::make_unique<Handles>()) {
    Handles& h = *handles_;
    if (paper.dark) recolor_ = on_dark;
    const double scale = paper.dpi / kPointsPerInch;
    double unit = 1;  // device units of a point
    if (!(paper.width > 0 && paper.height > 0 && std::max(paper.width, paper.height) * scale <= kLargestSide))
        throw PictureError(
            fmt::format("a figure of {:.4g} × {:.4g} mm at {:g} dpi cannot be drawn; its sides must be "
                        "positive and at most {:g} pixels",
                        paper.width / points(1), paper.height / points(1), paper.dpi, kLargestSide));
    if (medium == Medium::png) {
        // At least a pixel, and never less than the page.
        h.image = Image(static_cast<int>(std::ceil(paper.width * scale - 1e-6)),
                        static_cast<int>(std::ceil(paper.height * scale - 1e-6)));
        h.surface =
            cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(h.image.pixels.data()),
                                                CAIRO_FORMAT_ARGB32, h.image.width, h.image.height, 4 * h.image.width);
        unit = scale;
    } else if (medium == Medium::eps) {
        h.surface = cairo_ps_surface_create_for_stream(collect, &h.stream, paper.width, paper.height);
        cairo_ps_surface_set_eps(h.surface, 1);
        describe_eps(h.surface, document);
    } else if (medium == Medium::pdf) {
        h.surface = cairo_pdf_surface_create_for_stream(collect, &h.stream, paper.width, paper.height);
        describe(h.surface, document);
    } else {
        unit = kMillimetresPerInch / kPointsPerInch;
        h.surface = cairo_svg_surface_create_for_stream(collect, &h.stream, paper.width * unit, paper.height * unit);
        cairo_svg_surface_set_document_unit(h.surface, CAIRO_SVG_UNIT_MM);
    }
    begin(cairo_create(h.surface));
    if (cairo_status(cr_) == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (cairo_status(cr_) != CAIRO_STATUS_SUCCESS)
        throw PictureError(fmt::format("a figure of {:.4g} × {:.4g} mm cannot be drawn: {}", paper.width / points(1),
                                       paper.height / points(1), cairo_status_to_string(cairo_status(cr_))));
    cairo_scale(cr_, unit, unit);
    cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
    use(rgb(0xFFFFFF));
    cairo_paint(cr_);
}
Sheet::~Sheet() noexcept(false) { end(); }

// A quarter of a pixel, or of the 1/600 inch of a good printer.
double Sheet::grain() const { return kPointsPerInch / (4 * (medium_ == Medium::png ? paper_.dpi : 600)); }

void Sheet::arc(Vec2 c, double radius, double from, double to) {
    cairo_new_sub_path(cr_);
    Brush::arc(c, radius, from, to);
}

void Sheet::curve(std::span<const Vec2> points, const Pen& pen) {
    // To fill pixels, Cairo carries every edge of a path along from row to row: a long one goes in pieces, whose round
    // ends are the joins. A file keeps the path as it is.
    constexpr std::size_t kLong = 10'000, kPiece = 128;  // points
    if (medium_ != Medium::png || points.size() <= kLong || !pen.dash.empty()) {
        polyline(points);
        return stroke(pen);
    }
    const Pen part{pen.color, pen.width, {}, Cap::round};
    for (std::size_t from = 0; from + 1 < points.size(); from += kPiece - 1) {
        polyline(points.subspan(from, std::min(kPiece, points.size() - from)));
        stroke(part);
    }
}

void Sheet::gradient(const Box& box, std::span<const Color> colors) {
    cairo_pattern_t* pattern = cairo_pattern_create_linear(0, box.bottom(), 0, box.y);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Color color = shown(colors[i]);
        cairo_pattern_add_color_stop_rgb(pattern, static_cast<double>(i) / static_cast<double>(colors.size() - 1),
                                         color.r, color.g, color.b);
    }
    cairo_set_source(cr_, pattern);
    rectangle(box);
    cairo_fill(cr_);
    cairo_pattern_destroy(pattern);
}

void Sheet::picture(const Image& image, const Box& box) {
    cairo_surface_t* surface = surface_of(image);
    cairo_save(cr_);
    cairo_translate(cr_, box.x, box.y);
    cairo_scale(cr_, box.w / image.width, box.h / image.height);
    cairo_set_source_surface(cr_, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr_), CAIRO_FILTER_NEAREST);
    cairo_paint(cr_);
    cairo_restore(cr_);
    cairo_surface_destroy(surface);
}

void Sheet::clip(const Box& b) {
    cairo_save(cr_);
    rectangle(b);
    cairo_clip(cr_);
}
void Sheet::unclip() { cairo_restore(cr_); }

// ---- letters -------------------------------------------------------------------------------------

// Puts one run into the layout; its advance [pt].
double Sheet::lay(const Run& run, double size, bool bold) const {
    PangoLayout* layout = fonts_.handles().layout;
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family_static(
        font, run.symbol || serif() ? "Liberation Serif,Droid Sans Fallback" : "Liberation Sans,Droid Sans Fallback");
    pango_font_description_set_style(font, run.symbol ? PANGO_STYLE_ITALIC : PANGO_STYLE_NORMAL);
    pango_font_description_set_weight(font, bold || run.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, (run.symbol && !serif() ? kSymbolSize : 1) * size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    pango_layout_set_attributes(layout, nullptr);
    pango_layout_set_width(layout, -1);
    pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_NONE);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    pango_layout_set_text(layout, run.text.c_str(), static_cast<int>(run.text.size()));
    if (pango_layout_get_unknown_glyphs_count(layout) > 0) throw FontError(missing_glyphs(run.text));
    PangoRectangle logical;
    pango_layout_get_extents(layout, nullptr, &logical);
    return static_cast<double>(logical.width) / PANGO_SCALE;
}

// Takes over a part that stands with its baseline's start at (x, y).
void Sheet::join(Set& label, Set part, double x, double y) {
    for (Set::Piece& piece : part.pieces) {
        piece.x += x, piece.y += y;
        label.pieces.push_back(std::move(piece));
    }
    for (std::vector<Vec2>& rule : part.rules) {
        for (Vec2& p : rule) p += {x, y};
        label.rules.push_back(std::move(rule));
    }
    label.smallest = std::min(label.smallest, part.smallest);
    label.ascent = std::max(label.ascent, part.ascent - y);
    label.descent = std::max(label.descent, part.descent + y);
}

// A fraction about the axis of signs, or a root.
void Sheet::set_parts(Set& label, const Run& run, const Lettering& l) {
    const double gap = kGap * l.size, axis = -kAxis * l.size, x = label.width;
    if (run.under.empty()) {
        Set inside = set(run.over, l);
        const double top = -inside.ascent - gap, wide = inside.width, sign = kRoot * l.size;
        label.rules.push_back({{x, -0.3 * l.size},
                               {x + 0.3 * sign, -0.36 * l.size},
                               {x + 0.6 * sign, inside.descent},
                               {x + sign, top},
                               {x + sign + wide, top}});
        join(label, std::move(inside), x + sign, 0);
        label.ascent = std::max(label.ascent, -top + gap);
        label.width = x + sign + wide + gap;
        return;
    }
    Lettering small = l;
    small.size = std::max(kSmallestLetter, kScriptSize * l.size);
    Set above = set(run.over, small), below = set(run.under, small);
    const double wide = std::max(above.width, below.width) + 2 * gap;
    label.rules.push_back({{x + gap / 2, axis}, {x + wide - gap / 2, axis}});
    const double up = axis - gap - above.descent, down = axis + gap + below.ascent;
    const double left = x + (wide - above.width) / 2, right = x + (wide - below.width) / 2;
    join(label, std::move(above), left, up);
    join(label, std::move(below), right, down);
    label.width = x + wide;
}

Sheet::Set Sheet::set(std::string_view markup, const Lettering& l) { return set(parse_markup(markup), l); }

Sheet::Set Sheet::set(const std::vector<Run>& runs, const Lettering& l) {
    Set label;
    label.ascent = cap_height(l.size);
    const Run* before = nullptr;
    double base_end = 0;  // where the scripts of the last base begin
    for (const Run& run : runs) {
        if (!run.over.empty()) {
            set_parts(label, run, l);
            base_end = label.width;
            before = nullptr;
            continue;
        }
        Set::Piece piece;
        piece.run = run;
        piece.size = run.script ? std::max(kSmallestLetter, kScriptSize * l.size) : l.size;
        piece.advance = lay(run, piece.size, l.bold);
        if (run.script > 0) piece.y = -kRaise * l.size;
        if (run.script < 0) piece.y = kLower * l.size;
        // A superscript leans away from an italic; sub and super of one base stand above each other.
        const bool stacked = before && before->script * run.script < 0;
        piece.x = stacked ? base_end : label.width;
        if (before && before->symbol && before->script == 0 && run.script >= 0 && !run.symbol)
            piece.x += (run.script > 0 ? 0.08 : 0.03) * l.size;
        if (run.script == 0 || !before || before->script == 0)
            base_end = run.script == 0 ? piece.x + piece.advance : piece.x;
        label.width = std::max(label.width, piece.x + piece.advance);
        label.smallest = std::min(label.smallest, piece.size);
        label.ascent = std::max(label.ascent, -piece.y + (run.script ? cap_height(piece.size) : 0));
        if (run.dots) label.ascent = std::max(label.ascent, 0.98 * l.size);
        if (run.script < 0) label.descent = std::max(label.descent, piece.y + 0.12 * piece.size);
        label.pieces.push_back(std::move(piece));
        before = &run;
    }
    return label;
}

void Sheet::show(const Set& label, const Lettering& l) {
    PangoLayout* layout = fonts_.handles().layout;
    double x0 = 0, y0 = 0;
    cairo_get_current_point(cr_, &x0, &y0);
    for (std::vector<Vec2> rule : label.rules) {
        cairo_new_path(cr_);
        for (Vec2& p : rule) p += {x0, y0};
        polyline(rule);
        stroke({l.color, kRule * l.size});
    }
    for (const Set::Piece& piece : label.pieces) {
        lay(piece.run, piece.size, false);
        if (medium_ == Medium::svg && document_.editable) {
            add_text(piece, {x0 + piece.x, y0 + piece.y});
        } else {
            const double baseline = static_cast<double>(pango_layout_get_baseline(layout)) / PANGO_SCALE;
            cairo_move_to(cr_, x0 + piece.x, y0 + piece.y - baseline);
            pango_cairo_show_layout(cr_, layout);
        }
        cairo_new_path(cr_);
        // Dots stand above the middle of the slanted letter.
        for (int k = 0; k < piece.run.dots; ++k) {
            const double across = (k - 0.5 * (piece.run.dots - 1)) * 0.22 * piece.size;
            circle({x0 + piece.x + 0.58 * piece.advance + across, y0 + piece.y - 0.90 * piece.size},
                   0.065 * piece.size);
            cairo_fill(cr_);
        }
    }
}

// An element of SVG; it stands behind everything that is drawn.
void Sheet::add_text(const Set::Piece& piece, Vec2 at) {
    cairo_user_to_device(cr_, &at.x, &at.y);
    cairo_matrix_t matrix;
    cairo_get_matrix(cr_, &matrix);
    const double scale = std::hypot(matrix.xx, matrix.yx), turned = std::atan2(matrix.yx, matrix.xx);
    const bool symbol = piece.run.symbol;
    const auto level = [](double share) { return static_cast<int>(std::lround(255 * share)); };
    const Color ink = shown(handles_->ink);
    handles_->texts += fmt::format(
        R"svg(<text transform="translate({:.3f} {:.3f}) rotate({:.3f})" font-family="{}" font-size="{:.3f}"{}{} fill="#{:02x}{:02x}{:02x}" xml:space="preserve">{}</text>)svg"
        "\n",
        at.x, at.y, turned * 180 / std::numbers::pi,
        symbol || serif() ? "Liberation Serif, Times New Roman, serif" : "Liberation Sans, Arial, sans-serif",
        (symbol && !serif() ? kSymbolSize : 1) * piece.size * scale, symbol ? R"( font-style="italic")" : "",
        piece.run.bold ? R"( font-weight="bold")" : "", level(ink.r), level(ink.g), level(ink.b), xml(piece.run.text));
}

Box Sheet::measure(std::string_view markup, const Lettering& l) {
    const Set label = set(markup, l);
    return {0, -label.ascent, label.width, label.ascent + label.descent};
}

Box Sheet::text(Vec2 at, std::string_view markup, const Lettering& l) {
    Set label = set(markup, l);
    for (Set::Piece& piece : label.pieces) piece.run.bold = piece.run.bold || l.bold;
    double dx = 0, dy = 0;
    if (l.align == HAlign::centre) dx = -label.width / 2;
    if (l.align == HAlign::right) dx = -label.width;
    if (l.valign == VAlign::top) dy = label.ascent;
    if (l.valign == VAlign::middle) dy = cap_height(l.size) / 2;
    if (l.valign == VAlign::bottom) dy = -label.descent;
    cairo_save(cr_);
    cairo_translate(cr_, at.x, at.y);
    cairo_rotate(cr_, -l.turned);
    use(l.color);
    handles_->ink = l.color;
    cairo_move_to(cr_, dx, dy);
    show(label, l);
    cairo_restore(cr_);

    // The corners turned, and the box around them.
    Bounds around;
    for (const double x : {dx, dx + label.width})
        for (const double y : {dy - label.ascent, dy + label.descent})
            around.add({at.x + x * std::cos(l.turned) + y * std::sin(l.turned),
                        at.y - x * std::sin(l.turned) + y * std::cos(l.turned)});
    const Box box = around.box();
    if (!label.pieces.empty()) written.push_back({box, label.smallest, std::string(markup)});
    return box;
}

namespace {

// Cairo writes the clock's.
std::string with_date(std::string eps, std::int64_t created) {
    const std::string key = "%%CreationDate: ";
    const std::size_t at = eps.find(key), end = eps.find('\n', at);
    if (at == std::string::npos || end == std::string::npos) return eps;
    return eps.replace(at + key.size(), end - at - key.size(),
                       fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(created))));
}

}  // namespace

// ---- the end -------------------------------------------------------------------------------------

Image Sheet::image() {
    end();
    handles_->finish();
    return std::move(handles_->image);
}

std::string Sheet::bytes() {
    cairo_show_page(cr_);
    end();
    handles_->finish();
    std::string file = std::move(handles_->stream);
    if (medium_ == Medium::eps) return with_date(std::move(file), document_.created);
    if (medium_ != Medium::svg) return file;
    // Cairo numbers its surfaces through the life of the program; the number is a name that nothing refers to.
    if (const std::size_t id = file.find("<g id=\"surface"); id != std::string::npos) {
        const std::size_t number = id + 14;
        file.erase(number, file.find('"', number) - number);
    }
    // Cairo says nothing about an SVG's content; it goes behind the opening tag.
    const std::size_t tag = file.find("<svg"), end = file.find('>', tag);
    if (end == std::string::npos) return file;
    file.insert(end + 1, fmt::format("\n<title>{}</title>\n<desc>{}</desc>\n<metadata>\n<creator>{}</creator>\n"
                                     "<scene>{}</scene>\n</metadata>",
                                     xml(document_.title), xml(document_.subject), xml(document_.creator),
                                     xml(document_.scene)));
    if (const std::size_t last = file.rfind("</svg>"); last != std::string::npos) file.insert(last, handles_->texts);
    return file;
}

}  // namespace beamcam::render::figure
