#include "output/film/palette.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <unordered_map>

namespace beamcam::output {
namespace {

constexpr int kBits = 5, kSide = 1 << kBits, kFineBits = 6, kFineSide = 1 << kFineBits;
constexpr std::size_t kColors = 256, kExact = 24;  // of these, exact most frequent colours
// More colours would enlarge the file: equal pixels compress better.
constexpr std::size_t kUsed = 232;

struct PaletteColor {
    int r, g, b;
};
// Over white: premultiplied colour plus 255 − alpha.
PaletteColor over_white(std::uint32_t p) {
    const int rest = 255 - static_cast<int>(p >> 24);
    return {static_cast<int>(p >> 16 & 255) + rest, static_cast<int>(p >> 8 & 255) + rest,
            static_cast<int>(p & 255) + rest};
}
std::uint32_t packed(PaletteColor c) {
    return 0xff000000U | static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 |
           static_cast<std::uint32_t>(c.b);
}
PaletteColor unpacked(std::uint32_t color) {
    return {static_cast<int>(color >> 16 & 255), static_cast<int>(color >> 8 & 255), static_cast<int>(color & 255)};
}
// Weighted approximately by the sensitivity of the eye.
int distance(PaletteColor a, PaletteColor b) {
    const int dr = a.r - b.r, dg = a.g - b.g, db = a.b - b.b;
    return 2 * dr * dr + 4 * dg * dg + 3 * db * db;
}
std::size_t nearest(const std::vector<std::uint32_t>& colors, PaletteColor c) {
    std::size_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colors.size(); ++i)
        if (const int d = distance(c, unpacked(colors[i])); d < least) least = d, best = i;
    return best;
}
std::size_t cell_of(PaletteColor c, int bits) {
    const int drop = 8 - bits;
    return static_cast<std::size_t>(((c.r >> drop) << 2 * bits) | ((c.g >> drop) << bits) | (c.b >> drop));
}

// A cell of the colour cube: its place, the weight of its pixels, and their weighted sums.
struct CutItem {
    int at[3];
    double count, r, g, b;
};
using CutBox = std::span<CutItem>;

// The channel of the longest side, and its length.
std::pair<int, int> longest_side(CutBox box) {
    int low[3] = {255, 255, 255}, high[3] = {0, 0, 0};
    for (const CutItem& item : box)
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], item.at[k]), high[k] = std::max(high[k], item.at[k]);
    int channel = 1;  // green if equal: the eye is most sensitive to it
    for (int k : {0, 2})
        if (high[k] - low[k] > high[channel] - low[channel]) channel = k;
    return {channel, high[channel] - low[channel]};
}

double weight_of(CutBox box) {
    double sum = 0;
    for (const CutItem& item : box) sum += item.count;
    return sum;
}

// Cut at the median of the longest side; neither part is empty.
std::pair<CutBox, CutBox> halves(CutBox box) {
    const int channel = longest_side(box).first;
    std::ranges::stable_sort(box, {}, [&](const CutItem& item) { return item.at[channel]; });
    const double all = weight_of(box);
    double part = 0;
    std::size_t middle = 1;
    for (std::size_t k = 0; k + 1 < box.size(); ++k) {
        part += box[k].count;
        middle = k + 1;
        if (part >= all / 2) break;
    }
    return {box.first(middle), box.subspan(middle)};
}

// Median cut: the box with the most (weight × extent) is halved until there are `count`; the mean colour of each.
std::vector<std::uint32_t> median_cut(std::vector<CutItem> items, std::size_t count) {
    std::vector<CutBox> boxes{items};
    while (boxes.size() < count) {
        CutBox* best = nullptr;
        double most = 0;
        for (CutBox& box : boxes) {
            const double size = weight_of(box) * longest_side(box).second;
            if (size > most) most = size, best = &box;
        }
        if (!best) break;
        const auto [first, second] = halves(*best);
        *best = first;
        boxes.push_back(second);
    }
    std::vector<std::uint32_t> colors;
    for (const CutBox& box : boxes) {
        double weight = 0, r = 0, g = 0, b = 0;
        for (const CutItem& item : box) weight += item.count, r += item.r, g += item.g, b += item.b;
        const auto mean = [&](double sum) { return static_cast<int>(std::lround(sum / weight)); };
        colors.push_back(packed({mean(r), mean(g), mean(b)}));
    }
    return colors;
}

}  // namespace

PaletteMaker::PaletteMaker() : cells_(static_cast<std::size_t>(kSide) * kSide * kSide) {}

void PaletteMaker::add(const render::Image& image) {
    std::unordered_map<std::uint32_t, std::uint64_t> counts;
    for (std::uint32_t p : image.pixels) {
        const PaletteColor c = over_white(p);
        ++counts[packed(c)];
    }
    for (const auto& [color, count] : counts) {
        all_[color] += count;
        const PaletteColor c = unpacked(color);
        Cell& cell = cells_[cell_of(c, kBits)];
        // Rare colours weigh more than their area: the eye follows edges and thin curves.
        const double weight = std::max(1.0, 8.0 * static_cast<double>(count) / (8.0 + static_cast<double>(count) / 64));
        cell.count += weight;
        cell.r += weight * c.r, cell.g += weight * c.g, cell.b += weight * c.b;
    }
    for (const auto& [color, count] : counts)
        if (count > image.pixels.size() / 5000) frequent_[color] += count;
}

