#include "render/film/parameter_line.hpp"

namespace beamcam::render {

TextStyle title_style(const Letters& letters, Color color) {
    return {.size = letters.title, .color = color, .weight = Weight::semibold};
}

std::vector<FittedText> fitted_lines(const Canvas& canvas, const std::string& text, TextStyle style, double smaller,
                                     double smallest, double width) {
    const FittedText whole = fitted_text(canvas, text, style, smaller, width);
    if (!whole.cut) return {whole};
    style.size = smallest;
    const auto fitted = [&](const std::string& part) { return fitted_text(canvas, part, style, smallest, width); };
    std::size_t end = 0;  // of the first line
    bool formula = false;
    for (std::size_t i = 1; i < text.size(); ++i) {
        formula = formula != (text[i - 1] == '$');
        if (text[i] == ' ' && !formula && !fitted(text.substr(0, i)).cut) end = i;
    }
    if (end == 0) return {whole};
    return {fitted(text.substr(0, end)), fitted(text.substr(end + 1))};
}

ParameterLine parameter_line(const Canvas& canvas, const Layout& places, const std::vector<std::string>& pieces) {
    constexpr double kBetween = 0.75;  // parameters, in sizes of their letters
    ParameterLine out{.size = places.letters.words, .pieces = {}};
    if (!places.parameters) return out;
    const Box& b = *places.parameters;
    for (Vec2 at{b.x, b.y + 1.2 * out.size}; const std::string& piece : pieces) {
        const double width = canvas.measure(piece, {.size = out.size}).w;
        if (at.x + width > b.right()) at = {b.x, at.y + 1.3 * out.size};
        if (at.x + width > b.right() || at.y > b.bottom()) break;
        out.pieces.push_back({piece, at});
        at.x += width + kBetween * out.size;
    }
    return out;
}

}  // namespace beamcam::render
