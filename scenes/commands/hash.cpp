// `beamcam hash`: digests of decoded pixels.
#include "output/files/digest.hpp"
#include "output/image/png_reader.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct HashArguments {
    std::vector<std::string> files;
};

int act(const HashArguments& args) {
    return for_each_file(args.files, [](const std::string& file) {
        print_text(output::digest(output::read_png(file)) + "  " + file + "\n");
    });
}

}  // namespace

void add_hash(Grammar& grammar) {
    const auto [app, args] =
        grammar.command<HashArguments>("hash", "Print the SHA-256 digests of the decoded pixels of PNG files", act);
    app.examples = {"hash fall.png"};
    app.positional("PNG", &args.files, "PNG files").required();
    app.footer = "The digest is taken over the R, G, B, A bytes of 8 bits, row by row. FFmpeg prints the same with\n"
                 "  ffmpeg -i FILE -pix_fmt rgba -f hash -hash sha256 -";
}

}  // namespace beamcam::scenes
