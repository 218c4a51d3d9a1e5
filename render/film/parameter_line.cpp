#include "render/film/parameter_line.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "render/plot/labels.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

// The least size of the letters of parameters, whose scripts are smaller: about that of the numbers at axes.
double least_letters(const Layout& places) {
    constexpr double kAlwaysReadable = 10, kOfTicks = 0.9;  // [px]
    return std::clamp(kOfTicks * places.tick, kReadable, kAlwaysReadable);
}

// A row of text from `x` to `right`, on its baseline.
struct TextRow {
    double x = 0, right = 0, y = 0;
};

// Positions of as many pieces, in order, as fit into the rows.
std::vector<Vec2> placed(const Canvas& canvas, const std::vector<std::string>& pieces, const TextStyle& style,
                         double gap, const std::vector<TextRow>& rows) {
    std::vector<Vec2> out;
    std::size_t row = 0;
    double x = rows.front().x;
    for (const std::string& piece : pieces) {
        const double w = canvas.measure(piece, style).w;
        while (row < rows.size() && x + w > rows[row].right)
            if (++row < rows.size()) x = rows[row].x;
        if (row == rows.size()) break;
        out.push_back({x, rows[row].y});
        x += w + gap;
    }
    return out;
}

double usual_baseline(const Box& box, double u, std::size_t line, std::size_t count) {
    const double first = count == 1 ? 38 : count == 2 ? 18 : 14, apart = count == 2 ? 28 : 17;
    return box.y + (first + apart * static_cast<double>(line)) * u;
}

// With ordinary spaces, for a terminal.
std::string plain(const std::string& markup) {
    std::string text = to_plain(markup);
    for (const std::string_view space : {"\u2009", "\u00A0"})
        for (std::size_t at = 0; (at = text.find(space, at)) != std::string::npos;) text.replace(at, space.size(), " ");
    return text;
}

// Lines with tall formulas move up into the margin so that they overlap neither each other nor the line below; if that
// is not enough, the letters shrink.
void keep_apart(Canvas& canvas, const Box& box, double u, FittedTitle& title) {
    const double most_up = 20 * u, air = 2 * u;
    for (int round = 0; round < 12; ++round, title.style.size *= 0.9) {
        double lowest = box.bottom() + u, top = box.y;
        for (std::size_t i = title.lines.size(); i-- > 0;) {
            FittedTitle::Line& line = title.lines[i];
            const Box ink = canvas.measure(line.markup, title.style);
            line.baseline.y = std::min(usual_baseline(box, u, i, title.lines.size()), lowest - ink.bottom());
            top = line.baseline.y + ink.y;
            lowest = top - air;
        }
        if (top >= box.y - most_up) return;
    }
}

}  // namespace

TextStyle title_style(double u, Color color) { return {.size = 40 * u, .color = color, .weight = Weight::semibold}; }

FittedTitle fitted_title(Canvas& canvas, const std::string& title, const Box& box, double u, Color color) {
    constexpr double kSmallest = 2.0 / 3, kShares[] = {0.66, 0.6, 0.55, 0.48, 0.4, 0.36};  // of the full size
    constexpr double kOfThree = 0.36;                                                      // the size of three lines
    FittedTitle out;
    out.style = title_style(u, color);
    const std::string whole = text_markup(title);
    const double natural = canvas.measure(whole, out.style).w, full = out.style.size;
    const auto set = [&](double share) {
        const std::size_t most = share > kOfThree ? 2 : 3;
        out.style.size = share * full;
        out.style.max_width = 0;
        const auto width = [&](const std::string& line) { return canvas.measure(line, out.style).w; };
        TextStyle within = out.style;
        within.max_width = box.w;
        std::vector<std::string> lines = wrapped_lines(canvas, title, within, most);
        // Lines of similar length are easier to read than a single word on the second line.
        while (lines.size() == 2 && width(lines[1]) < 0.6 * width(lines[0])) {
            within.max_width *= 0.95;
            std::vector<std::string> narrower = wrapped_lines(canvas, title, within, 2);
            if (width(narrower.back()) > within.max_width) break;
            lines = std::move(narrower);
        }
        out.lines.clear();
        for (std::size_t i = 0; i < lines.size(); ++i)
            out.lines.push_back({lines[i], {box.x, usual_baseline(box, u, i, lines.size())}});
        out.cut = std::ranges::any_of(lines, [&](const std::string& line) { return width(line) > box.w; }) ||
                  (lines.back().ends_with("…") && !title.ends_with("…"));
    };
    if (kSmallest * natural > box.w) {
        for (const double share : kShares)
            if (set(share); !out.cut) break;
    } else {
        out.lines = {{whole, {box.x, usual_baseline(box, u, 0, 1)}}};
        if (natural > box.w) out.style.size *= 0.999 * box.w / natural;
    }
    keep_apart(canvas, box, u, out);
    out.style.max_width = box.w;
    return out;
}

