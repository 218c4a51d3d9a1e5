// `beamcam hash`: digests of decoded pixels.
#include <algorithm>
#include <atomic>

#include "output/files/descriptor.hpp"
#include "output/files/digest.hpp"
#include "output/film/picture_source.hpp"
#include "output/image/png_reader.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {
namespace {

struct HashArguments {
    Common common;
    std::vector<std::string> files;
    bool whole = false;
};

void print_line(const std::string& digest, const std::string& name) { print_text(digest + "  " + name + "\n"); }

// Separate files are decoded in parallel; their digests are printed in order. Returns the exit code.
int hash_files(const std::vector<std::filesystem::path>& files, int threads) {
    Gate gate;
    std::atomic<int> code = kDone;
    auto make_worker = [&]() -> Worker {
        return [&](long k) {
            const std::string file = files[static_cast<std::size_t>(k)].string();
            std::string digest;
            const int read =
                for_each_file({file}, [&](const auto&) { digest = output::digest(output::read_png(file)); });
            if (read != kDone) code = read;
            gate.pass(k, [&] {
                if (read == kDone) print_line(digest, file);
            });
        };
    };
    fan_out(static_cast<long>(files.size()), {threads, threads}, make_worker, gate);
    return code;
}

void hash_in_order(output::PictureSource& source, const std::string& file, bool whole) {
    output::Raster picture;
    std::string name;
    output::Sha256 all;
    while (source.next(picture, name)) {
        stop_if_interrupted();
        if (whole)
            all.update(output::bytes_of(picture.rgba));
        else
            print_line(output::digest(picture), name);
    }
    if (whole) print_line(all.hex(), file);
}

int act(const HashArguments& args) {
    const int threads = thread_count(args.common.threads);
    std::vector<std::filesystem::path> stills;  // not hashed yet
    int of_stills = kDone;
    auto hash_stills = [&] {
        of_stills = std::max(of_stills, hash_files(stills, threads));
        stills.clear();
    };
    const int code = for_each_file(args.files, [&](const std::string& file) {
        output::PictureSource source(file);
        if (!source.is_film() && !args.whole) {
            stills.insert(stills.end(), source.files().begin(), source.files().end());
            return;
        }
        hash_stills();
        hash_in_order(source, file, args.whole);
    });
    hash_stills();
    return std::max(code, of_stills);
}

}  // namespace

void add_hash(Grammar& grammar) {
    const auto [app, args] = grammar.command<HashArguments>(
        "hash", "Print the SHA-256 digests of the decoded pixels of pictures and films", act);
    app.examples = {"hash fall.png", "hash fall.mp4 --whole"};
    app.positional("FILE", &args.files, "PNG files, directories or sequences (name-####.png), films").required();
    app.flag("--whole", args.whole,
             "Print one digest for each FILE, over all its pictures, instead of one for each picture");
    add_jobs(app, args.common, "Largest number of threads that decode PNG files");
    app.footer =
        "The digest is taken over R, G, B, A bytes of 8 bits, row by row. FFmpeg prints the same digest of a picture "
        "with\n"
        "  ffmpeg -i FILE -sws_flags bicubic+accurate_rnd+full_chroma_int+bitexact -pix_fmt rgba \\\n"
        "         -f framehash -hash sha256 -\n"
        "and for --whole with -f hash -hash sha256; a transparent .webm needs -c:v libvpx-vp9 before -i.";
}

}  // namespace beamcam::scenes
