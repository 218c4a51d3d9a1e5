// A figure on its page: panels above each other or side by side, with their plots aligned.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "render/base/error.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/panel.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kSideBySideFrom = 125;                    // [mm]: wider pages have panels side by side
constexpr double kNarrowestPage = 20, kWidestPage = 2000;  // [mm]
constexpr double kPageEdge = 1.5;                          // margin of the page [pt]
constexpr double kSmallOnSlides = 14;                      // size of letters where the larger ones have no room [pt]

struct Grid {
    std::size_t rows = 1, columns = 1;
};

Grid grid_of(const Figure& figure, double width) {
    const std::size_t n = std::max<std::size_t>(1, figure.panels.size());
    if (figure.in_pairs) return {(n + 1) / 2, std::min<std::size_t>(n, 2)};
    if (figure.stack || width < kSideBySideFrom || n == 1) return {n, 1};
    const std::size_t columns = n == 4 ? 2 : std::min<std::size_t>(n, 3);
    return {(n + columns - 1) / columns, columns};
}

class FigureLayout {
  public:
    FigureLayout(const Figure& figure, const Page& page, PageCanvas& sheet)
        : figure_(figure), page_(page), sheet_(sheet), grid_(grid_of(figure, page.width)) {}

    // Whether all plots have room; draws nothing.
    bool arrange() {
        make_drawings();
        // Margins depend on numbers, lines of labels and rows of legends, which depend on the plots' sizes.
        constexpr int kRounds = 3;
        for (int round = 0; round < kRounds; ++round) {
            measure(round + 1 == kRounds);  // the last margins only grow, else lines could alternate
            for (std::size_t i = 0; i < drawings_.size(); ++i) {
                if (!drawings_[i]) continue;
                if (lacks_room(i)) return false;
                drawings_[i]->place(plot(i));
            }
        }
        for (std::size_t i = 0; i < drawings_.size(); ++i)  // titles in narrow panels have more lines at last
            if (drawings_[i] && drawings_[i]->margins().top > margins_[i / grid_.columns].top + 1) return false;
        return true;
    }

    void draw() const {
        for (std::size_t i = 0; i < drawings_.size(); ++i) {
            if (drawings_[i])
                drawings_[i]->draw(bar_beside(i));
            else
                draw_shapes(figure_.panels[i], page_.style, sheet_, cell(i));
        }
    }

    // Why the last arrangement failed: not wide enough, else not high enough.
    bool is_narrow() const { return narrow_; }

  private:
    bool lowest(std::size_t i) const { return !figure_.share_x || grid_.columns > 1 || i + 1 == figure_.panels.size(); }

    // Panels above each other that have the same curves share the legend of the first.
    bool shows_legend(std::size_t i) const {
        const Panel& panel = figure_.panels[i];
        if (!panel.legend || i == 0 || grid_.columns > 1) return panel.legend;
        const Panel& above = figure_.panels[i - 1];
        const auto labels = [](const Panel& p) {
            std::vector<std::string> all;
            for (const Series& curve : p.series) all.push_back(curve.label);
            return all;
        };
        const bool curves_alone = panel.bands.empty() && panel.clouds.empty() && panel.swatches.empty();
        return !(curves_alone && above.legend && labels(above) == labels(panel));
    }

    // Panels above each other that have the same colour bar share one, as high as all of them.
    Box bar_beside(std::size_t i) const {
        const auto has_same_bar = [&](const Panel& p) { return p.color_bar == figure_.panels[0].color_bar; };
        if (grid_.columns > 1 || !std::ranges::all_of(figure_.panels, has_same_bar)) return plot(i);
        if (i > 0) return {};
        const Box first = plot(0), last = plot(figure_.panels.size() - 1);
        return {first.x, first.y, first.w, last.bottom() - first.y};
    }

    void make_drawings() {
        const Box one = cell(0);
        for (std::size_t i = 0; i < figure_.panels.size(); ++i) {
            const Panel& panel = figure_.panels[i];
            const std::string what = fmt::format("figure {}{}", figure_.name,
                                                 figure_.panels.size() > 1 ? fmt::format(", panel {}", i + 1) : "");
            drawings_.push_back(panel.shapes.empty()
                                    ? std::make_unique<PanelDrawing>(panel, page_.style, sheet_, 0.8 * one.w,
                                                                     0.75 * cell(i).h, lowest(i), shows_legend(i), what)
                                    : nullptr);
        }
    }

    Box cell(std::size_t i) const {
        const Box page = Box{0, 0, points(page_.width), points(page_.height)}.inset(kPageEdge);
        const double between = 2.2 * page_.style.gap;
        const auto columns = static_cast<double>(grid_.columns);
        const double w = (page.w - between * 2 * (columns - 1)) / columns;
        const std::size_t row = i / grid_.columns, column = i % grid_.columns;
        double above = 0, all = 0, mine = 1;
        for (std::size_t r = 0; r < grid_.rows; ++r) {
            const double share = grid_.columns > 1 ? 1 : figure_.panels[std::min(r, figure_.panels.size() - 1)].share;
            if (r < row) above += share;
            if (r == row) mine = share;
            all += share;
        }
        // Rows share the height without the margins, so that the plots have the shares.
        const auto rows = static_cast<double>(grid_.rows);
        double fixed = between * (rows - 1), before = between * static_cast<double>(row);
        for (std::size_t r = 0; r < margins_.size(); ++r) {
            const double m = margins_[r].top + margins_[r].bottom;
            fixed += m;
            if (r < row) before += m;
        }
        const double own = row < margins_.size() ? margins_[row].top + margins_[row].bottom : 0;
        const double shared = std::max(page.h - fixed, 1.0);
        return {page.x + static_cast<double>(column) * (w + 2 * between), page.y + before + shared * above / all, w,
                shared * mine / all + own};
    }

