#include "output/film/encoder_recipe.hpp"

#include <algorithm>
#include <cmath>
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
    std::vector<std::string> encoders;  // in order of preference
    PixelKind opaque, transparent;
    OptionList options, container_options = {};
    OptionList opaque_options = {}, transparent_options = {};  // in addition to `options`
};

const std::vector<EncoderRow>& encoder_rows() {
    using enum PixelLayout;
    constexpr PixelKind k420{"yuv420p", yuv420}, kAlpha420{"yuva420p", yuva420}, k444{"yuva444p10le", yuva444p10},
        kIndices{"pal8", indices}, kBgra{"bgra", bgra}, kBgr{"bgr0", bgra}, kRgba{"rgba", rgba}, kRgb{"rgb24", rgb};
    static const std::vector<EncoderRow> rows{
        // Without cpu-independent, the rounding of x264 depends on the processor.
        {Codec::h264,
         {"libx264"},
         k420,
         k420,
         {{"preset", "PRESET"}, {"crf", "CRF"}, {"x264-params", "cpu-independent=1"}}},
        // One frame at a time; otherwise the film depends on the number of processors.
        {Codec::hevc,
         {"libx265"},
         k420,
         kAlpha420,
         {{"preset", "fast"}, {"crf", "CRF"}, {"x265-params", "log-level=none:frame-threads=1"}}},
        // Tile columns run on several threads; the picture does not depend on their number. Films with alpha cannot
        // have alternative reference frames.
        {Codec::vp9,
         {"libvpx-vp9"},
         k420,
         kAlpha420,
         {{"crf", "CRF"}, {"b", "0"}, {"deadline", "good"}, {"cpu-used", "4"}, {"tile-columns", "2"}},
         {},
         {},
         {{"auto-alt-ref", "0"}}},
        {Codec::av1,
         {"libsvtav1", "libaom-av1"},
         k420,
         k420,
         {{"crf", "CRF"}, {"libsvtav1:preset", "8"}, {"libaom-av1:cpu-used", "6"}, {"libaom-av1:b", "0"}}},
        {Codec::prores,
         {"prores_ks"},
         k444,
         k444,
         {{"profile", "4444"}, {"vendor", "apl0"}},
         {},
         {{"alpha_bits", "0"}},
         {{"alpha_bits", "16"}}},
        {Codec::ffv1, {"ffv1"}, kBgr, kBgra, {{"level", "3"}, {"slicecrc", "1"}, {"slices", "4"}}},
        {Codec::gif, {"gif"}, kIndices, kIndices, {}, {{"loop", "0"}}},
        {Codec::apng, {"apng"}, kRgb, kRgba, {{"compression_level", "6"}, {"pred", "up"}}, {{"plays", "0"}}},
        {Codec::webp,
         {"libwebp_anim"},
         kBgra,
         kBgra,
         {{"quality", "80"}, {"compression_level", "2"}},
         {{"loop", "0"}}}};
    return rows;
}

void add_encoder(EncoderRecipe& r, const VideoOptions& o) {
    const EncoderRow& row = *std::ranges::find(encoder_rows(), o.codec, &EncoderRow::codec);
    const PixelKind& pixels = o.transparent ? row.transparent : row.opaque;
    r.encoders = row.encoders;
    r.pixel_format = pixels.name;
    r.layout = pixels.layout;
    r.encoder_options = row.options;
    std::ranges::copy(o.transparent ? row.transparent_options : row.opaque_options,
                      std::back_inserter(r.encoder_options));
    r.container_options = row.container_options;
    for (auto& [key, value] : r.encoder_options) {
        if (value == "PRESET") value = o.preset;
        if (value == "CRF")
            value = std::to_string(o.crf.value_or(quality_scale(o.codec).value_or(QualityScale{}).usual));
    }
}

// Options by which a film with a variable frame rate has the right duration.
void keep_durations(EncoderRecipe& r, const VideoOptions& o) {
    // The duration of an MP4 is that of its packets in decoding order, which must be the display order.
    if (o.codec == Codec::h264) r.encoder_options.emplace_back("bf", "0");
    if (o.codec == Codec::hevc)
        std::ranges::find(r.encoder_options, "x265-params", &OptionList::value_type::first)->second += ":bframes=0";
    // Otherwise the last picture would last as long as the previous one.
    if (o.codec == Codec::gif)
        r.container_options.emplace_back("final_delay", std::to_string(std::lround(100 / o.fps.value())));
    if (o.codec == Codec::apng)
        r.container_options.emplace_back("final_delay",
                                         std::to_string(o.fps.denominator) + "/" + std::to_string(o.fps.numerator));
}

}  // namespace

const char* container_of(std::string_view ending) {
    if (ending == ".webm") return "webm";
    if (ending == ".mov") return "mov";
    if (ending == ".mkv") return "matroska";
    if (ending == ".gif") return "gif";
    if (ending == ".apng") return "apng";
    if (ending == ".webp") return "webp";
    return "mp4";
}

EncoderRecipe encoder_recipe(const VideoOptions& o, const std::string& ending) {
    EncoderRecipe r;
    static_cast<FilmSettings&>(r) = o;
    r.container = container_of(ending);
    add_encoder(r, o);
    r.missing = std::string("the FFmpeg libraries on this machine have no ") + title(o.codec) + " encoder (";
    for (const std::string& encoder : r.encoders) r.missing += (encoder == r.encoders.front() ? "" : " or ") + encoder;
    r.missing += "); install the distribution's full build of libavcodec, or choose another codec";
    if (o.codec == Codec::hevc && o.transparent)
        r.missing =
            "the FFmpeg libraries on this machine encode no transparent HEVC (FFmpeg 7.1 and a libx265 built with "
            "alpha do); "
            "name a .mov (prores), .webm (vp9), .mkv (ffv1), .apng or .webp file";
    // faststart: the index comes first, so that players can start before they have the whole file.
    // use_metadata_tags: keeps our own keys.
    if (ending == ".mp4" || ending == ".mov")
        r.container_options.emplace_back("movflags", "+faststart+use_metadata_tags");
    if (o.variable_rate) keep_durations(r, o);
    return r;
}

}  // namespace beamcam::output
