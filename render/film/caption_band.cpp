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
        texts_.push_back(fitted_text(canvas, each.text, style_of(kCaption * letters.heading, {}), letters.words,
                                     context.places.captions->w));
}

bool CaptionBand::cuts_texts() const { return std::ranges::any_of(texts_, &FittedText::cut); }

void CaptionBand::draw(Canvas& canvas, int frame) const {
    const std::vector<Callout>& callouts = context_.setup->callouts;
    for (std::size_t i = texts_.size(); i-- > 0;) {
        if (!callouts[i].shown(frame)) continue;
        const Vec2 middle = context_.places.captions->centre();
        const double size = texts_[i].size;
        return void(canvas.text(middle + Vec2{0, 0.36 * size}, texts_[i].markup,
                                style_of(size, context_.look.palette.ink.faded(callouts[i].opacity(frame)))));
    }
}

}  // namespace beamcam::render
