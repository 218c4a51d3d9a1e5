#include "render/film/caption_band.hpp"

#include <algorithm>

namespace beamcam::render {
namespace {

constexpr double kCaption = 22 / 20.0;  // size of letters, in that of headings

TextStyle style_of(double size, Color color) {
    return {.size = size, .color = color, .weight = Weight::medium, .align = HAlign::centre};
}

}  // namespace

CaptionBand::CaptionBand(const FilmContext& context) : context_(context) {
    if (!context.places.captions) return;
    Image scratch(1, 1);
    const Canvas canvas(scratch, *context.fonts);
    const Letters& letters = context.look.letters;
    for (const Callout& each : context.setup->callouts)
        texts_.push_back(fitted_lines(canvas, each.text, style_of(kCaption * letters.heading, {}), letters.words,
                                      letters.words, context.places.captions->w));
}

bool CaptionBand::cuts_texts() const {
    return std::ranges::any_of(texts_, [](const auto& lines) { return lines.back().cut; });
}

void CaptionBand::draw(Canvas& canvas, int frame) const {
    const std::vector<Callout>& callouts = context_.setup->callouts;
    for (std::size_t i = texts_.size(); i-- > 0;) {
        if (!callouts[i].shown(frame)) continue;
        const Box& b = *context_.places.captions;
        const double size = texts_[i].front().size;
        const TextStyle style = style_of(size, context_.look.palette.ink.faded(callouts[i].opacity(frame)));
        Vec2 at{b.centre().x, texts_[i].size() > 1 ? b.y + 0.8 * size : b.centre().y + 0.36 * size};
        for (const FittedText& line : texts_[i]) canvas.text(at, line.markup, style), at.y += 1.25 * size;
        return;
    }
}

}  // namespace beamcam::render
