#include "render/film/parameter_line.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace beamcam::render {
namespace {

constexpr double kSmallTitle = 0.7, kSmallParameters = 0.85;  // of the usual sizes
constexpr double kBetweenParameters = 0.75;                   // gap between parameters, in sizes of their letters

// With ordinary spaces, for a terminal.
std::string plain(const std::string& markup) {
    std::string text = to_plain(markup);
    for (const std::string_view space : {"\u2009", "\u00A0"})
        for (std::size_t at = 0; (at = text.find(space, at)) != std::string::npos;) text.replace(at, space.size(), " ");
    return text;
}

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
    out.omitted.assign(pieces.begin() + std::ssize(out.pieces), pieces.end());
    return out;
}

std::vector<std::string> omitted_text(int width, int height, const std::optional<LayoutNode>& grid,
                                      const std::string& title, const std::vector<const sim::Problem*>& problems,
                                      const Shown& asked, SpeedUnit unit) {
    Shown shown = asked;
    shown.title = shown.title && !title.empty();
    const Layout places = layout(width, height, grid.value_or(LayoutNode{}), shown);
    std::vector<std::string> out;
    std::vector<std::string> missing;
    if (shown.parameters) missing = common_pieces(problems, unit);
    const bool titled = places.title && !title.empty();
    if (shown.title && !titled) out.emplace_back("the title");
    if (places.parameters || titled) {
        const Fonts fonts(needs_cjk(title));
        Image scratch(1, 1);
        const Canvas canvas(scratch, fonts);
        if (titled && fitted_title(canvas, title, *places.title, places.letters).back().cut)
            out.emplace_back("the end of the title");
        missing = parameter_line(canvas, places, missing).omitted;
    }
    for (const std::string& piece : missing) out.push_back(plain(piece));
    const bool colored = std::ranges::any_of(
        problems, [](const sim::Problem* p) { return p->cam.has_value() || p->beam.model != sim::ModelKind::rigid; });
    if (shown.legend && !places.scales && colored && places.first(PanelKind::mechanism))
        out.emplace_back("colour scales");
    return out;
}

}  // namespace beamcam::render
