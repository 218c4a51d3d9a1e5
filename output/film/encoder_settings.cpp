#include "output/film/encoder_settings.hpp"

#include <algorithm>

namespace beamcam::output {
namespace {

// FFmpeg's name of the muxer.
const char* container_of(std::string_view ending) {
    if (ending == ".webm") return "webm";
    if (ending == ".mov") return "mov";
    if (ending == ".mkv") return "matroska";
    if (ending == ".gif") return "gif";
    if (ending == ".webp") return "webp";
    return "mp4";
}

void choose_encoder(EncoderSettings& s, const VideoOptions& o) {
    const auto pixels = [&s](const char* format, PixelLayout layout) { s.pixel_format = format, s.layout = layout; };
    const std::string crf = std::to_string(o.crf.value_or(quality_scale(o.codec).value_or(QualityScale{}).usual));
    switch (o.codec) {
        case Codec::h264:  // without cpu-independent, the rounding of x264 depends on the processor
            pixels("yuv420p", PixelLayout::yuv420);
            s.encoder_options = {{"preset", o.preset}, {"crf", crf}, {"x264-params", "cpu-independent=1"}};
            // The duration of an MP4 is that of its packets in decoding order, which must be the display order.
            if (o.variable_rate) s.encoder_options.emplace_back("bf", "0");
            break;
        case Codec::vp9:  // tile columns run on several threads; the picture does not depend on their number
            o.transparent ? pixels("yuva420p", PixelLayout::yuva420) : pixels("yuv420p", PixelLayout::yuv420);
            s.encoder_options = {
                {"crf", crf}, {"b", "0"}, {"deadline", "good"}, {"cpu-used", "4"}, {"tile-columns", "2"}};
            // Films with alpha cannot have alternative reference frames.
            if (o.transparent) s.encoder_options.emplace_back("auto-alt-ref", "0");
            break;
        case Codec::prores:
            pixels("yuva444p10le", PixelLayout::yuva444p10);
            s.encoder_options = {{"profile", "4444"}, {"vendor", "apl0"}, {"alpha_bits", o.transparent ? "16" : "0"}};
            break;
        case Codec::ffv1:
            pixels(o.transparent ? "bgra" : "bgr0", PixelLayout::bgra);
            s.encoder_options = {{"level", "3"}, {"slicecrc", "1"}, {"slices", "4"}};
            break;
        case Codec::gif:
            pixels("pal8", PixelLayout::indices);
            s.container_options = {{"loop", "0"}};
            s.palette.emplace().fill(0xff000000U);
            std::ranges::copy(o.palette, s.palette->begin());
            break;
        case Codec::webp:
            pixels("bgra", PixelLayout::bgra);
            s.encoder_options = {{"quality", "80"}, {"compression_level", "2"}};
            s.container_options = {{"loop", "0"}};
            break;
    }
    s.encoder = encoder_name(o.codec);
    s.missing = std::string("the FFmpeg libraries on this machine have no ") + title(o.codec) + " encoder (" +
                s.encoder + "); install the distribution's full build of libavcodec, or choose another codec";
}

}  // namespace

EncoderSettings encoder_settings(const VideoOptions& o, const AtomicFile& file) {
    EncoderSettings s;
    static_cast<FilmSettings&>(s) = o;
    s.file = file.temporary_path();
    s.named = file.target();
    const std::string ending = file.target().extension().string();
    s.container = container_of(ending);
    choose_encoder(s, o);
    // faststart: the index comes first, so that players can start before they have the whole file.
    // use_metadata_tags: keeps our own keys.
    if (ending == ".mp4" || ending == ".mov")
        s.container_options.emplace_back("movflags", "+faststart+use_metadata_tags");
    return s;
}

std::vector<std::string> problems(const VideoOptions& o, std::string_view ending) {
    std::vector<std::string> found;
    for (std::string problem :
         {format_problem(ending, o.codec, o.transparent), size_problem(o.codec, o.width, o.height),
          rate_problem(o.codec, o.fps.value()), quality_problem(o.codec, o.crf)})
        if (!problem.empty()) found.push_back(std::move(problem));
    if (o.codec == Codec::gif && (o.palette.empty() || o.palette.size() > 256))
        found.push_back("a GIF needs a palette of 1 to 256 colours");
    return found;
}

std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings, const VideoOptions& options) {
    try {
        return video_library().open_encoder(settings);
    } catch (const CodecFailure& error) {  // for reasons unknown to format_problem
        throw UnsupportedOption(std::string("the encoder of ") + title(options.codec) + " rejects films of " +
                                std::to_string(options.width) + "x" + std::to_string(options.height) +
                                " pixels here (" + error.what() +
                                "); choose a smaller size, or write frames (NAME-####.png)");
    }
}

}  // namespace beamcam::output
