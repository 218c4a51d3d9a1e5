#include "scenes/regression/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "output/files/text_safety.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

// The first names: a table may have a hundred thousand.
std::string names_of(const std::vector<std::string>& all) {
    constexpr std::size_t kMost = 100;
    const std::size_t shown = std::min(all.size(), kMost);
    std::string text = output::one_line(fmt::format("{}", fmt::join(all.begin(), all.begin() + long(shown), ", ")));
    return shown < all.size() ? fmt::format("{} and {} more", text, all.size() - shown) : text;
}

}  // namespace

double PictureComparison::weight() const {
    return same_size() ? static_cast<double>(difference.changed) + difference.largest / 256.0 : 1e300;
}

PictureComparison compare(const output::Raster& a, const output::Raster& b, int tolerance) {
    PictureComparison c;
    c.size_a = fmt::format("{}x{}", a.width, a.height);
    c.size_b = fmt::format("{}x{}", b.width, b.height);
    if (c.same_size()) c.difference = output::difference(a, b, tolerance);
    return c;
}

std::string to_text(const PictureComparison& c) {
    if (!c.same_size()) return fmt::format("size {} became {}", c.size_a, c.size_b);
    const output::PictureDifference& d = c.difference;
    if (d.identical()) return "no pixel changed";
    std::string text = fmt::format("{} of {} pixels ({:.3g} %), largest channel difference {} of 255", d.changed,
                                   d.pixels, 100 * d.share(), d.largest);
    if (d.changed > 0)
        text += fmt::format(", within {}x{}+{}+{}", d.box.width(), d.box.height(), d.box.left, d.box.top);
    return text + fmt::format(", SSIM {:.6f}", d.ssim);
}

std::string to_text(const output::OtherInstant& other) {
    return fmt::format("the times (column t) differ first in row {}: {:.9g} became {:.9g}", other.row + 1, other.a,
                       other.b);
}

std::string to_text(const output::TableDifference& d) {
    std::string text;
    if (d.rows_a != d.rows_b || d.rows_compared != d.rows_a)
        text += fmt::format("rows: {} and {}, {} at common instants\n", d.rows_a, d.rows_b, d.rows_compared);
    if (d.other_instant) text += to_text(*d.other_instant) + "\n";
    if (!d.only_in_a.empty()) text += fmt::format("columns only in the first: {}\n", names_of(d.only_in_a));
    if (!d.only_in_b.empty()) text += fmt::format("columns only in the second: {}\n", names_of(d.only_in_b));
    std::size_t same = 0;
    for (const output::ColumnDifference& c : d.columns) {
        if (c.identical) {
            ++same;
            continue;
        }
        if (c.texts > 0)
            text += fmt::format("{}: {} {}\n", output::one_line(c.name), counted(c.texts, "text"),
                                c.texts == 1 ? "differs" : "differ");
        if (c.largest == 0 && c.undefined == 0 && c.texts > 0) continue;
        const std::string at = std::isnan(c.t) ? "" : fmt::format(" at t = {:.6g}", c.t);
        text += fmt::format("{}: largest difference {:.3g}{}, {:.3g} of its range {:.3g}{}\n", output::one_line(c.name),
                            c.largest, at, c.share, c.range,
                            c.undefined > 0 ? fmt::format(", {} cells empty in one table only", c.undefined) : "");
    }
    if (same > 0)
        text += fmt::format("{} of {} columns identical in {} rows\n", same, d.columns.size(), d.rows_compared);
    return text;
}

}  // namespace beamcam::scenes
