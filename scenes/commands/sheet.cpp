// `beamcam sheet`: pictures of a film in one picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/files/atomic_file.hpp"
#include "output/film/picture_source.hpp"
#include "output/image/png.hpp"
#include "render/draw/canvas.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kTallest = 32767;  // [px] of Cairo's pictures

struct SheetArguments {
    Common common;
    std::string film, file;
    int count = 12, columns = 4, width = 1920;
};

// The places of the pictures on the sheet.
struct Grid {
    int columns, rows;
    int width, height;  // of a picture [px]
    int gap, label;     // between pictures; height of the label below each [px]

    Grid(const SheetArguments& args, int shown, const output::Raster& picture)
        : columns(std::min(args.columns, shown)), rows((shown + columns - 1) / columns), gap(args.width / 160) {
        width = (args.width - gap * (columns + 1)) / columns;
        height = std::max(1, static_cast<int>(std::lround(double(width) * picture.height / picture.width)));
        label = std::max(12, std::min(width / 16, std::max(24, args.width / 60)));
    }
    int total_height() const { return gap + rows * (height + label + gap); }
    render::Box at(int k) const {
        const int column = k % columns, row = k / columns;
        return {double(gap + column * (width + gap)), double(gap + row * (height + label + gap)), double(width),
                double(height)};
    }
};

long count_of(const std::string& film) {
    output::PictureSource source(film);
    long count = 0;
    for (; source.skip(); ++count) stop_if_interrupted();
    return count;
}

// Whether this frame is picture k of the sheet. The pictures are spaced evenly from the first frame to the last.
bool is_shown(long frame, long frames, int shown, int k) {
    return frame == (shown == 1 ? 0 : std::lround(double(k) * double(frames - 1) / (shown - 1)));
}

render::Image sheet_of(const SheetArguments& args) {
    const long frames = count_of(args.film);
    const int shown = static_cast<int>(std::min<long>(args.count, frames));
    output::PictureSource source(args.film);
    output::Raster picture;
    std::string name;
    const render::Fonts fonts;
    render::Image sheet;
    int k = 0;
    std::optional<Grid> grid;
    for (long frame = 0; k < shown; ++frame) {
        stop_if_interrupted();
        if (!is_shown(frame, frames, shown, k)) {
            source.skip();
            continue;
        }
        if (!source.next(picture, name)) break;
        if (!grid) {
            grid.emplace(args, shown, picture);
            if (grid->total_height() > kTallest)
                throw UsageError(
                    fmt::format("the sheet would be {} × {} pixels, higher than {}; use more --columns, or a smaller "
                                "--width or --count",
                                args.width, grid->total_height(), kTallest));
            sheet = render::Image(args.width, grid->total_height());
            render::Canvas(sheet, fonts).paint(render::rgb(0xFFFFFF));
        }
        render::Canvas canvas(sheet, fonts);
        const render::Box box = grid->at(k++);
        canvas.image_fitted(output::to_image(picture), box);
        canvas.text({box.x, box.bottom() + 0.75 * grid->label}, fmt::format("{} of {}", frame + 1, frames),
                    {.size = 0.62 * grid->label, .color = render::rgb(0x555555)});
    }
    return sheet;
}

void act(const SheetArguments& args) {
    output::FileList file_list(args.common.force);
    require_writable("-o", {args.file}, {".png"}, file_list);
    const std::string bytes = output::encode_png(sheet_of(args));
    if (is_stdout(args.file)) return print_data(bytes);
    output::write_file(file_list.target(args.file), bytes);
    inform(args.common, fmt::format("wrote {}", args.file));
}

}  // namespace

void add_sheet(Grammar& grammar) {
    const auto [app, args] = grammar.command<SheetArguments>(
        "sheet", "Make a contact sheet: evenly spaced pictures of a film in one picture", act);
    app.examples = {"sheet fall.mp4 -o sheet.png --count 20 --columns 5"};
    app.positional("FILM", &args.film, "Film, directory or sequence (name-####.png)").required();
    app.option("-o,--output", &args.file, "FILE", "Picture to make, .png").required();
    app.option("--count", &args.count, "N", "Number of pictures (default: 12)").range(1, 1000);
    app.option("--columns", &args.columns, "N", "Number of columns (default: 4)").range(1, 100);
    app.option("--width", &args.width, "W", "Width of the sheet in pixels (default: 1920)").range(160, 16384);
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
