// `beamcam diff`: the difference of two pictures, sequences of pictures, or tables.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "output/data/file_list.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/digest.hpp"
#include "output/image/picture_files.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct DiffArguments {
    Common common;
    std::string a, b;
    std::optional<std::string> picture;
    std::optional<double> tolerance, ssim;
};

// ---- difference pictures ------------------------------------------------------------------------

// Writes one file, for the pair of pictures that differs most, or a sequence, for every pair that differs.
class DifferencePictures {
  public:
    DifferencePictures(const DiffArguments& args) : args_(args), file_list_(args.common.force) {
        if (!args.picture) return;
        if (ending_of(*args.picture) != ".png")
            throw UsageError(fmt::format("-o {}: the difference picture is a .png file", *args.picture));
        numbered_ = is_numbered(fs::path(*args.picture).filename().string());
        if (!numbered_) file_list_.require_replaceable(*args.picture);
    }

    void add(long number, const output::Raster& a, const output::Raster& b, const PictureComparison& found) {
        if (!args_.picture || !found.same_size() || found.verdict == Verdict::identical) return;
        if (numbered_) return write(numbered_file(*args_.picture, number), a, b);
        if (worst_ && found.weight() <= worst_->weight) return;
        worst_ = Worst{found.weight(), a, b};
    }
    void finish() {
        if (worst_) write(*args_.picture, worst_->a, worst_->b);
    }

  private:
    struct Worst {
        double weight;
        output::Raster a, b;
    };

    void write(const std::string& file, const output::Raster& a, const output::Raster& b) {
        // If all differences are within the tolerance, the picture shows these.
        const int threshold = static_cast<int>(args_.tolerance.value_or(0));
        const bool beyond = output::difference(a, b, threshold).changed > 0;
        output::write_png(file_list_.target(file),
                          output::to_image(output::difference_picture(a, b, beyond ? threshold : 0)));
        inform(args_.common, fmt::format("wrote {}", file));
    }

    const DiffArguments& args_;
    output::FileList file_list_;
    bool numbered_ = false;
    std::optional<Worst> worst_;
};

// ---- comparing -----------------------------------------------------------------------------------

bool have_same_bytes(const fs::path& a, const fs::path& b) {
    return fs::is_regular_file(a) && fs::is_regular_file(b) && fs::file_size(a) == fs::file_size(b) &&
           output::sha256_of_file(a) == output::sha256_of_file(b);
}

Comparison compare_pictures(const DiffArguments& args) {
    if (args.tolerance && (*args.tolerance < 0 || *args.tolerance > 255))
        throw UsageError("--tolerance: of pictures it is a difference of a colour channel, 0 … 255");
    const int tolerance = static_cast<int>(args.tolerance.value_or(0));
    Comparison all{args.a, args.b, Verdict::identical, {}, 0, 0, {}};
    const std::vector<fs::path> a = output::picture_files(args.a), b = output::picture_files(args.b);
    all.pictures_a = a.size();
    all.pictures_b = b.size();
    if (a.size() != b.size()) all.verdict = Verdict::different;  // further pictures are only counted
    DifferencePictures pictures(args);
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        stop_if_interrupted();
        if (have_same_bytes(a[k], b[k]) && output::is_png(a[k])) continue;
        const output::Raster left = output::read_png(a[k]), right = output::read_png(b[k]);
        PictureComparison found = compare(left, right, tolerance);
        if (args.ssim && found.same_size() && found.difference.ssim >= *args.ssim)
            found.verdict = std::min(found.verdict, Verdict::equivalent);
        found.a = a[k].string();
        found.b = b[k].string();
        pictures.add(static_cast<long>(k), left, right, found);
        all.verdict = std::max(all.verdict, found.verdict);
        if (found.verdict != Verdict::identical) all.pictures.push_back(std::move(found));
    }
    pictures.finish();
    return all;
}

Comparison compare_tables(const DiffArguments& args) {
    if (args.picture) throw UsageError("-o is for pictures; tables are compared by their numbers");
    if (args.ssim) throw UsageError("--ssim is for pictures; tables are compared by their numbers");
    if (args.tolerance && *args.tolerance < 0) throw UsageError("--tolerance must not be negative");
    Comparison all{args.a, args.b, Verdict::identical, {}, 0, 0, {}};
    all.table = output::difference(output::read_table(args.a), output::read_table(args.b));
    all.verdict = all.table->identical()                           ? Verdict::identical
                  : all.table->within(args.tolerance.value_or(-1)) ? Verdict::equivalent
                                                                   : Verdict::different;
    return all;
}

int act(const DiffArguments& args) {
    if (is_table(args.a) != is_table(args.b))
        throw UsageError(fmt::format(
            "{} and {} are of different kinds; compare pictures with pictures, tables with tables", args.a, args.b));
    const Comparison found = is_table(args.a) ? compare_tables(args) : compare_pictures(args);
    print_result(args.common, to_json(found), to_text(found));
    return found.verdict == Verdict::different ? kDiffers : kDone;
}

}  // namespace

void add_diff(Program& program) {
    const auto [app, args] = add_command<DiffArguments>(
        program, "diff", "Compare two pictures, sequences of pictures, or tables; exit code 7 if they differ", act);
    add_examples(app, {"diff old.png new.png -o difference.png", "diff a.csv b.csv --tolerance 1e-6"});
    app.add_option("A", args.a, "PNG file, directory or sequence (name-####.png), .csv or .npz table")->required();
    app.add_option("B", args.b, "The same kind of file")->required();
    add_option(app, "-o,--output", args.picture, "FILE",
               "Difference picture, .png; with #### in its name, one for each pair of pictures that differs");
    add_option(app, "--tolerance", args.tolerance, "X",
               "Differences up to this count as equivalent: of pictures, a difference of a colour channel, 0 … 255; of "
               "tables, a share of a column's range (texts and classes have none)");
    within(add_option(app, "--ssim", args.ssim, "X",
                      "Pictures with at least this structural similarity (0 … 1) count as equivalent"),
           0.0, 1.0);
    add_json(app, args.common);
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
