// `beamcam hash`: digests of decoded pixels.
#include "output/files/digest.hpp"
#include "output/files/standard_output.hpp"
#include "output/image/png_reader.hpp"
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

void add_hash(Program& program) {
    const auto [app, args] = add_command<HashArguments>(
        program, "hash", "Print the SHA-256 digests of the decoded pixels of PNG files", act);
    add_examples(app, {"hash fall.png"});
    app.add_option("PNG", args.files, "PNG files")->required();
    add_note(app,
             "The digest is taken over the R, G, B, A bytes of 8 bits, row by row. FFmpeg prints the same with\n"
             "  ffmpeg -i FILE -pix_fmt rgba -f hash -hash sha256 -");
}

}  // namespace beamcam::scenes
