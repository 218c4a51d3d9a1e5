// The other file that sees FFmpeg: from films to pixels through libavformat, libavcodec and libswscale.
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "output/video_reader_module.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

struct BeamcamVideoReader {
    AVFormatContext* format = nullptr;
    AVCodecContext* codec = nullptr;
    AVPacket* packet = nullptr;
    AVFrame* frame = nullptr;
    SwsContext* scaler = nullptr;
    AVPixelFormat scaler_from = AV_PIX_FMT_NONE;
    int stream = -1;
    bool drained = false;                    // the decoder was told that nothing more comes
    std::int64_t last_end = AV_NOPTS_VALUE;  // of the latest frame, in the stream's time base
    std::vector<std::string> words;
    std::vector<const char*> metadata;

    ~BeamcamVideoReader() {
        sws_freeContext(scaler);
        av_frame_free(&frame);
        av_packet_free(&packet);
        avcodec_free_context(&codec);
        avformat_close_input(&format);
    }
};

namespace {

// Containers of moving pictures. Play lists and the like, which would open further files or addresses, are not among
// them.
constexpr const char* kContainers =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,gif,apng,avi,mpegts,nut,flv,ogg,ivf,h264,hevc,"
    "yuv4mpegpipe,png_pipe,webp_pipe,jpeg_pipe,bmp_pipe,tiff_pipe,image2";

// What digests are defined by; see video_reader.hpp.
constexpr int kScaling = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT;

BeamcamVideoStatus fail(BeamcamVideoError* error, const char* what, int code) {
    char reason[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(code, reason, sizeof reason);
    std::snprintf(error->text, sizeof error->text, "%s (FFmpeg: %s)", what, reason);
    error->error_number = AVUNERROR(code);
    return beamcam_video_failed;
}

BeamcamVideoStatus refuse(BeamcamVideoError* error, const std::string& what) {
    std::snprintf(error->text, sizeof error->text, "%s", what.c_str());
    error->error_number = 0;
    return beamcam_video_failed;
}

constexpr const char* kDamaged = "the film is damaged or cut off; make or copy it again";

BeamcamVideoStatus open_format(BeamcamVideoReader& r, const char* file, BeamcamVideoError* error) {
    r.format = avformat_alloc_context();
    if (r.format == nullptr) return fail(error, "opening", AVERROR(ENOMEM));
    r.format->format_whitelist = av_strdup(kContainers);
    r.format->protocol_whitelist = av_strdup("file");
    const std::string url = std::string("file:") + file;  // keeps FFmpeg from reading a protocol into "a:b.mp4"
    int code = avformat_open_input(&r.format, url.c_str(), nullptr, nullptr);
    if (code == AVERROR_INVALIDDATA || code == AVERROR(EINVAL))
        return fail(error, "it is no film or picture that FFmpeg knows, or it is damaged at its beginning", code);
    if (code < 0) {
        char reason[AV_ERROR_MAX_STRING_SIZE] = "";
        av_strerror(code, reason, sizeof reason);
        return refuse(error, reason);
    }
    code = avformat_find_stream_info(r.format, nullptr);
    if (code < 0) return fail(error, kDamaged, code);
    r.stream = av_find_best_stream(r.format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (r.stream < 0) return refuse(error, "there are no pictures in it");
    return beamcam_video_ok;
}

BeamcamVideoStatus open_codec(BeamcamVideoReader& r, BeamcamVideoError* error) {
    const AVCodecParameters* parameters = r.format->streams[r.stream]->codecpar;
    // FFmpeg's own VP8 and VP9 decoders do not know transparency, which libvpx does.
    const AVCodec* decoder = avcodec_find_decoder(parameters->codec_id);
    if (decoder == nullptr) {
        std::snprintf(error->text, sizeof error->text,
                      "the FFmpeg libraries on this machine have no decoder for %s; install the distribution's full "
                      "build of libavcodec",
                      avcodec_get_name(parameters->codec_id));
        return beamcam_video_missing_codec;
    }
    r.codec = avcodec_alloc_context3(decoder);
    r.packet = av_packet_alloc();
    r.frame = av_frame_alloc();
    if (r.codec == nullptr || r.packet == nullptr || r.frame == nullptr) return fail(error, "opening", AVERROR(ENOMEM));
    int code = avcodec_parameters_to_context(r.codec, parameters);
    if (code < 0) return fail(error, kDamaged, code);
    r.codec->thread_count = 0;  // as many as there are cores
    // A damaged picture is an error, not a guess.
    r.codec->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    r.codec->error_concealment = 0;
    r.codec->flags |= AV_CODEC_FLAG_BITEXACT;
    code = avcodec_open2(r.codec, decoder, nullptr);
    if (code < 0) return fail(error, "its decoder cannot be opened", code);
    if (r.codec->width <= 0 || r.codec->height <= 0)
        return refuse(error, parameters->codec_id == AV_CODEC_ID_WEBP
                                 ? "FFmpeg does not decode animated WebP; an .apng of the same film can be read"
                                 : "it has pictures of no size");
    return beamcam_video_ok;
}

void collect_metadata(BeamcamVideoReader& r) {
    for (const AVDictionary* some : {r.format->metadata, r.format->streams[r.stream]->metadata}) {
        const AVDictionaryEntry* entry = nullptr;
        while ((entry = av_dict_get(some, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
            r.words.emplace_back(entry->key);
            r.words.emplace_back(entry->value);
        }
    }
    for (const std::string& word : r.words) r.metadata.push_back(word.c_str());
    r.metadata.push_back(nullptr);
}

void fill(BeamcamVideoFacts& facts, const BeamcamVideoReader& r) {
    const AVStream* stream = r.format->streams[r.stream];
    facts.width = r.codec->width;
    facts.height = r.codec->height;
    facts.frames = stream->nb_frames;
    facts.seconds = r.format->duration > 0 ? static_cast<double>(r.format->duration) / AV_TIME_BASE : 0;
    std::snprintf(facts.codec, sizeof facts.codec, "%s", avcodec_get_name(stream->codecpar->codec_id));
    std::snprintf(facts.container, sizeof facts.container, "%s", r.format->iformat->name);
    facts.metadata = r.metadata.data();
}

// The converter that FFmpeg's own filter "scale" sets up for this frame.
BeamcamVideoStatus prepare_scaler(BeamcamVideoReader& r, BeamcamVideoError* error) {
    const auto from = static_cast<AVPixelFormat>(r.frame->format);
    if (r.scaler != nullptr && from == r.scaler_from) return beamcam_video_ok;
    sws_freeContext(r.scaler);
    r.scaler = sws_alloc_context();
    r.scaler_from = from;
    if (r.scaler == nullptr) return fail(error, "converting", AVERROR(ENOMEM));
    const struct {
        const char* name;
        std::int64_t value;
    } options[] = {{"srcw", r.frame->width}, {"srch", r.frame->height}, {"src_format", from},
                   {"dstw", r.frame->width}, {"dsth", r.frame->height}, {"dst_format", AV_PIX_FMT_RGBA},
                   {"sws_flags", kScaling}};
    for (const auto& option : options) av_opt_set_int(r.scaler, option.name, option.value, 0);
    if (from == AV_PIX_FMT_YUV420P) av_opt_set_int(r.scaler, "src_v_chr_pos", 128, 0);
    const int* const matrix = sws_getCoefficients(r.frame->colorspace);
    const bool full = r.frame->color_range == AVCOL_RANGE_JPEG;
    sws_setColorspaceDetails(r.scaler, matrix, full, matrix, 0, 0, 1 << 16, 1 << 16);
    const int code = sws_init_context(r.scaler, nullptr, nullptr);
    return code < 0 ? fail(error, "its kind of pixels cannot be converted", code) : beamcam_video_ok;
}

BeamcamVideoStatus convert(BeamcamVideoReader& r, std::uint8_t* rgba, BeamcamVideoError* error) {
    const AVFrame& f = *r.frame;
    if (f.width != r.codec->width || f.height != r.codec->height)
        return refuse(error, "its pictures change their size");
    if ((f.flags & AV_FRAME_FLAG_CORRUPT) != 0 || f.decode_error_flags != 0) return refuse(error, kDamaged);
    if (const auto status = prepare_scaler(r, error); status != beamcam_video_ok) return status;
    std::uint8_t* const to[4] = {rgba, nullptr, nullptr, nullptr};
    const int stride[4] = {4 * f.width, 0, 0, 0};
    const int rows = sws_scale(r.scaler, f.data, f.linesize, 0, f.height, to, stride);
    return rows == f.height ? beamcam_video_ok : refuse(error, "its kind of pixels cannot be converted");
}

// Gives the decoder the next packet of the film, or word that there is none.
BeamcamVideoStatus feed(BeamcamVideoReader& r, BeamcamVideoError* error) {
    for (;;) {
        int code = av_read_frame(r.format, r.packet);
        if (code == AVERROR_EOF) {
            if (r.format->pb != nullptr && r.format->pb->error < 0)
                return fail(error, "reading failed", r.format->pb->error);
            r.drained = true;
            code = avcodec_send_packet(r.codec, nullptr);
            return code < 0 && code != AVERROR_EOF ? fail(error, kDamaged, code) : beamcam_video_ok;
        }
        if (code < 0) return fail(error, kDamaged, code);
        if (r.packet->stream_index != r.stream) {
            av_packet_unref(r.packet);
            continue;
        }
        if ((r.packet->flags & AV_PKT_FLAG_CORRUPT) != 0) return refuse(error, kDamaged);
        code = avcodec_send_packet(r.codec, r.packet);
        av_packet_unref(r.packet);
        return code < 0 ? fail(error, kDamaged, code) : beamcam_video_ok;
    }
}

// ---- the functions behind the door -------------------------------------------------------------

BeamcamVideoStatus open(const char* file, BeamcamVideoReader** reader, BeamcamVideoFacts* facts,
                        BeamcamVideoError* error) noexcept try {
    av_log_set_level(AV_LOG_FATAL);  // messages reach the user through `error`
    auto opened = std::make_unique<BeamcamVideoReader>();
    if (const auto status = open_format(*opened, file, error); status != beamcam_video_ok) return status;
    if (const auto status = open_codec(*opened, error); status != beamcam_video_ok) return status;
    collect_metadata(*opened);
    fill(*facts, *opened);
    *reader = opened.release();
    return beamcam_video_ok;
} catch (const std::bad_alloc&) {
    return fail(error, "opening", AVERROR(ENOMEM));
}

BeamcamVideoStatus next(BeamcamVideoReader* reader, std::uint8_t* rgba, int* got, BeamcamVideoError* error) noexcept
    try {
    *got = 0;
    for (;;) {
        const int code = avcodec_receive_frame(reader->codec, reader->frame);
        if (code == 0) {
            *got = 1;
            const auto status = convert(*reader, rgba, error);
            av_frame_unref(reader->frame);
            return status;
        }
        if (code == AVERROR_EOF) return beamcam_video_ok;
        if (code != AVERROR(EAGAIN)) return fail(error, kDamaged, code);
        if (reader->drained) return beamcam_video_ok;
        if (const auto status = feed(*reader, error); status != beamcam_video_ok) return status;
    }
} catch (const std::bad_alloc&) {
    return fail(error, "decoding", AVERROR(ENOMEM));
}

void close(BeamcamVideoReader* reader) noexcept { delete reader; }

const char* versions() noexcept {
    static char text[128] = "";
    const auto part = [](unsigned version, int shift) { return version >> shift & 0xff; };
    const unsigned c = avcodec_version(), f = avformat_version(), s = swscale_version();
    std::snprintf(text, sizeof text, "libavcodec %u.%u.%u, libavformat %u.%u.%u, libswscale %u.%u.%u", part(c, 16),
                  part(c, 8), part(c, 0), part(f, 16), part(f, 8), part(f, 0), part(s, 16), part(s, 8), part(s, 0));
    return text;
}

int has_encoder(const char* name) noexcept { return avcodec_find_encoder_by_name(name) != nullptr ? 1 : 0; }

constexpr BeamcamVideoReaderModule kModule = {kBeamcamVideoReaderVersion, open, next, close, versions, has_encoder};

}  // namespace

extern "C" __attribute__((visibility("default"))) const BeamcamVideoReaderModule* beamcam_video_reader_module() {
    return &kModule;
}
