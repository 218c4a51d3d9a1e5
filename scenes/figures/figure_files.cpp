#include "scenes/figures/figure_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "output/files/numbers.hpp"
#include "output/image/png.hpp"
#include "render/base/error.hpp"
#include "render/draw/markup.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/swept_points.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;

// https://reproducible-builds.org/specs/source-date-epoch
std::int64_t creation_instant() {
    const char* text = std::getenv("SOURCE_DATE_EPOCH");
    const auto instant = output::number_in<std::int64_t>(text ? text : "");
    constexpr std::int64_t kLatest = 253402300799;  // the end of the year 9999
    return instant && *instant >= 0 && *instant <= kLatest ? *instant : 0;
}

figure::Page page_of(const figure::Figure& f, const FigureOutput& how) {
    const figure::Column* column = figure::column_named(how.column);
    if (!column) throw render::PictureError(fmt::format("figure {}: there is no column \"{}\"", f.name, how.column));
    return figure::page_of(f, *column, how.width ? std::optional(*how.width * 1e3) : std::nullopt);
}

// Draws the figure and returns what `take` reads from the canvas.
template <class Take>
auto drawn(const figure::Figure& f, const FigureOutput& how, render::Medium medium, const render::Document& document,
           Take take) {
    const figure::Page page = page_of(f, how);
    const render::Fonts fonts(figure::needs_chinese(f),
                              how.serif ? render::Typefaces::serif : render::Typefaces::print);
    figure::PageCanvas sheet(medium, {figure::points(page.width), figure::points(page.height), how.dpi, how.dark},
                             fonts, document);
    figure::draw(f, page, sheet);
    return take(sheet);
}

std::string bytes_of(const figure::Figure& f, const FigureOutput& how, const std::string& scene) {
    const render::Document document = document_of(render::to_plain(f.title), render::to_plain(whole_caption(f)), scene);
    const std::string ending = ending_of(how.file);
    if (ending != ".png")
        return drawn(f, how, medium_of(how.file), document, [](figure::PageCanvas& sheet) { return sheet.bytes(); });
    return output::encode_png(figure_image(f, how), {how.dpi,
                                                     {{"Title", document.title},
                                                      {"Description", document.subject},
                                                      {"Software", document.creator},
                                                      {"beamcam-scene", scene},
                                                      {"beamcam-accuracy", render::to_plain(f.accuracy)}}});
}

}  // namespace

render::Medium medium_of(const std::string& file) {
    return ending_of(file) == ".pdf" ? render::Medium::pdf : render::Medium::svg;
}

render::Document document_of(std::string title, std::string subject, std::string scene) {
    return {std::move(title), std::move(subject), std::move(scene), fmt::format("beamcam {}", kVersion),
            creation_instant()};
}

render::Image figure_image(const figure::Figure& f, const FigureOutput& how) {
    return drawn(f, how, render::Medium::png, {}, [](figure::PageCanvas& sheet) { return sheet.image(); });
}

std::vector<std::string> missing_data(const figure::Figure& f) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<std::string> missing;
    const auto check = [&](const render::Axis& axis, const std::vector<figure::Series>& curves, auto values_of) {
        render::Extent data;
        for (const figure::Series& curve : curves) data.add(values_of(curve), axis.scale);
        const auto [low, high] = std::minmax({axis.from.value_or(-kInfinity), axis.to.value_or(kInfinity)});
        if (data.any && (data.high < low || data.low > high))
            missing.push_back(fmt::format("no curve: {} is between {:.4g} and {:.4g}, beyond the ends of its axis",
                                          render::to_plain(axis.label), data.low, data.high));
    };
    for (const figure::Panel& panel : f.panels) {
        check(panel.y, panel.series, [](const figure::Series& curve) { return curve.y; });
        if (&panel == &f.panels.front())
            check(panel.x, panel.series, [](const figure::Series& curve) { return curve.x; });
        if (!panel.clouds.empty() && all_empty(panel.clouds)) missing.emplace_back("no points");
    }
    return missing;
}

std::string scene_of_figure(Scene scene, FigureOutput how) {
    how.file = how.figure + ending_of(how.file);
    how.data_file.clear(), how.caption_file.clear();
    scene.outputs = {how};
    return to_json(scene);
}

std::vector<std::pair<std::string, std::string>> figure_files(const figure::Figure& f, const FigureOutput& how,
                                                              const std::string& scene) {
    std::vector<std::pair<std::string, std::string>> files{{how.file, bytes_of(f, how, scene)}};
    if (!how.data_file.empty()) files.emplace_back(how.data_file, figure::data_csv(f));
    if (!how.caption_file.empty()) files.emplace_back(how.caption_file, render::to_plain(whole_caption(f)) + "\n");
    return files;
}

}  // namespace beamcam::scenes
