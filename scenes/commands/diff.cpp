// `beamcam diff`: the difference of two pictures or tables.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "output/data/file_list.hpp"
#include "output/data/table_reader.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct DiffArguments {
    Common common;
    std::string a, b;
    std::optional<std::string> picture;
    std::optional<double> tolerance, ssim;
};

int conclude(const DiffArguments& args, Verdict verdict, const char* kind, Node details, const std::string& text) {
    const Node all =
        object_node({{"a", args.a}, {"b", args.b}, {"verdict", name(verdict)}, {kind, std::move(details)}});
    print_result(args.common, to_text(all), fmt::format("{}: {} and {}\n{}", name(verdict), args.a, args.b, text));
    return verdict == Verdict::different ? kDiffers : kDone;
}

int compare_pictures(const DiffArguments& args) {
    if (args.tolerance && (*args.tolerance < 0 || *args.tolerance > 255))
        throw UsageError("--tolerance: of pictures it is a difference of a colour channel, 0 … 255");
    const int tolerance = static_cast<int>(args.tolerance.value_or(0));
    output::FileList file_list(args.common.force);
    if (args.picture) {
        require_ending("-o", *args.picture, {".png"});
        std::error_code absent;
        for (const std::string& input : {args.a, args.b})
            if (std::filesystem::equivalent(input, *args.picture, absent))
                throw UsageError(fmt::format("-o {} is one of the pictures; name another file", *args.picture));
        file_list.require_replaceable(*args.picture);
    }
    const output::Raster a = output::read_png(args.a), b = output::read_png(args.b);
    const PictureComparison found = compare(a, b, tolerance);
    const bool similar = found.difference.changed == 0 || (args.ssim && found.difference.ssim >= *args.ssim);
    if (args.picture && found.same_size() && !found.identical()) {
        // If all differences are within the tolerance, the picture shows these.
        const int threshold = found.difference.changed > 0 ? tolerance : 0;
        output::write_png(file_list.target(*args.picture),
                          output::to_image(output::difference_picture(a, b, threshold)));
        inform(args.common, fmt::format("wrote {}", *args.picture));
    }
    return conclude(args,
                    found.identical()              ? Verdict::identical
                    : found.same_size() && similar ? Verdict::equivalent
                                                   : Verdict::different,
                    "picture", to_node(found), to_text(found) + "\n");
}

int compare_tables(const DiffArguments& args) {
    if (args.picture) throw UsageError("-o is for pictures; tables are compared by their numbers");
    if (args.ssim) throw UsageError("--ssim is for pictures; tables are compared by their numbers");
    if (args.tolerance && *args.tolerance < 0) throw UsageError("--tolerance must not be negative");
    const output::TableDifference found = output::difference(output::read_table(args.a), output::read_table(args.b));
    return conclude(args,
                    found.identical()                           ? Verdict::identical
                    : found.within(args.tolerance.value_or(-1)) ? Verdict::equivalent
                                                                : Verdict::different,
                    "table", to_node(found), to_text(found));
}

int act(const DiffArguments& args) {
    if (is_table(args.a) != is_table(args.b))
        throw UsageError(fmt::format(
            "{} and {} are of different kinds; compare pictures with pictures, tables with tables", args.a, args.b));
    return is_table(args.a) ? compare_tables(args) : compare_pictures(args);
}

}  // namespace

void add_diff(Program& program) {
    const auto [app, args] =
        add_command<DiffArguments>(program, "diff", "Compare two pictures or tables; exit code 7 if they differ", act);
    add_examples(app, {"diff old.png new.png -o difference.png", "diff a.csv b.csv --tolerance 1e-6"});
    app.add_option("A", args.a, "A .png file, or a .csv or .npz table")->required();
    app.add_option("B", args.b, "The same kind of file")->required();
    add_option(app, "-o,--output", args.picture, "FILE", "Difference picture, .png");
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
