// CPU milliseconds of a figure of a million points, for each medium and kind of curve; sizes of the files.
// With a folder as second argument the PDF and SVG files are kept there. Prints CSV: points,curve,medium,ms,bytes
// (median of five).
#include "render/plot/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <utility>

#include "render/draw/fonts.hpp"

using namespace beamcam::render;

namespace {

constexpr const char* kCurves[] = {"oscillation", "noise", "orbit", "gaps", "coloured"};

figure::Figure million(const std::string& curve, std::size_t points) {
    figure::Series s;
    s.x.resize(points), s.y.resize(points);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    for (std::size_t i = 0; i < points; ++i) {
        const double t = 600.0 * static_cast<double>(i) / static_cast<double>(points);
        s.x[i] = curve == "orbit" ? std::cos(7 * t) * std::exp(-t / 600) : t;
        s.y[i] = curve == "noise"   ? any(random)
                 : curve == "orbit" ? std::sin(7 * t) * std::exp(-t / 600)
                 : curve == "gaps"  ? (i % 100 < 3 ? std::nan("") : std::abs(std::sin(40 * t)))
                                    : 0.37 + 0.05 * std::sin(130 * t) * std::exp(-t / 200);
    }
    figure::Panel panel;
    panel.x.label = "<i>t</i> (s)", panel.y.label = "<i>θ</i> (rad)";
    if (curve == "coloured") {
        s.value = s.y;
        panel.color_bar.emplace().label = "<i>θ</i> (rad)";
    }
    panel.series.push_back(std::move(s));
    figure::Figure f;
    f.name = "million", f.title = "A million points";
    f.panels.push_back(std::move(panel));
    return f;
}

double cpu_now() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

// Bytes of the file, or of the pixels. A file is kept when `keep` names one.
std::size_t draw(const figure::Figure& f, Medium medium, const Fonts& fonts, const std::string& keep) {
    const figure::Page page = figure::page_of(f, *figure::column_named("elsevier"));
    figure::PageCanvas sheet(medium, {figure::points(page.width), figure::points(page.height), 600}, fonts);
    figure::draw(f, page, sheet);
    if (medium == Medium::png) return 4 * sheet.image().pixels.size();
    const std::string bytes = sheet.bytes();
    if (!keep.empty()) std::ofstream(keep, std::ios::binary) << bytes;
    return bytes.size();
}

}  // namespace

int main(int count, char** words) {
    const std::size_t points = count > 1 ? std::strtoull(words[1], nullptr, 10) : 1'000'000;
    const std::string folder = count > 2 ? words[2] : "";
    const Fonts fonts(false, Typefaces::print);
    fmt::print("points,curve,medium,ms,bytes\n");
    for (const char* curve : kCurves) {
        const figure::Figure f = million(curve, points);
        for (const auto& [medium, name] :
             {std::pair{Medium::pdf, "pdf"}, std::pair{Medium::svg, "svg"}, std::pair{Medium::png, "png"}}) {
            std::array<double, 5> ms;
            std::size_t bytes = 0;
            for (double& one : ms) {
                const double start = cpu_now();
                bytes = draw(f, medium, fonts, folder.empty() ? "" : fmt::format("{}/{}.{}", folder, curve, name));
                one = cpu_now() - start;
            }
            std::ranges::nth_element(ms, ms.begin() + 2);
            fmt::print("{},{},{},{:.1f},{}\n", points, curve, name, ms[2], bytes);
        }
    }
}
