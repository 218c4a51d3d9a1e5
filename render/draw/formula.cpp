#include "render/draw/formula.hpp"

#include "render/draw/canvas.hpp"
#include "render/draw/label.hpp"

namespace beamcam::render {
namespace {

constexpr char kBegin = '\x01', kEnd = '\x02';
constexpr double kInterCaps = 0.727;  // height of Inter's capitals relative to the size

std::string pango_markup(const Run& run) {
    std::string out = escape(run.text);
    if (run.symbol) out = math(out);
    return run.bold ? "<b>" + out + "</b>" : out;
}

}  // namespace

std::string formula(std::string_view markup) { return kBegin + std::string(markup) + kEnd; }
bool has_formula(std::string_view text) { return text.find(kBegin) != std::string_view::npos; }

std::vector<TextPart> text_parts(std::string_view text) {
    std::vector<TextPart> parts;
    while (!text.empty()) {
        const bool formula = text.front() == kBegin;
        const std::size_t end = std::min(text.find(formula ? kEnd : kBegin), text.size());
        parts.push_back({formula, std::string(text.substr(formula, end - formula))});
        text.remove_prefix(std::min(end + formula, text.size()));
    }
    return parts;
}

Box Canvas::set_parts(Vec2 at, const std::string& markup, const TextStyle& style, bool draws) {
    TextStyle plain = style;
    plain.align = HAlign::left;
    const auto letters_of = [&](double size) {
        TextStyle letters = plain;
        letters.size = size, letters.max_width = 0;
        return letters;
    };
    const auto extent = [&](const Run& run, double size) -> LetterMetrics::Extent {
        const Box box = measure(pango_markup(run), letters_of(size));
        return {box.w, -box.y};
    };
    double x = 0;
    Bounds ink;
    for (const TextPart& part : text_parts(markup)) {
        if (part.formula) {
            const SetLabel label = set_label(parse_markup(part.markup), style.size, {extent, kInterCaps});
            if (draws)
                draw_label(label, at + Vec2{x, 0}, style.size, style.color,
                           [&](const SetRun& run, Vec2 p) { text(p, pango_markup(run.run), letters_of(run.size)); });
            if (!label.runs.empty()) ink.add({x, -label.ascent}), ink.add({x + label.width, label.descent});
            x += label.width;
        } else {
            if (style.max_width > 0) plain.max_width = std::max(style.size, style.max_width - x);
            const Box box = measure(part.markup, plain);
            if (draws) text(at + Vec2{x, 0}, part.markup, plain);
            if (box.h > 0) ink.add({x, box.y}), ink.add({x + box.w, box.bottom()});
            x += box.w;
        }
    }
    return {at.x, at.y + ink.box().y, x, ink.box().h};
}

}  // namespace beamcam::render