    void measure(bool grow) {
        std::vector<Margins> rows(grid_.rows);
        double left = 0, right = 0;
        for (std::size_t i = 0; i < drawings_.size(); ++i) {
            if (!drawings_[i]) continue;
            const Margins m = drawings_[i]->margins();
            Margins& row = rows[i / grid_.columns];
            row.top = std::max(row.top, m.top);
            row.bottom = std::max(row.bottom, m.bottom);
            left = std::max(left, m.left);
            right = std::max(right, m.right);
        }
        for (std::size_t r = 0; r < rows.size() && grow; ++r)
            rows[r] = {std::max(rows[r].left, margins_[r].left), std::max(rows[r].right, margins_[r].right),
                       std::max(rows[r].top, margins_[r].top), std::max(rows[r].bottom, margins_[r].bottom)};
        margins_ = rows;
        left_ = grow ? std::max(left, left_) : left;
        right_ = grow ? std::max(right, right_) : right;
    }

    Box plot(std::size_t i) const {
        const Box c = cell(i);
        const Margins& row = margins_[i / grid_.columns];
        return {c.x + left_, c.y + row.top, c.w - left_ - right_, c.h - row.top - row.bottom};
    }

    // Tick labels need room, and so does a legend above the plot, which may extend over the right margin.
    bool lacks_room(std::size_t i) {
        const double lines = figure_.panels[i].y.numbered ? 4 : 2;
        narrow_ = plot(i).w < std::max(4 * page_.style.letters, drawings_[i]->width_of_legend() - right_);
        return narrow_ || plot(i).h < lines * page_.style.letters;
    }

    const Figure& figure_;
    const Page& page_;
    PageCanvas& sheet_;
    Grid grid_;
    std::vector<Margins> margins_;
    double left_ = 0, right_ = 0;
    std::vector<std::unique_ptr<PanelDrawing>> drawings_;
    bool narrow_ = false;  // the plot that lacked room
};

}  // namespace

Page page_of(const Figure& figure, const Column& column, std::optional<double> width) {
    Page page;
    page.style = style_of(column);
    page.width = width.value_or(column.width);
    if (!(page.width >= kNarrowestPage && page.width <= kWidestPage))
        throw PictureError(fmt::format("a figure {:g} mm wide cannot be drawn; its width is {:g} … {:g} mm", page.width,
                                       kNarrowestPage, kWidestPage));
    const Grid grid = grid_of(figure, page.width);
    // Wide figures are flatter; panels side by side share the width.
    const double wide = page.width / static_cast<double>(grid.columns);
    const double flat = std::min(1.0, std::sqrt(90 / std::max(wide, 1.0)));
    double aspect = figure.aspect;
    if (grid.columns > 1) aspect *= static_cast<double>(grid.rows) / static_cast<double>(figure.panels.size()) * 1.1;
    if (figure.height) {
        page.height = *figure.height;
        return page;
    }
    page.height = column.height > 0 && !width ? column.height : wide * aspect * (column.height > 0 ? 1 : flat);
    return page;
}

void draw(const Figure& figure, const Page& page, PageCanvas& sheet) {
    if (figure.panels.empty()) throw PictureError(fmt::format("figure {}: nothing to draw", figure.name));
    // The large letters of a slide have a second size.
    Page fitted = page;
    for (const double letters : {page.style.letters, std::min(page.style.letters, kSmallOnSlides)}) {
        fitted.style = scaled(page.style, letters / page.style.letters);
        FigureLayout layout(figure, fitted, sheet);
        if (layout.arrange()) return layout.draw();
        if (letters <= kSmallOnSlides)
            throw PictureError(
                fmt::format("figure {}: a page of {:.4g} × {:.4g} mm leaves no room for the plot beside "
                            "its labels; make it {}",
                            figure.name, page.width, page.height, layout.is_narrow() ? "wider" : "higher"));
    }
}

static std::string words_of(const Panel& p) {
    std::string all = p.title + p.x.label + p.y.label;
    if (p.color_bar) all += p.color_bar->label;
    for (const Series& s : p.series) all += s.label;
    for (const Band& b : p.bands) all += b.label;
    for (const Cloud& c : p.clouds) all += c.label;
    for (const Swatch& w : p.swatches) all += w.label;
    for (const Mark& m : p.marks) all += m.label;
    for (const Shape& s : p.shapes) all += s.markup;
    return all;
}
bool needs_chinese(const Figure& figure) {
    return std::ranges::any_of(figure.panels, [](const Panel& p) { return needs_cjk(words_of(p)); });
}

}  // namespace beamcam::render::figure
