#include "output/film/video_encoder.hpp"

#include <algorithm>

#include "output/film/encoder_recipe.hpp"

namespace beamcam::output {

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

OpenedEncoder open_encoder(const VideoOptions& options, const AtomicFile& file) {
    EncoderRecipe recipe = encoder_recipe(options, file.target().extension().string());
    recipe.file = file.temporary_path();
    recipe.named = file.target();
    if (recipe.layout == PixelLayout::indices) {
        auto& colors = recipe.palette.emplace();
        colors.fill(0xff000000U);
        std::ranges::copy(options.palette, colors.begin());
    }
    try {
        return {video_library().open_encoder(recipe), recipe.layout};
    } catch (const CodecFailure& error) {  // for reasons unknown to format_problem
        throw UnsupportedOption(std::string("the encoder of ") + title(options.codec) + " rejects films of " +
                                std::to_string(options.width) + "x" + std::to_string(options.height) +
                                " pixels here (" + error.what() +
                                "); choose a smaller size, or write frames (NAME-####.png)");
    }
}

}  // namespace beamcam::output
