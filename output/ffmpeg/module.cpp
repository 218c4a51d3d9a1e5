// One of the two files that see FFmpeg (the other: reader.cpp): encoders and containers through libavcodec and
// libavformat 59 to 61 (FFmpeg 5 to 7). Built as a module of its own; video.cpp loads it through video_module.hpp.
#include "output/video_module.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <utility>
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
    bool ended = false;  // the encoder has given out everything
    std::uint32_t palette[256] = {};

    ~BeamcamVideoSession() {
        run_dry();
        av_packet_free(&packet);
        avcodec_free_context(&codec);
        if (format != nullptr) avio_closep(&format->pb);
        avformat_free_context(format);
    }

  private:
    // SVT-AV1 waits forever when it is closed before it has seen a picture and their end: it gets what it lacks, and
    // what it makes of that is dropped.
    void run_dry() noexcept {
        if (codec == nullptr || !avcodec_is_open(codec) || ended || std::strcmp(codec->codec->name, "libsvtav1") != 0)
            return;
        if (next_frame == 0) {
            AVFrame* blank = av_frame_alloc();
            if (blank == nullptr) return;
            blank->format = codec->pix_fmt;
            blank->width = codec->width;
            blank->height = codec->height;
            blank->pts = 0;
            if (av_frame_get_buffer(blank, 0) >= 0) avcodec_send_frame(codec, blank);
            av_frame_free(&blank);
        }
        avcodec_send_frame(codec, nullptr);
        while (avcodec_receive_packet(codec, packet) >= 0) av_packet_unref(packet);
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

BeamcamVideoStatus write_header(BeamcamVideoSession& session, const char* const* container_options,
                                BeamcamVideoError* error) {
    int code = avio_open(&session.format->pb, session.format->url, AVIO_FLAG_WRITE);
    if (code < 0) return fail_to_write(error, code);

    // bitexact: no library version, no date.
    session.format->flags |= AVFMT_FLAG_BITEXACT;
    AVDictionary* options = nullptr;
    add_options(&options, container_options, "");
    code = avformat_write_header(session.format, &options);
    av_dict_free(&options);
    return code < 0 ? fail_to_write(error, code) : beamcam_video_ok;
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
    return write_header(session, s.container_options, error);
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

BeamcamVideoStatus end_file(BeamcamVideoSession& session, BeamcamVideoError* error) {
    int code = av_write_trailer(session.format);
    if (code >= 0 && session.format->pb->error < 0) code = session.format->pb->error;
    const int closed = avio_closep(&session.format->pb);
    if (code >= 0) code = closed;
    return code < 0 ? fail_to_write(error, code) : beamcam_video_ok;
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

void hold(BeamcamVideoSession* session, std::int64_t frames) noexcept { session->next_frame += frames; }

BeamcamVideoStatus finish(BeamcamVideoSession* session, BeamcamVideoError* error) noexcept {
    int code = avcodec_send_frame(session->codec, nullptr);
    if (code < 0) return fail(error, "encoding", code);
    if (const auto status = drain(*session, error); status != beamcam_video_ok) return status;
    session->ended = true;
    return end_file(*session, error);
}

void close(BeamcamVideoSession* session) noexcept { delete session; }

// ---- joining films ------------------------------------------------------------------------------

struct Segment {
    std::string name;
    AVFormatContext* format = nullptr;
    AVStream* stream = nullptr;
    long first = 0, end = 0, begin_of_all = 0, end_of_all = 0;  // frame numbers, where the segment tells them
    bool numbered = false;

    Segment() = default;
    Segment(Segment&& other) noexcept
        : name(std::move(other.name)),
          format(std::exchange(other.format, nullptr)),
          stream(other.stream),
          first(other.first),
          end(other.end),
          begin_of_all(other.begin_of_all),
          end_of_all(other.end_of_all),
          numbered(other.numbered) {}
    ~Segment() { avformat_close_input(&format); }

    std::string tag(const char* key) const {
        const AVDictionaryEntry* entry = av_dict_get(format->metadata, key, nullptr, 0);
        return entry != nullptr ? entry->value : "";
    }
};

BeamcamVideoStatus refuse(BeamcamVideoError* error, BeamcamVideoStatus status, const std::string& text) {
    std::snprintf(error->text, sizeof error->text, "%s", text.c_str());
    return status;
}

BeamcamVideoStatus open_segment(const char* name, Segment& segment, BeamcamVideoError* error) {
    segment.name = name;
    const std::string url = "file:" + segment.name;
    int code = avformat_open_input(&segment.format, url.c_str(), nullptr, nullptr);
    if (code >= 0) code = avformat_find_stream_info(segment.format, nullptr);
    if (code < 0) {
        char reason[AV_ERROR_MAX_STRING_SIZE] = "";
        av_strerror(code, reason, sizeof reason);
        return refuse(error, beamcam_video_read_failed, "cannot read " + segment.name + " as a film: " + reason);
    }
    for (unsigned i = 0; i < segment.format->nb_streams; ++i)
        if (segment.format->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO)
            segment.stream = segment.format->streams[i];
    if (segment.stream == nullptr || segment.format->nb_streams != 1)
        return refuse(error, beamcam_video_differs,
                      segment.name +
                          " is not one of beamcam's films: it should hold one "
                          "stream of pictures and nothing else");
    if (segment.tag("beamcam-rate-mode") == "variable")
        return refuse(
            error, beamcam_video_differs,
            segment.name + " has a variable frame rate; parts of a film (--shard) keep every frame and can be joined");
    const std::string part = segment.tag("beamcam-frames");
    segment.numbered = std::sscanf(part.c_str(), "%ld:%ld of %ld:%ld", &segment.first, &segment.end,
                                   &segment.begin_of_all, &segment.end_of_all) == 4;
    return beamcam_video_ok;
}

std::string size_of(const AVCodecParameters& p) { return std::to_string(p.width) + "x" + std::to_string(p.height); }

// A scene without the names of its outputs, which say nothing about pictures.
std::string without_files(std::string scene) {
    const std::string key = "\"file\": \"";
    for (std::size_t at = scene.find(key); at != std::string::npos; at = scene.find(key, at)) {
        std::size_t end = at + key.size();
        while (end < scene.size() && scene[end] != '"') end += scene[end] == '\\' ? 2 : 1;
        scene.erase(at, std::min(end, scene.size()) - at);
    }
    return scene;
}

// Why `b` cannot follow `a`; empty when it can.
std::string mismatch(const Segment& a, const Segment& b) {
    const AVCodecParameters &p = *a.stream->codecpar, &q = *b.stream->codecpar;
    if (p.codec_id != q.codec_id)
        return std::string("codecs ") + avcodec_get_name(p.codec_id) + " and " + avcodec_get_name(q.codec_id);
    if (p.width != q.width || p.height != q.height) return "sizes " + size_of(p) + " and " + size_of(q);
    if (av_cmp_q(a.stream->avg_frame_rate, b.stream->avg_frame_rate) != 0 ||
        av_cmp_q(a.stream->time_base, b.stream->time_base) != 0)
        return "frame rates";
    // VP9 has none: a null pointer of length 0.
    if (!std::equal(p.extradata, p.extradata + p.extradata_size, q.extradata, q.extradata + q.extradata_size))
        return "settings of the encoder";
    if (without_files(a.tag("beamcam-scene")) != without_files(b.tag("beamcam-scene"))) return "scenes";
    if (a.tag("beamcam-version") != b.tag("beamcam-version")) return "versions of beamcam";
    return {};
}

BeamcamVideoStatus check_order(const std::vector<Segment>& segments, BeamcamVideoError* error) {
    for (std::size_t i = 1; i < segments.size(); ++i) {
        const Segment &a = segments[i - 1], &b = segments[i];
        if (const std::string what = mismatch(a, b); !what.empty())
            return refuse(error, beamcam_video_differs,
                          a.name + " and " + b.name + " have different " + what + " and make no one film");
        if (a.numbered && b.numbered &&
            (a.end != b.first || a.begin_of_all != b.begin_of_all || a.end_of_all != b.end_of_all))
            return refuse(error, beamcam_video_differs,
                          a.name + " holds the frames " + a.tag("beamcam-frames") + ", " + b.name + " " +
                              b.tag("beamcam-frames") + ": name the segments in order, without gaps");
    }
    return beamcam_video_ok;
}

// The packets of one segment, moved by so many frames. The segment's own first picture is its instant 0.
BeamcamVideoStatus copy_packets(Segment& segment, BeamcamVideoSession& session, std::int64_t& frames,
                                BeamcamVideoError* error) {
    const AVRational frame = av_inv_q(segment.stream->avg_frame_rate), base = segment.stream->time_base;
    const std::int64_t shift = av_rescale_q(frames, frame, base);
    std::int64_t earliest = AV_NOPTS_VALUE;
    for (;;) {
        int code = av_read_frame(segment.format, session.packet);
        if (code == AVERROR_EOF) return beamcam_video_ok;
        if (code < 0) {
            fail(error, "reading", code);
            return refuse(error, beamcam_video_read_failed, segment.name + ": " + std::string(error->text));
        }
        // The first packet is a key picture and the first that is shown.
        if (earliest == AV_NOPTS_VALUE) earliest = session.packet->pts;
        session.packet->pts += shift - earliest;
        session.packet->dts += shift - earliest;
        session.packet->stream_index = 0;
        session.packet->pos = -1;
        av_packet_rescale_ts(session.packet, base, session.stream->time_base);
        code = av_interleaved_write_frame(session.format, session.packet);
        if (code >= 0 && session.format->pb->error < 0) code = session.format->pb->error;
        if (code < 0) return fail_to_write(error, code);
        ++frames;
    }
}

BeamcamVideoStatus start_joined(const std::vector<Segment>& segments, BeamcamVideoSession& session, const char* file,
                                const char* container, BeamcamVideoError* error) {
    const Segment &first = segments.front(), &last = segments.back();
    const std::string url = std::string("file:") + file;
    int code = avformat_alloc_output_context2(&session.format, nullptr, container, url.c_str());
    if (code < 0) return fail(error, "setting up the film", code);
    session.packet = av_packet_alloc();
    session.stream = avformat_new_stream(session.format, nullptr);
    if (session.packet == nullptr || session.stream == nullptr)
        return fail(error, "setting up the film", AVERROR(ENOMEM));
    code = avcodec_parameters_copy(session.stream->codecpar, first.stream->codecpar);
    if (code < 0) return fail(error, "setting up the film", code);
    session.stream->time_base = first.stream->time_base;
    session.stream->avg_frame_rate = first.stream->avg_frame_rate;
    session.stream->sample_aspect_ratio = first.stream->sample_aspect_ratio;
    for (const AVDictionaryEntry* entry = nullptr;
         (entry = av_dict_get(first.format->metadata, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr;) {
        const std::string key = entry->key;
        if (key == "title" || key == "comment" || (key.starts_with("beamcam-") && key != "beamcam-frames"))
            av_dict_set(&session.format->metadata, entry->key, entry->value, 0);
    }
    const bool whole =
        first.numbered && last.numbered && first.first == first.begin_of_all && last.end == last.end_of_all;
    if (first.numbered && last.numbered && !whole) {
        const std::string part = std::to_string(first.first) + ":" + std::to_string(last.end) + " of " +
                                 std::to_string(first.begin_of_all) + ":" + std::to_string(first.end_of_all);
        av_dict_set(&session.format->metadata, "beamcam-frames", part.c_str(), 0);
    }
    // As in every MP4 of the program: index first, keys of our own. Other containers know no such flags.
    constexpr const char* kOptions[] = {"movflags", "+faststart+use_metadata_tags", nullptr};
    return write_header(session, kOptions, error);
}

BeamcamVideoStatus concat(const char* const* names, const char* file, const char* container, std::int64_t* frames,
                          BeamcamVideoError* error) noexcept try {
    av_log_set_level(AV_LOG_FATAL);
    std::vector<Segment> segments;
    for (; *names != nullptr; ++names) {
        segments.emplace_back();
        if (const auto status = open_segment(*names, segments.back(), error); status != beamcam_video_ok) return status;
    }
    if (const auto status = check_order(segments, error); status != beamcam_video_ok) return status;
    BeamcamVideoSession session;
    if (const auto status = start_joined(segments, session, file, container, error); status != beamcam_video_ok)
        return status;
    *frames = 0;
    for (Segment& segment : segments)
        if (const auto status = copy_packets(segment, session, *frames, error); status != beamcam_video_ok)
            return status;
    return end_file(session, error);
} catch (const std::bad_alloc&) {
    return fail(error, "joining films", AVERROR(ENOMEM));
}

constexpr BeamcamVideoModule kModule = {
    kBeamcamVideoModuleVersion, open, make_frame, encode, hold, finish, close, concat};

}  // namespace

extern "C" __attribute__((visibility("default"))) const BeamcamVideoModule* beamcam_video_module() { return &kModule; }
