#include "render/plot/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace beamcam::render::figure {
namespace {

constexpr std::size_t kMostDots = 30'000;                // of a cloud that is drawn dot by dot: about 200 kB of PDF
constexpr double kCellOverlap = 0.2;                     // of cells that are drawn one by one [pt]
constexpr double kLargestDot = 1.6, kSmallestDot = 0.3;  // sides: of kFewDots and of kMostDots [pt]
constexpr double kFewDots = 100;
constexpr double kCloudPixel = kPointsPerInch / 300;  // of a picture of a cloud [pt]
constexpr double kFaintest = 0.5;                     // opacity of a cell that one point fell into

std::uint32_t pixel(Color c) {
    const auto channel = [&](double value) {
        return static_cast<std::uint32_t>(std::lround(255 * std::clamp(value * c.a, 0.0, 1.0)));
    };
    const auto alpha = static_cast<std::uint32_t>(std::lround(255 * std::clamp(c.a, 0.0, 1.0)));
    return alpha << 24 | channel(c.r) << 16 | channel(c.g) << 8 | channel(c.b);
}

// Whether the edges are equally spaced.
template <class Place>
bool is_even(const std::vector<double>& edges, const Place& place) {
    const auto cells = static_cast<double>(edges.size() - 1);
    const double first = place(edges.front()), step = (place(edges.back()) - first) / cells;
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (!(std::fabs(place(edges[i]) - first - step * static_cast<double>(i)) < 0.05 * std::fabs(step)))
            return false;
    return true;
}

// Cells of a plot.
struct PixelGrid {
    Box plot;
    int columns, rows;

    std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    // None outside the plot.
    std::optional<std::size_t> cell(const Vec2& p) const {
        if (!(p.x >= plot.x && p.x <= plot.right() && p.y >= plot.y && p.y <= plot.bottom())) return std::nullopt;
        const int column = std::min(columns - 1, static_cast<int>((p.x - plot.x) / plot.w * columns));
        const int row = std::min(rows - 1, static_cast<int>((p.y - plot.y) / plot.h * rows));
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    }
};
PixelGrid pixels_of(const Box& plot) {
    return {plot, static_cast<int>(plot.w / kCloudPixel), static_cast<int>(plot.h / kCloudPixel)};
}

// One place for each pixel that holds points: periodic motions return to the same places.
std::vector<Vec2> different_places(const Cloud& cloud, const Plot& plot) {
    const PixelGrid grid = pixels_of(plot.box());
    std::vector<bool> taken(grid.size());
    std::vector<Vec2> places;
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
        const Vec2 p = plot.at(cloud.x[i], cloud.y[i]);
        const std::optional<std::size_t> cell = grid.cell(p);
        if (!cell || taken[*cell]) continue;
        taken[*cell] = true;
        places.push_back(p);
    }
    return places;
}

void draw_dots(const std::vector<Vec2>& places, Color color, PageCanvas& sheet) {
    const double crowd = std::log(static_cast<double>(places.size()) / kFewDots) / std::log(kMostDots / kFewDots);
    const double side = kLargestDot * std::pow(kSmallestDot / kLargestDot, std::clamp(crowd, 0.0, 1.0));
    for (const Vec2& p : places) sheet.rectangle({p.x - side / 2, p.y - side / 2, side, side});
    sheet.fill(color);
}

// Columns of an image: one for each different x if these are equally spaced and coarser than pixels.
int columns_of(const Cloud& cloud, const Plot& plot, int most) {
    std::vector<double> places;
    for (const double x : cloud.x)
        if (places.empty() || x != places.back()) places.push_back(x);
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < places.size(); ++i)
        least = std::min(least, plot.along_x(places[i]) - plot.along_x(places[i - 1]));
    const double even = plot.box().w / least;
    return even >= 1 && even < most ? static_cast<int>(std::ceil(even)) : most;
}

// The number of points in each pixel on a logarithmic scale.
void draw_density(const Cloud& cloud, const Plot& plot, PageCanvas& sheet) {
    PixelGrid grid = pixels_of(plot.box());
    grid.columns = columns_of(cloud, plot, grid.columns);
    std::vector<std::uint32_t> counts(grid.size(), 0);
    std::uint32_t most = 1;
    for (std::size_t i = 0; i < cloud.x.size(); ++i)
        if (const auto cell = grid.cell(plot.at(cloud.x[i], cloud.y[i]))) most = std::max(most, ++counts[*cell]);
    Image image(grid.columns, grid.rows);
    for (std::size_t k = 0; k < counts.size(); ++k) {
        if (counts[k] == 0) continue;
        const double share = most == 1 ? 1 : std::log(counts[k]) / std::log(most);
        image.pixels[k] = pixel(sheet.shown(cloud.color).faded(kFaintest + (1 - kFaintest) * share));
    }
    sheet.pixels(image, grid.plot);
}

}  // namespace

void draw_cloud(const Cloud& cloud, const Plot& plot, PageCanvas& sheet) {
    const std::vector<Vec2> places = different_places(cloud, plot);
    if (places.empty()) return;
    places.size() <= kMostDots ? draw_dots(places, cloud.color, sheet) : draw_density(cloud, plot, sheet);
}

void draw_cells(const Cells& cells, const Plot& plot, PageCanvas& sheet) {
    const std::size_t columns = cells.x.size() - 1, rows = cells.y.size() - 1;
    const auto across = [&](double x) { return plot.along_x(x); };
    const auto up = [&](double y) { return plot.along_y(y); };
    // Between adjacent shapes the paper would show through.
    if (is_even(cells.x, across) && is_even(cells.y, up)) {
        Image image(static_cast<int>(columns), static_cast<int>(rows));
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t c = 0; c < columns; ++c)
                image.pixels[(rows - 1 - row) * columns + c] = pixel(sheet.shown(cells.colors[row * columns + c]));
        const Vec2 low = plot.at(cells.x.front(), cells.y.front()), high = plot.at(cells.x.back(), cells.y.back());
        sheet.pixels(image, {low.x, high.y, high.x - low.x, low.y - high.y});
        return;
    }
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t c = 0; c < columns; ++c) {
            const Vec2 low = plot.at(cells.x[c], cells.y[row]), high = plot.at(cells.x[c + 1], cells.y[row + 1]);
            if (!(cells.colors[row * columns + c].a > 0)) continue;
            sheet.rectangle(
                {low.x, high.y - kCellOverlap, high.x - low.x + kCellOverlap, low.y - high.y + kCellOverlap});
            sheet.fill(cells.colors[row * columns + c]);
        }
}

}  // namespace beamcam::render::figure
