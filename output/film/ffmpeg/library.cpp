// The entry of the module, and functions that its files share (library.hpp). libavformat and libavcodec 59 to 61
// (FFmpeg 5 to 7).
#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "render/base/modules.hpp"

namespace beamcam::output::ffmpeg {
namespace {

struct CloseInput {
    void operator()(AVFormatContext* film) const { avformat_close_input(&film); }
};

// Only containers of films are recognized, and only this file is read: play lists and scripts could open other files or
// addresses.
std::unique_ptr<AVFormatContext, CloseInput> open_input(const std::filesystem::path& file) {
    AVFormatContext* film = avformat_alloc_context();
    if (film == nullptr) throw std::bad_alloc();
    film->format_whitelist = av_strdup("mov,mp4,m4a,3gp,3g2,mj2,matroska,webm");
    film->protocol_whitelist = av_strdup("file");
    const int code = avformat_open_input(&film, url_of(file).c_str(), nullptr, nullptr);  // frees it when it fails
    if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
    if (code < 0)
        throw IoError("cannot read " + file.string() +
                      ": it is not an MP4, MOV, Matroska or WebM film, or its beginning is damaged (FFmpeg: " +
                      reason(code) + ")");
    return std::unique_ptr<AVFormatContext, CloseInput>(film);
}

VideoInfo info_of(const std::filesystem::path& file) {
    const auto film = open_input(file);
    const int best = av_find_best_stream(film.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (best < 0) throw IoError("cannot read " + file.string() + ": it contains no pictures");
    const AVStream& stream = *film->streams[best];
    VideoInfo info;
    info.width = stream.codecpar->width;
    info.height = stream.codecpar->height;
    info.frames = static_cast<long>(std::max<std::int64_t>(0, stream.nb_frames));
    if (film->duration > 0)
        info.seconds = static_cast<double>(film->duration) / AV_TIME_BASE;
    else if (stream.duration > 0)  // MP4 and MOV since FFmpeg 7
        info.seconds = static_cast<double>(stream.duration) * av_q2d(stream.time_base);
    info.codec = avcodec_get_name(stream.codecpar->codec_id);
    for (const AVDictionary* some : {film->metadata, stream.metadata}) {
        const AVDictionaryEntry* entry = nullptr;
        while ((entry = av_dict_get(some, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr)
            info.metadata[entry->key] = entry->value;
    }
    return info;
}

class Library : public VideoLibrary {
  public:
    Library() { av_log_set_level(AV_LOG_QUIET); }  // errors are exceptions
    std::unique_ptr<Encoder> open_encoder(const VideoOptions& options, const std::filesystem::path& file,
                                          const std::filesystem::path& named) const override {
        return ffmpeg::open_encoder(options, file, named);
    }
    VideoInfo info(const std::filesystem::path& file) const override { return info_of(file); }
    std::string versions() const override {
        const auto version = [](const char* name, unsigned number) {
            return std::string(name) + " " + std::to_string(number >> 16 & 0xff) + "." +
                   std::to_string(number >> 8 & 0xff) + "." + std::to_string(number & 0xff);
        };
        return version("libavcodec", avcodec_version()) + ", " + version("libavformat", avformat_version());
    }
    bool has_encoder(const std::string& name) const override {
        return avcodec_find_encoder_by_name(name.c_str()) != nullptr;
    }
};

const Library kLibrary;

}  // namespace

std::string url_of(const std::filesystem::path& file) {
    return "file:" + file.string();  // so that FFmpeg finds no protocol in names such as "a:b.mp4"
}

void Free::operator()(AVPacket* packet) const { av_packet_free(&packet); }
void Free::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void Free::operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }

std::string reason(int code) {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
    av_strerror(code, text.data(), text.size());
    return text.data();
}

void fail(const char* doing, int code) {
    if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
    throw CodecFailure(std::string(doing) + ": " + reason(code));
}

}  // namespace beamcam::output::ffmpeg

BEAMCAM_MODULE(static_cast<const beamcam::output::VideoLibrary&>(beamcam::output::ffmpeg::kLibrary))
