#include "output/film/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace beamcam::output {
namespace {

constexpr int kFineBits = 6, kFineSide = 1 << kFineBits;
constexpr std::size_t kColors = 256, kExact = 24;  // of these, exact most frequent colours
// More colours would enlarge the file: equal pixels compress better.
constexpr std::size_t kUsed = 232;

using PaletteColor = std::array<int, 3>;  // red, green, blue

// Over white: premultiplied colour plus 255 − alpha.
PaletteColor over_white(std::uint32_t p) {
    const int rest = 255 - static_cast<int>(p >> 24);
    return {static_cast<int>(p >> 16 & 255) + rest, static_cast<int>(p >> 8 & 255) + rest,
            static_cast<int>(p & 255) + rest};
}
std::uint32_t packed(const PaletteColor& c) {
    return 0xff000000U | static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 |
           static_cast<std::uint32_t>(c[2]);
}
PaletteColor unpacked(std::uint32_t color) { return over_white(color | 0xff000000U); }

// Weighted approximately by the sensitivity of the eye.
int distance(const PaletteColor& a, const PaletteColor& b) {
    const int dr = a[0] - b[0], dg = a[1] - b[1], db = a[2] - b[2];
    return 2 * dr * dr + 4 * dg * dg + 3 * db * db;
}
std::size_t nearest(const std::vector<std::uint32_t>& colors, const PaletteColor& c) {
    std::size_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colors.size(); ++i)
        if (const int d = distance(c, unpacked(colors[i])); d < least) least = d, best = i;
    return best;
}
std::size_t cell_of(const PaletteColor& c) {
    constexpr int kDrop = 8 - kFineBits;
    return static_cast<std::size_t>(((c[0] >> kDrop) << 2 * kFineBits) | ((c[1] >> kDrop) << kFineBits) |
                                    (c[2] >> kDrop));
}

struct WeighedColor {
    PaletteColor color;
    double weight;
};

// The weighted mean of colours.
struct MeanColor {
    double weight = 0, sums[3] = {};
    void add(const WeighedColor& each) {
        weight += each.weight;
        for (std::size_t k = 0; k < 3; ++k) sums[k] += each.weight * each.color[k];
    }
    std::uint32_t color() const {
        const auto mean = [&](double sum) { return static_cast<int>(std::lround(sum / weight)); };
        return packed({mean(sums[0]), mean(sums[1]), mean(sums[2])});
    }
};

// Some colours, of which median cut makes one or halves them.
struct CutBox {
    explicit CutBox(std::span<WeighedColor> all) : colors(all) {
        PaletteColor low{255, 255, 255}, high{0, 0, 0};
        for (const WeighedColor& each : all) {
            weight += each.weight;
            for (std::size_t k = 0; k < 3; ++k)
                low[k] = std::min(low[k], each.color[k]), high[k] = std::max(high[k], each.color[k]);
        }
        for (const std::size_t k : {0, 2})
            if (high[k] - low[k] > high[channel] - low[channel]) channel = k;
        size = weight * (high[channel] - low[channel]);
    }

    std::span<WeighedColor> colors;
    std::size_t channel = 1;      // of the longest side; green if equal: the eye is most sensitive to it
    double weight = 0, size = 0;  // weight × longest side
};

// Cut at the median of the longest side; neither part is empty.
std::pair<CutBox, CutBox> halves(const CutBox& box) {
    std::ranges::stable_sort(box.colors, {}, [&](const WeighedColor& each) { return each.color[box.channel]; });
    double part = 0;
    std::size_t middle = 0;
    while (middle + 1 < box.colors.size() && part < box.weight / 2) part += box.colors[middle++].weight;
    return {CutBox(box.colors.first(middle)), CutBox(box.colors.subspan(middle))};
}

// The largest box is halved until there are `count`; the mean colour of each.
std::vector<std::uint32_t> median_cut(std::vector<WeighedColor> all, std::size_t count) {
    std::vector<CutBox> boxes{CutBox(all)};
    while (boxes.size() < count) {
        const auto largest = std::ranges::max_element(boxes, {}, &CutBox::size);
        if (largest->size == 0) break;
        const auto [first, second] = halves(*largest);
        *largest = first;
        boxes.push_back(second);
    }
    std::vector<std::uint32_t> colors;
    for (const CutBox& box : boxes) {
        MeanColor mean;
        for (const WeighedColor& each : box.colors) mean.add(each);
        colors.push_back(mean.color());
    }
    return colors;
}

}  // namespace

void PaletteMaker::add(const render::Image& image) {
    std::unordered_map<std::uint32_t, std::uint64_t> counts;
    for (const std::uint32_t pixel : image.pixels) ++counts[packed(over_white(pixel))];
    for (const auto& [color, count] : counts) counts_[color] += count;
    pixels_ += image.pixels.size();
}

std::vector<std::uint32_t> PaletteMaker::colors() const {
    if (counts_.empty()) return {0xff000000U};
    std::vector<std::pair<std::uint32_t, std::uint64_t>> flat;
    std::vector<WeighedColor> all;
    for (const auto& [color, count] : counts_) {
        if (count > pixels_ / 5000) flat.emplace_back(color, count);
        // Rare colours weigh more than their area: the eye follows edges and thin curves.
        all.push_back({unpacked(color), std::sqrt(static_cast<double>(count))});
    }
    std::ranges::stable_sort(flat, std::greater(), [](const auto& each) { return each.second; });
    flat.resize(std::min(flat.size(), kExact));
    std::vector<std::uint32_t> out;
    for (const auto& [color, count] : flat) out.push_back(color);
    std::ranges::copy(median_cut(std::move(all), kUsed - flat.size()), std::back_inserter(out));
    refine(out, flat.size());
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// Lloyd's iteration: moves each colour but the first `fixed` to the mean of the pixels nearest to it.
void PaletteMaker::refine(std::vector<std::uint32_t>& colors, std::size_t fixed) const {
    constexpr int kSteps = 8;  // then the error hardly decreases
    for (int step = 0; step < kSteps; ++step) {
        std::vector<MeanColor> means(colors.size());
        for (const auto& [color, count] : counts_)
            means[nearest(colors, unpacked(color))].add({unpacked(color), static_cast<double>(count)});
        for (std::size_t i = fixed; i < colors.size(); ++i)
            if (means[i].weight > 0) colors[i] = means[i].color();
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
    const Cell& cell = cells_[cell_of(c)];
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
