// One of the two files that see FFmpeg (the other: reader.cpp): encoders and containers through libavcodec and
// libavformat 59 to 61 (FFmpeg 5 to 7). Built as a module of its own; video.cpp loads it through video_module.hpp.
#include "output/video_module.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace {

struct OwnedFrame : BeamcamVideoFrame {
    AVFrame* av = nullptr;
    ~OwnedFrame() { av_frame_free(&av); }
};

}  // namespace

struct BeamcamVideoSession {
    AVFormatContext* format = nullptr;
    AVCodecContext* codec = nullptr;
    AVStream* stream = nullptr;
    AVPacket* packet = nullptr;
    std::vector<std::unique_ptr<OwnedFrame>> frames;
    std::int64_t next_frame = 0;
    std::uint32_t palette[256] = {};

    ~BeamcamVideoSession() {
        av_packet_free(&packet);
        avcodec_free_context(&codec);
        if (format != nullptr) avio_closep(&format->pb);
        avformat_free_context(format);
    }
};

namespace {

BeamcamVideoStatus fail(BeamcamVideoError* error, const char* doing, int code) {
    char reason[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(code, reason, sizeof reason);
    std::snprintf(error->text, sizeof error->text, "%s: %s", doing, reason);
    error->error_number = AVUNERROR(code);
    return beamcam_video_failed;
}

// Errors of the file itself, which the program reports with the file's name.
BeamcamVideoStatus fail_to_write(BeamcamVideoError* error, int code) {
    fail(error, "writing", code);
    if (error->error_number <= 0) error->error_number = EIO;
    return beamcam_video_write_failed;
}

const AVCodec* first_encoder(const BeamcamVideoSettings& s, BeamcamVideoError* error) {
    for (const char* const* name = s.encoders; *name != nullptr; ++name)
        if (const AVCodec* codec = avcodec_find_encoder_by_name(*name)) return codec;
    std::snprintf(error->text, sizeof error->text, "%s", s.missing);
    return nullptr;
}

// Keys of the form "name:key" are for the encoder of that name alone.
void add_options(AVDictionary** to, const char* const* options, const char* encoder) {
    for (; *options != nullptr; options += 2) {
        const char* colon = std::strchr(options[0], ':');
        if (colon == nullptr)
            av_dict_set(to, options[0], options[1], 0);
        else if (std::string(options[0], colon) == encoder)
            av_dict_set(to, colon + 1, options[1], 0);
    }
}

bool is_yuv(AVPixelFormat format) {
    const AVPixFmtDescriptor* d = av_pix_fmt_desc_get(format);
    return d != nullptr && (d->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) == 0;
}

BeamcamVideoStatus open_codec(BeamcamVideoSession& session, const AVCodec* encoder, const BeamcamVideoSettings& s,
                              BeamcamVideoError* error) {
    AVCodecContext* codec = session.codec = avcodec_alloc_context3(encoder);
    if (codec == nullptr) return fail(error, "setting up the encoder", AVERROR(ENOMEM));
    codec->width = s.width;
    codec->height = s.height;
    codec->time_base = {s.rate_base, s.rate};
    codec->framerate = {s.rate, s.rate_base};
    codec->sample_aspect_ratio = {1, 1};
    codec->pix_fmt = av_get_pix_fmt(s.pixel_format);
    if (is_yuv(codec->pix_fmt)) {
        codec->color_primaries = AVCOL_PRI_BT709;
        codec->color_trc = AVCOL_TRC_BT709;
        codec->colorspace = AVCOL_SPC_BT709;
        codec->color_range = AVCOL_RANGE_MPEG;
        codec->chroma_sample_location = AVCHROMA_LOC_CENTER;
    }
    codec->thread_count = s.threads;
    if ((session.format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;

    AVDictionary* options = nullptr;
    add_options(&options, s.encoder_options, encoder->name);
    int code = avcodec_open2(codec, encoder, &options);
    if (code >= 0 && av_dict_count(options) > 0) code = AVERROR_OPTION_NOT_FOUND;
    av_dict_free(&options);
    return code < 0 ? fail(error, "opening the encoder", code) : beamcam_video_ok;
}

BeamcamVideoStatus open_file(BeamcamVideoSession& session, const BeamcamVideoSettings& s, BeamcamVideoError* error) {
    session.stream = avformat_new_stream(session.format, nullptr);
    if (session.stream == nullptr) return fail(error, "setting up the film", AVERROR(ENOMEM));
    session.stream->time_base = session.codec->time_base;
    session.stream->avg_frame_rate = session.codec->framerate;
    session.stream->sample_aspect_ratio = {1, 1};
    int code = avcodec_parameters_from_context(session.stream->codecpar, session.codec);
    if (code < 0) return fail(error, "setting up the film", code);

    for (const char* const* entry = s.metadata; *entry != nullptr; entry += 2)
        av_dict_set(&session.format->metadata, entry[0], entry[1], 0);
    code = avio_open(&session.format->pb, session.format->url, AVIO_FLAG_WRITE);
    if (code < 0) return fail_to_write(error, code);

    // bitexact: no library version, no date.
    session.format->flags |= AVFMT_FLAG_BITEXACT;
    AVDictionary* options = nullptr;
    add_options(&options, s.container_options, "");
    code = avformat_write_header(session.format, &options);
    av_dict_free(&options);
    return code < 0 ? fail_to_write(error, code) : beamcam_video_ok;
}

BeamcamVideoStatus open_session(BeamcamVideoSession& session, const BeamcamVideoSettings& s, BeamcamVideoError* error) {
    const AVCodec* encoder = first_encoder(s, error);
    if (encoder == nullptr) return beamcam_video_missing_codec;
    // "file:" keeps FFmpeg from reading a protocol into names such as "a:b.mp4".
    const std::string url = std::string("file:") + s.file;
    const int code = avformat_alloc_output_context2(&session.format, nullptr, s.container, url.c_str());
    if (code < 0) return fail(error, "setting up the film", code);
    session.packet = av_packet_alloc();
    if (session.packet == nullptr) return fail(error, "setting up the film", AVERROR(ENOMEM));
    if (const auto status = open_codec(session, encoder, s, error); status != beamcam_video_ok) return status;
    return open_file(session, s, error);
}

// Moves what the encoder has ready into the file.
BeamcamVideoStatus drain(BeamcamVideoSession& session, BeamcamVideoError* error) {
    for (;;) {
        int code = avcodec_receive_packet(session.codec, session.packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return beamcam_video_ok;
        if (code < 0) return fail(error, "encoding", code);
        session.packet->stream_index = session.stream->index;
        // libx264 leaves it out, and the last frame would last no time. An animated WebP comes in one packet.
        if (session.packet->duration == 0) session.packet->duration = 1;
        av_packet_rescale_ts(session.packet, session.codec->time_base, session.stream->time_base);
        code = av_interleaved_write_frame(session.format, session.packet);
        if (code >= 0 && session.format->pb->error < 0) code = session.format->pb->error;
        if (code < 0) return fail_to_write(error, code);
    }
}

void show_planes(OwnedFrame& frame) {
    for (int i = 0; i < 4; ++i) {
        frame.plane[i] = frame.av->data[i];
        frame.stride[i] = frame.av->linesize[i];
    }
}

// ---- the functions behind the door -------------------------------------------------------------

BeamcamVideoStatus open(const BeamcamVideoSettings* settings, BeamcamVideoSession** session,
                        BeamcamVideoError* error) noexcept try {
    av_log_set_level(AV_LOG_FATAL);  // messages reach the user through `error`
    setenv("SVT_LOG", "0", 0);       // SVT-AV1 would print its own
    auto opened = std::make_unique<BeamcamVideoSession>();
    if (settings->palette != nullptr) std::memcpy(opened->palette, settings->palette, sizeof opened->palette);
    const auto status = open_session(*opened, *settings, error);
    *session = status == beamcam_video_ok ? opened.release() : nullptr;
    return status;
} catch (const std::bad_alloc&) {
    return fail(error, "setting up the film", AVERROR(ENOMEM));
}

BeamcamVideoFrame* make_frame(BeamcamVideoSession* session) noexcept try {
    auto frame = std::make_unique<OwnedFrame>();
    frame->av = av_frame_alloc();
    if (frame->av == nullptr) return nullptr;
    frame->av->format = session->codec->pix_fmt;
    frame->av->width = session->codec->width;
    frame->av->height = session->codec->height;
    // ProRes tells what its frames tell, not what the encoder was told.
    frame->av->color_primaries = session->codec->color_primaries;
    frame->av->color_trc = session->codec->color_trc;
    frame->av->colorspace = session->codec->colorspace;
    frame->av->color_range = session->codec->color_range;
    if (av_frame_get_buffer(frame->av, 0) < 0) return nullptr;
    if (session->codec->pix_fmt == AV_PIX_FMT_PAL8) std::memcpy(frame->av->data[1], session->palette, 1024);
    show_planes(*frame);
    session->frames.push_back(std::move(frame));
    return session->frames.back().get();
} catch (const std::bad_alloc&) {
    return nullptr;
}

BeamcamVideoStatus encode(BeamcamVideoSession* session, BeamcamVideoFrame* frame, BeamcamVideoError* error) noexcept {
    AVFrame* picture = static_cast<OwnedFrame*>(frame)->av;
    picture->pts = session->next_frame++;
    int code = avcodec_send_frame(session->codec, picture);
    if (code < 0) return fail(error, "encoding", code);
    const auto status = drain(*session, error);
    // x264 has copied the picture by now; an encoder that still reads it gets the old buffer to itself.
    code = av_frame_make_writable(picture);
    if (code < 0) return fail(error, "encoding", code);
    show_planes(*static_cast<OwnedFrame*>(frame));
    return status;
}

BeamcamVideoStatus finish(BeamcamVideoSession* session, BeamcamVideoError* error) noexcept {
    int code = avcodec_send_frame(session->codec, nullptr);
    if (code < 0) return fail(error, "encoding", code);
    if (const auto status = drain(*session, error); status != beamcam_video_ok) return status;
    code = av_write_trailer(session->format);
    if (code >= 0 && session->format->pb->error < 0) code = session->format->pb->error;
    const int closed = avio_closep(&session->format->pb);
    if (code >= 0) code = closed;
    return code < 0 ? fail_to_write(error, code) : beamcam_video_ok;
}

void close(BeamcamVideoSession* session) noexcept { delete session; }

constexpr BeamcamVideoModule kModule = {kBeamcamVideoModuleVersion, open, make_frame, encode, finish, close};

}  // namespace

extern "C" __attribute__((visibility("default"))) const BeamcamVideoModule* beamcam_video_module() { return &kModule; }
