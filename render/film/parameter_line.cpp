#include "render/film/parameter_line.hpp"

#include <algorithm>

namespace beamcam::render {
namespace {

constexpr double kSmallTitle = 0.7, kSmallParameters = 0.85;  // of the usual sizes
constexpr double kBetweenParameters = 0.75;                   // gap between parameters, in sizes of their letters

}  // namespace

TextStyle title_style(const Letters& letters, Color color) {
    return {.size = letters.title, .color = color, .weight = Weight::semibold};
}

std::vector<FittedText> fitted_title(const Canvas& canvas, const std::string& title, const Box& box,
                                     const Letters& letters) {
    TextStyle style = title_style(letters);
    const FittedText whole = fitted_text(canvas, title, style, kSmallTitle * letters.title, box.w);
    if (!whole.cut) return {whole};
    style.size = letters.heading;
    const auto fitted = [&](const std::string& text) { return fitted_text(canvas, text, style, style.size, box.w); };
    std::size_t end = 0;  // of the first line
    bool formula = false;
    for (std::size_t i = 1; i < title.size(); ++i) {
        formula = formula != (title[i - 1] == '$');
        if (title[i] == ' ' && !formula && !fitted(title.substr(0, i)).cut) end = i;
    }
    if (end == 0) return {whole};
    return {fitted(title.substr(0, end)), fitted(title.substr(end + 1))};
}

ParameterLine parameter_line(const Canvas& canvas, const Layout& places, const std::vector<std::string>& pieces) {
    ParameterLine out;
    for (const double size : {1.0, kSmallParameters}) {
        if (!places.parameters) break;
        const Box& b = *places.parameters;
        out.size = std::max(size * places.letters.words, kReadable);
        out.pieces.clear();
        for (double x = b.x; const std::string& piece : pieces) {
            const double end = x + canvas.measure(piece, {.size = out.size}).w;
            if (end > b.right()) break;
            out.pieces.push_back({piece, {x, b.y + 1.2 * places.letters.words}});
            x = end + kBetweenParameters * out.size;
        }
        if (out.pieces.size() == pieces.size()) break;
    }
    return out;
}

}  // namespace beamcam::render
