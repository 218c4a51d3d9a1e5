#include "output/film/video_encoder.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#include "output/film/encoder_recipe.hpp"
#include "render/base/limits.hpp"

namespace beamcam::output {

namespace {

// Upper limit for all encoders but SVT-AV1: their own, and some for look-ahead and filters.
constexpr int kThreadsOfEncoder = 16;

// SVT-AV1 waits forever if some of its threads cannot start. It started 90 threads on two cores; more cores, more
// threads.
int threads_of_svt_av1() { return std::min(64 + 32 * static_cast<int>(std::thread::hardware_concurrency()), 256); }

// Whether SVT-AV1 gets the memory that it needs. On two cores the process used an address space of 1.4 GB for 320x180
// pixels, 2.2 for 1280x720, 2.7 for 1920x1080, 5.0 for 3840x2160, with 8 MB for the stack of each thread. The process
// keeps this memory for the next encoder.
bool has_memory_for_svt_av1(int width, int height) {
    static std::atomic<std::size_t> taken = 0;
    constexpr std::size_t kThread = 10 << 20, kPixel = 350;  // [bytes]
    const std::size_t need = kThread * static_cast<std::size_t>(threads_of_svt_av1()) +
                             kPixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (need <= taken) return true;
    if (!render::has_memory(need)) return false;
    taken = need;
    return true;
}

}  // namespace

void silence_encoder_logs() { setenv("SVT_LOG", "1", 0); }

std::vector<std::string> problems(const VideoOptions& o, std::string_view ending) {
    std::vector<std::string> found;
    for (std::string problem : {format_problem(ending, o.codec, o.transparent),
                                size_problem(o.codec, o.width, o.height), rate_problem(o.codec, o.fps.value())})
        if (!problem.empty()) found.push_back(std::move(problem));
    const auto quality = quality_scale(o.codec);
    if (o.crf && !quality)
        found.push_back(std::string(title(o.codec)) + " has no crf, because its quality is fixed; remove it");
    else if (o.crf && (*o.crf < 0 || *o.crf > quality->worst))
        found.push_back("crf " + std::to_string(*o.crf) + " is not possible; use 0 (best) to " +
                        std::to_string(quality->worst) + ", " + std::to_string(quality->usual) + " looks lossless");
    if (o.codec == Codec::gif && (o.palette.empty() || o.palette.size() > 256))
        found.push_back("a GIF needs a palette of 1 to 256 colours");
    return found;
}

IoError no_encoder_thread(const std::filesystem::path& film) {
    return IoError("cannot write " + film.string() + ": no thread can be started for the encoder; " +
                   render::kThreadRemedy);
}

OpenedEncoder open_encoder(const VideoOptions& options, const AtomicFile& file) {
    EncoderRecipe recipe = encoder_recipe(options, file.target().extension().string());
    recipe.file = file.temporary_path();
    recipe.named = file.target();
    if (recipe.layout == PixelLayout::indices) {
        auto& colors = recipe.palette.emplace();
        colors.fill(0xff000000U);
        std::ranges::copy(options.palette, colors.begin());
    }
    const VideoLibrary& library = video_library();
    if (options.codec == Codec::av1 && library.has_encoder("libsvtav1")) {
        if (!has_memory_for_svt_av1(options.width, options.height)) throw std::bad_alloc();
        if (!render::can_start_threads(threads_of_svt_av1())) throw no_encoder_thread(file.target());
    }
    try {
        return {library.open_encoder(recipe), recipe.layout};
    } catch (const CodecFailure& error) {  // for reasons unknown to format_problem
        const std::string text = std::string("the encoder of ") + title(options.codec) + " rejects films of " +
                                 std::to_string(options.width) + "x" + std::to_string(options.height) +
                                 " pixels here (" + error.what() +
                                 "); choose a smaller size, or write frames (NAME-####.png)";
        if (render::memory_was_short()) throw render::PerhapsOutOfMemory(text);  // encoders do not report it
        if (!render::can_start_threads(kThreadsOfEncoder)) throw no_encoder_thread(file.target());
        throw UnsupportedOption(text);
    }
}

}  // namespace beamcam::output