std::vector<std::uint32_t> PaletteMaker::frequent() const {
    std::vector<std::pair<std::uint32_t, std::uint64_t>> order(frequent_.begin(), frequent_.end());
    std::ranges::stable_sort(order, std::greater(), [](const auto& each) { return each.second; });
    std::vector<std::uint32_t> out;
    for (const auto& [color, count] : order)
        if (out.size() < kExact) out.push_back(color);
    return out;
}

std::vector<std::uint32_t> PaletteMaker::colors() const {
    std::vector<CutItem> items;
    for (int r = 0; r < kSide; ++r)
        for (int g = 0; g < kSide; ++g)
            for (int b = 0; b < kSide; ++b) {
                const Cell& cell = cells_[static_cast<std::size_t>((r << 2 * kBits) | (g << kBits) | b)];
                if (cell.count > 0) items.push_back({{r, g, b}, cell.count, cell.r, cell.g, cell.b});
            }
    std::vector<std::uint32_t> out = frequent();
    if (items.empty()) return {0xff000000U};
    const std::size_t fixed = out.size();
    std::ranges::copy(median_cut(std::move(items), kUsed - fixed), std::back_inserter(out));
    refine(out, fixed);
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// Lloyd's iteration: moves each colour but the first `fixed` to the mean of the pixels nearest to it.
void PaletteMaker::refine(std::vector<std::uint32_t>& colors, std::size_t fixed) const {
    constexpr int kSteps = 8;  // then the error hardly decreases
    const std::map<std::uint32_t, std::uint64_t> ordered(all_.begin(), all_.end());
    for (int step = 0; step < kSteps; ++step) {
        std::vector<Cell> sums(colors.size());
        for (const auto& [color, count] : ordered) {
            const PaletteColor c = unpacked(color);
            Cell& sum = sums[nearest(colors, c)];
            const auto weight = static_cast<double>(count);
            sum.count += weight, sum.r += weight * c.r, sum.g += weight * c.g, sum.b += weight * c.b;
        }
        for (std::size_t i = fixed; i < colors.size(); ++i) {
            const Cell& s = sums[i];
            const auto mean = [&](double v) { return static_cast<int>(std::lround(v / s.count)); };
            if (s.count > 0) colors[i] = packed({mean(s.r), mean(s.g), mean(s.b)});
        }
    }
}

// A colour can be the nearest somewhere in a cell if its distance from the centre of the cell is at most the smallest
// such distance plus twice the distance from the centre to a corner.
PaletteTable::PaletteTable(std::span<const std::uint32_t> colors) : colors_(colors.begin(), colors.end()) {
    if (colors_.empty() || colors_.size() > kColors) throw std::logic_error("PaletteTable: 1 to 256 colours");
    constexpr int kHalf = 1 << (7 - kFineBits);
    const double corner = std::sqrt(distance({kHalf, kHalf, kHalf}, {0, 0, 0}));
    cells_.reserve(static_cast<std::size_t>(kFineSide) * kFineSide * kFineSide);
    std::vector<int> far(colors_.size());
    for (int r = 0; r < kFineSide; ++r)
        for (int g = 0; g < kFineSide; ++g)
            for (int b = 0; b < kFineSide; ++b) {
                const PaletteColor centre{2 * kHalf * r + kHalf, 2 * kHalf * g + kHalf, 2 * kHalf * b + kHalf};
                for (std::size_t i = 0; i < far.size(); ++i) far[i] = distance(centre, unpacked(colors_[i]));
                const double reach = std::sqrt(*std::ranges::min_element(far)) + 2 * corner;
                const auto first = static_cast<std::uint32_t>(candidates_.size());
                for (std::size_t i = 0; i < far.size(); ++i)
                    if (far[i] <= reach * reach) candidates_.push_back(static_cast<std::uint8_t>(i));
                cells_.push_back({first, static_cast<std::uint16_t>(candidates_.size() - first)});
            }
}

std::uint8_t PaletteTable::index_of(std::uint32_t pixel) const {
    const PaletteColor c = over_white(pixel);
    const Cell& cell = cells_[cell_of(c, kFineBits)];
    std::uint8_t best = candidates_[cell.first];
    if (cell.count == 1) return best;
    int least = std::numeric_limits<int>::max();
    for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i)
        if (const int d = distance(c, unpacked(colors_[candidates_[i]])); d < least) least = d, best = candidates_[i];
    return best;
}

void PaletteTable::convert(const render::Image& image, std::uint8_t* to, std::ptrdiff_t stride,
                           const render::DirtyTiles& part) const {
    part.for_each_run([&](int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; ++y) {
            const std::uint32_t* row = image.pixels.data() + std::ptrdiff_t(y) * image.width;
            std::uint8_t* out = to + y * stride;
            for (int x = left; x < right; ++x)
                out[x] = x > left && row[x] == row[x - 1] ? out[x - 1] : index_of(row[x]);
        }
    });
}

}  // namespace beamcam::output
