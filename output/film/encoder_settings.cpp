#include "output/film/encoder_settings.hpp"

#include <algorithm>
#include <iterator>

namespace beamcam::output {
namespace {

struct PixelKind {
    const char* name;
    PixelLayout layout;
};

// One for each codec. The film's options replace the values "CRF" and "PRESET".
struct EncoderRow {
    Codec codec;
    const char* encoder;  // FFmpeg's name
    PixelKind opaque, transparent;
    OptionList options, container_options = {};
    OptionList opaque_options = {}, transparent_options = {};  // in addition to `options`
};

const std::vector<EncoderRow>& encoder_rows() {
    using enum PixelLayout;
    constexpr PixelKind k420{"yuv420p", yuv420}, kAlpha420{"yuva420p", yuva420}, k444{"yuva444p10le", yuva444p10},
        kIndices{"pal8", indices}, kBgra{"bgra", bgra}, kBgr{"bgr0", bgra};
    static const std::vector<EncoderRow> rows{
        // Without cpu-independent, the rounding of x264 depends on the processor.
        {Codec::h264,
         "libx264",
         k420,
         k420,
         {{"preset", "PRESET"}, {"crf", "CRF"}, {"x264-params", "cpu-independent=1"}}},
        // Tile columns run on several threads; the picture does not depend on their number. Films with alpha cannot
        // have alternative reference frames.
        {Codec::vp9,
         "libvpx-vp9",
         k420,
         kAlpha420,
         {{"crf", "CRF"}, {"b", "0"}, {"deadline", "good"}, {"cpu-used", "4"}, {"tile-columns", "2"}},
         {},
         {},
         {{"auto-alt-ref", "0"}}},
        {Codec::prores,
         "prores_ks",
         k444,
         k444,
         {{"profile", "4444"}, {"vendor", "apl0"}},
         {},
         {{"alpha_bits", "0"}},
         {{"alpha_bits", "16"}}},
        {Codec::ffv1, "ffv1", kBgr, kBgra, {{"level", "3"}, {"slicecrc", "1"}, {"slices", "4"}}},
        {Codec::gif, "gif", kIndices, kIndices, {}, {{"loop", "0"}}},
        {Codec::webp, "libwebp_anim", kBgra, kBgra, {{"quality", "80"}, {"compression_level", "2"}}, {{"loop", "0"}}}};
    return rows;
}

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
    const EncoderRow& row = *std::ranges::find(encoder_rows(), o.codec, &EncoderRow::codec);
    const PixelKind& pixels = o.transparent ? row.transparent : row.opaque;
    s.encoder = row.encoder;
    s.pixel_format = pixels.name;
    s.layout = pixels.layout;
    s.encoder_options = row.options;
    std::ranges::copy(o.transparent ? row.transparent_options : row.opaque_options,
                      std::back_inserter(s.encoder_options));
    s.container_options = row.container_options;
    for (auto& [key, value] : s.encoder_options) {
        if (value == "PRESET") value = o.preset;
        if (value == "CRF")
            value = std::to_string(o.crf.value_or(quality_scale(o.codec).value_or(QualityScale{}).usual));
    }
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
    // The duration of an MP4 is that of its packets in decoding order, which must be the display order.
    if (o.variable_rate && o.codec == Codec::h264) s.encoder_options.emplace_back("bf", "0");
    if (s.layout != PixelLayout::indices) return s;
    s.palette.emplace().fill(0xff000000U);
    std::ranges::copy(o.palette, s.palette->begin());
    return s;
}

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