ParameterLine parameter_line(Canvas& canvas, const Layout& places, const std::string& title,
                             const std::vector<std::string>& pieces) {
    ParameterLine out;
    if (!places.parameters) {
        out.omitted = pieces;
        return out;
    }
    const double u = places.unit;
    const Box& b = *places.parameters;
    std::vector<TextRow> rows{{b.x, b.right(), b.y + 24 * u}};
    const auto choose = [&](const std::vector<TextRow>& into) {
        for (const auto& [size, gap] : {std::pair{21, 26}, {21, 16}, {19, 16}, {17, 14}}) {
            if (size * u < least_letters(places)) continue;
            const TextStyle style{.size = size * u};
            const std::vector<Vec2> at = placed(canvas, pieces, style, gap * u, into);
            if (at.size() <= out.pieces.size()) continue;
            out.size = style.size;
            out.pieces.clear();
            for (std::size_t i = 0; i < at.size(); ++i) out.pieces.push_back({pieces[i], at[i]});
        }
    };
    choose(rows);
    if (out.pieces.size() < pieces.size() && places.title) {
        const TextRow above{b.x, b.right(), places.title->y + 38 * u};
        rows.insert(rows.begin(), above);  // beside the title
        if (!title.empty()) rows.front().x += canvas.measure(text_markup(title), title_style(u)).w + 40 * u;
        choose(rows);
    }
    out.omitted.assign(pieces.begin() + static_cast<std::ptrdiff_t>(out.pieces.size()), pieces.end());
    return out;
}

std::vector<std::string> omitted_text(int width, int height, const std::optional<LayoutNode>& grid, int members,
                                      const std::string& title, const std::vector<const sim::Problem*>& problems,
                                      const Shown& asked, SpeedUnit unit) {
    Shown shown = asked;
    shown.title = shown.title && !title.empty();
    const Layout places = grid ? layout(width, height, *grid, shown)
                               : layout(width, height, std::vector<PanelSpec>{}, members, {}, shown);
    std::vector<std::string> out;
    std::vector<std::string> missing;
    if (shown.parameters) missing = common_pieces(problems, unit);
    const bool titled = places.title && !title.empty();
    if (shown.title && !titled) out.emplace_back("the title");
    if (places.parameters || titled) {
        const Fonts fonts(needs_cjk(title));
        Image scratch(1, 1);
        Canvas canvas(scratch, fonts);
        if (titled && fitted_title(canvas, title, *places.title, places.unit).cut)
            out.emplace_back("the end of the title");
        missing = parameter_line(canvas, places, title, missing).omitted;
    }
    for (const std::string& piece : missing) out.push_back(plain(piece));
    const bool colored = std::ranges::any_of(
        problems, [](const sim::Problem* p) { return p->cam.has_value() || p->beam.model != sim::ModelKind::rigid; });
    if (shown.legend && !places.scales && colored && places.first(PanelKind::mechanism))
        out.emplace_back("colour scales");
    return out;
}

}  // namespace beamcam::render
