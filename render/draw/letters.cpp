#include "render/draw/letters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "render/draw/painter.hpp"

namespace beamcam::render {
namespace {

// The letters of each set of typefaces.
struct Typography {
    const char *family, *symbols;  // of text, and of the italic symbols of mathematics
    const char* cjk;               // of Chinese, Japanese and Korean
    double symbol_size;            // relative: the x-heights of both become equal
    bool light_symbols;            // symbols are regular in bold text, too
    LetterRules rules;
};
// Pictures: scripts have the size and place that Inter defines in its table OS/2.
constexpr Typography kScreenLetters{
    "Inter,STIXGeneral,STIX Two Text,Noto Sans CJK SC",
    "STIXGeneral,STIX Two Text",
    "Noto Sans CJK SC",
    1.12,
    true,
    {.cap_height = 0.727, .script_size = 1690. / 2816, .raised = 986. / 2816, .lowered = 0.17, .behind_italic = 0}};
// No letter of a page is smaller than 6 pt, sub- and superscripts included.
constexpr Typography kPrintLetters{
    "Liberation Sans,Droid Sans Fallback", "Liberation Serif,Droid Sans Fallback", "Droid Sans Fallback", 1.12, false,
    {.cap_height = 0.716, .smallest = 6}};
constexpr Typography kSerifLetters{
    "Liberation Serif,Droid Sans Fallback", "Liberation Serif,Droid Sans Fallback", "Droid Sans Fallback", 1, false,
    {.cap_height = 0.655, .smallest = 6}};

const Typography& typography(Typefaces typefaces) {
    return typefaces == Typefaces::screen  ? kScreenLetters
           : typefaces == Typefaces::print ? kPrintLetters
                                           : kSerifLetters;
}

// Runs of Chinese, Japanese and Korean are written by one font, although those of mathematics have a few of the
// letters.
void add_cjk_runs(PangoAttrList* attributes, const char* family, const std::string& text) {
    const char *const begin = text.data(), *const end = begin + text.size();
    for (const char* at = begin; at < end;) {
        const char* const from = at;
        while (at < end && is_cjk(g_utf8_get_char(at))) at = g_utf8_next_char(at);
        if (at == from) {
            at = g_utf8_next_char(at);
            continue;
        }
        PangoAttribute* run = pango_attr_family_new(family);
        run->start_index = static_cast<guint>(from - begin), run->end_index = static_cast<guint>(at - begin);
        pango_attr_list_insert(attributes, run);
    }
}

PangoLayout* make_layout(PangoContext* context, const LetterFace& face, const std::string& text, const Typography& t) {
    PangoLayout* layout = pango_layout_new(context);
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family_static(font, face.family);
    pango_font_description_set_style(font, face.italic ? PANGO_STYLE_ITALIC : PANGO_STYLE_NORMAL);
    pango_font_description_set_weight(font, static_cast<PangoWeight>(face.weight));
    pango_font_description_set_absolute_size(font, face.size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    pango_layout_set_ellipsize(layout, face.max_width > 0 ? PANGO_ELLIPSIZE_END : PANGO_ELLIPSIZE_NONE);
    pango_layout_set_width(layout, face.max_width > 0 ? static_cast<int>(face.max_width * PANGO_SCALE) : -1);
    PangoAttrList* attributes = pango_attr_list_new();
    if (face.tabular) pango_attr_list_insert(attributes, pango_attr_font_features_new("tnum=1"));
    add_cjk_runs(attributes, t.cjk, text);
    pango_layout_set_attributes(layout, attributes);
    pango_attr_list_unref(attributes);
    pango_layout_set_text(layout, text.data(), static_cast<int>(text.size()));
    return layout;
}

bool is_drawn(PangoContext* context, const LetterFace& face, const std::string& text, const Typography& t) {
    PangoLayout* layout = make_layout(context, face, text, t);
    const bool known = pango_layout_get_unknown_glyphs_count(layout) == 0;
    g_object_unref(layout);
    return known;
}

std::string missing_glyphs(std::string_view text) {
    return fmt::format("no font of the figure can write \"{}\"; {}", text,
                       needs_cjk(text) ? "install the Debian package fonts-droid-fallback"
                                       : "use other characters, or install the Debian packages fonts-liberation and "
                                         "fonts-droid-fallback");
}

}  // namespace

std::string LetterFace::key(std::string_view text) const {
    const double numbers[] = {size, max_width, static_cast<double>(weight) + (italic ? 0.5 : 0) + (tabular ? 0.25 : 0)};
    return std::string(reinterpret_cast<const char*>(numbers), sizeof numbers).append(text);
}

LetterFace face_of(const SetRun& set, const TextStyle& style, Typefaces typefaces) {
    const Typography& t = typography(typefaces);
    const bool symbol = set.run.symbol;
    const double room = set.x > 0 ? std::max(set.size, style.max_width - set.x) : style.max_width;
    return {.family = symbol ? t.symbols : t.family,
            .size = symbol ? t.symbol_size * set.size : set.size,
            .weight = symbol && t.light_symbols ? Weight::regular : style.weight,
            .italic = symbol,
            .tabular = style.tabular,
            .max_width = style.max_width > 0 && !symbol ? room : 0};
}

std::string drawable(const Fonts& fonts, std::string_view text) {
    std::string out;
    const char* end = text.data() + text.size();
    for (const char* at = text.data(); at < end; at = g_utf8_next_char(at)) {
        const gunichar character = g_utf8_get_char_validated(at, end - at);
        if (character >= gunichar(-2)) break;  // invalid UTF-8, which the scene reader has already rejected
        const std::string one(at, static_cast<std::size_t>(g_utf8_next_char(at) - at));
        // Joiners and variation selectors are not visible.
        if (character == 0x200D || (character >= 0xFE00 && character <= 0xFE0F)) continue;
        const Typography& t = typography(fonts.typefaces());
        if (character < 0x80 || is_drawn(fonts.handles().context, {.family = t.family}, one, t)) out += one;
    }
    return out;
}

PangoLayout* layout_of(const Fonts& fonts, const LetterFace& face, const std::string& text) {
    const Fonts::Handles& handles = fonts.handles();
    return handles.layouts.get(face.key(text), [&] {
        const Typography& t = typography(fonts.typefaces());
        PangoLayout* layout = make_layout(handles.context, face, text, t);
        if (pango_layout_get_unknown_glyphs_count(layout) == 0) return layout;
        g_object_unref(layout);
        if (fonts.typefaces() != Typefaces::screen) throw FontError(missing_glyphs(text));
        return make_layout(handles.context, face, drawable(fonts, text), t);
    });
}

double baseline_of(PangoLayout* layout) { return static_cast<double>(pango_layout_get_baseline(layout)) / PANGO_SCALE; }

double Painter::cap_height(double size) const { return typography(fonts_->typefaces()).rules.cap_height * size; }

SetLabel set_text(const Fonts& fonts, std::string_view markup, const TextStyle& style) {
    constexpr double kLetterTop = 0.76;  // of any letter of a page, relative to its size
    const bool screen = fonts.typefaces() == Typefaces::screen;
    const auto extent = [&](const SetRun& run) -> RunExtent {
        PangoLayout* layout = layout_of(fonts, run, style);
        PangoRectangle ink, logical;
        pango_layout_get_extents(layout, screen ? &ink : nullptr, &logical);
        constexpr double k = 1.0 / PANGO_SCALE;
        if (!screen) return {logical.width * k, kLetterTop * run.size, {}};
        const double top = ink.y * k - baseline_of(layout);
        return {logical.width * k, -top, {ink.x * k, top, ink.width * k, ink.height * k}};
    };
    return set_label(parse_markup(markup), style.size, typography(fonts.typefaces()).rules, extent);
}

}  // namespace beamcam::render
