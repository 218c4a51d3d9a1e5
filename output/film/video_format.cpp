#include "output/film/video_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace beamcam::output {
namespace {

struct CodecRow {
    Codec codec;
    const char *name, *title, *encoder;
    bool alpha, even;
    int usual, worst;  // of crf; worst 0: none
};
constexpr std::array kEntries{CodecRow{Codec::h264, "h264", "H.264", "libx264", false, true, 18, 51},
                              CodecRow{Codec::vp9, "vp9", "VP9", "libvpx-vp9", true, true, 24, 63},
                              CodecRow{Codec::prores, "prores", "ProRes 4444", "prores_ks", true, false, 0, 0},
                              CodecRow{Codec::ffv1, "ffv1", "FFV1", "ffv1", true, false, 0, 0},
                              CodecRow{Codec::gif, "gif", "GIF", "gif", false, false, 0, 0},
                              CodecRow{Codec::webp, "webp", "WebP", "libwebp_anim", true, false, 0, 0}};

const CodecRow& row_of(Codec codec) { return *std::ranges::find(kEntries, codec, &CodecRow::codec); }

struct Container {
    std::string_view ending;
    std::array<std::optional<Codec>, 3> codecs;  // the usual one first
};
constexpr std::array kContainers{Container{".mp4", {Codec::h264}},
                                 Container{".webm", {Codec::vp9}},
                                 Container{".mov", {Codec::prores, Codec::h264}},
                                 Container{".mkv", {Codec::ffv1, Codec::h264, Codec::vp9}},
                                 Container{".gif", {Codec::gif}},
                                 Container{".webp", {Codec::webp}}};

const Container* container(std::string_view ending) {
    const auto at = std::ranges::find(kContainers, ending, &Container::ending);
    return at == kContainers.end() ? nullptr : &*at;
}

constexpr int kLargestWebpSide = 16383;                                // its fields have 14 bits
constexpr std::int64_t kLargestPicture = (std::int64_t{1} << 31) - 1;  // av_image_check_size
constexpr double kFastestGif = 50;                                     // [Hz]

}  // namespace

const char* name(Codec codec) { return row_of(codec).name; }
const char* title(Codec codec) { return row_of(codec).title; }
const char* encoder_name(Codec codec) { return row_of(codec).encoder; }
std::optional<Codec> default_codec(std::string_view ending) {
    const Container* file = container(ending);
    return file ? file->codecs.front() : std::nullopt;
}
bool goes_into(Codec codec, std::string_view ending) {
    const Container* file = container(ending);
    return file && std::ranges::find(file->codecs, std::optional(codec)) != file->codecs.end();
}

std::optional<QualityScale> quality_scale(Codec codec) {
    const CodecRow& e = row_of(codec);
    if (e.worst == 0) return std::nullopt;
    return QualityScale{e.usual, e.worst};
}

std::string quality_problem(Codec codec, std::optional<int> crf) {
    const auto scale = quality_scale(codec);
    if (!crf || (scale && *crf >= 0 && *crf <= scale->worst)) return {};
    return scale ? "crf " + std::to_string(*crf) + " is not possible; use 0 (best) to " + std::to_string(scale->worst) +
                       ", " + std::to_string(scale->usual) + " looks lossless"
                 : std::string(title(codec)) + " has no crf, because its quality is fixed; remove it";
}

std::string format_problem(std::string_view ending, Codec codec, bool transparent) {
    const Container* file = container(ending);
    if (!file) {
        std::string all;
        for (const Container& known : kContainers) all += (all.empty() ? "" : ", ") + std::string(known.ending);
        return std::string("\"").append(ending) + "\" is not an ending of films; use " + all;
    }
    if (!goes_into(codec, ending)) {
        std::string codecs, endings;
        for (const auto& c : file->codecs)
            if (c) codecs += (codecs.empty() ? "" : " or ") + std::string(name(*c));
        for (const Container& known : kContainers)
            if (goes_into(codec, known.ending)) endings += (endings.empty() ? "" : " or ") + std::string(known.ending);
        return std::string(title(codec)) + " does not go into a " + std::string(ending) + " file, which holds " +
               codecs + "; name a " + endings + " file, or change the codec";
    }
    if (transparent && !row_of(codec).alpha)
        return std::string(title(codec)) +
               (codec == Codec::gif ? " has no half-transparent pixels, and every edge needs them"
                                    : " cannot be transparent") +
               "; name a .webm (vp9), .mov (prores), .mkv (ffv1) or .webp file, or write frames (NAME-####.png)";
    return {};
}

std::string size_problem(Codec codec, int width, int height) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (codec == Codec::webp && std::max(width, height) > kLargestWebpSide)
        return "an animated WebP of " + size + " pixels is not possible; both sides must be at most " +
               std::to_string(kLargestWebpSide) + ", or choose another codec";
    if (8 * (std::int64_t{width} + 128) * (std::int64_t{height} + 128) > kLargestPicture)
        return "a film of " + size +
               " pixels is not possible, because FFmpeg takes no picture larger than "
               "16250x16250; choose a smaller size, or write frames (NAME-####.png)";
    if (row_of(codec).even && (width % 2 != 0 || height % 2 != 0))
        return "a film of " + size + " pixels is not possible, because " + title(codec) +
               " (yuv420p) stores colour for pairs of rows and columns; use " + std::to_string(width + width % 2) +
               "x" + std::to_string(height + height % 2) + ", or a .mov (prores), .mkv (ffv1), .gif or .webp file";
    return {};
}

std::string rate_problem(Codec codec, double fps) {
    if (codec != Codec::gif || fps <= kFastestGif) return {};
    return "a GIF counts in hundredths of a second, and players slow down one of more than 50 frames per second; use "
           "50, 25 or 20, or a .webp file for a higher rate";
}

FrameRate frame_rate(double fps) {
    // 23.976, 23.98, 29.97, 59.94 …: usual decimals differ from n·1000/1001 by less than 0.005; no integer rate does.
    for (int whole : {24, 30, 48, 60, 72, 90, 96, 100, 120, 144, 240})
        if (std::abs(fps - whole * 1000.0 / 1001) < 0.005) return {whole * 1000, 1001};
    FrameRate best{static_cast<int>(std::lround(fps)), 1};
    for (int denominator = 1; denominator <= 1000; ++denominator) {
        const FrameRate candidate{static_cast<int>(std::lround(fps * denominator)), denominator};
        if (std::abs(candidate.value() - fps) < std::abs(best.value() - fps) - 1e-12 * fps) best = candidate;
    }
    return best;
}

}  // namespace beamcam::output
