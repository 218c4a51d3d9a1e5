// Decodes films by libavformat, libavcodec and libswscale.
#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace beamcam::output::ffmpeg {
namespace {

// Digests depend on these flags; see video_reader.hpp.
constexpr int kScaling = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT;

class FfmpegDecoder : public Decoder {
  public:
    explicit FfmpegDecoder(const std::filesystem::path& file) : file_(file) {
        const int best = av_find_best_stream(&file_.format(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
        if (best < 0) file_.refuse("it contains no pictures");
        stream_ = file_.format().streams[best];
        open_codec();
        read_info();
    }
    ~FfmpegDecoder() override { sws_freeContext(scaler_); }
    FfmpegDecoder(const FfmpegDecoder&) = delete;
    FfmpegDecoder& operator=(const FfmpegDecoder&) = delete;

    const VideoInfo& info() const override { return info_; }

    bool next(std::uint8_t* rgba) override {
        for (;;) {
            const int code = avcodec_receive_frame(codec_.get(), frame_.get());
            if (code == 0) {
                convert(rgba);
                av_frame_unref(frame_.get());
                return true;
            }
            if (code == AVERROR_EOF) return false;
            if (code != AVERROR(EAGAIN)) file_.refuse(kDamaged, code);
            if (drained_) return false;
            feed();
        }
    }

  private:
    // FFmpeg's own decoder of VP9 ignores the second stream of pictures in which WebM stores alpha.
    bool has_alpha_apart() const {
        const AVDictionaryEntry* mode = av_dict_get(stream_->metadata, "alpha_mode", nullptr, 0);
        return stream_->codecpar->codec_id == AV_CODEC_ID_VP9 && mode != nullptr && mode->value == std::string("1");
    }
    void open_codec() {
        const AVCodecParameters* parameters = stream_->codecpar;
        const AVCodec* decoder =
            has_alpha_apart() ? avcodec_find_decoder_by_name("libvpx-vp9") : avcodec_find_decoder(parameters->codec_id);
        if (decoder == nullptr)
            throw MissingCodec("cannot read " + file_.file().string() +
                               ": the FFmpeg libraries on this machine have no decoder for " +
                               avcodec_get_name(parameters->codec_id) + (has_alpha_apart() ? " with alpha" : "") +
                               "; install the distribution's full build of libavcodec");
        codec_ = owned(avcodec_alloc_context3(decoder));
        int code = avcodec_parameters_to_context(codec_.get(), parameters);
        if (code < 0) file_.refuse(kDamaged, code);
        codec_->thread_count = 0;  // one for each core
        // A damaged picture is an error.
        codec_->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
        codec_->error_concealment = 0;
        codec_->flags |= AV_CODEC_FLAG_BITEXACT;
        code = avcodec_open2(codec_.get(), decoder, nullptr);
        if (code < 0) file_.refuse("its decoder cannot be opened", code);
        if (codec_->width <= 0 || codec_->height <= 0)
            file_.refuse(parameters->codec_id == AV_CODEC_ID_WEBP
                             ? "FFmpeg does not decode animated WebP; an .apng of the same film can be read"
                             : "its pictures have no size");
    }

    void read_info() {
        info_.width = codec_->width;
        info_.height = codec_->height;
        info_.frames = std::max(0L, declared_frames(file_, *stream_));
        const std::int64_t duration = file_.format().duration;
        info_.seconds = duration > 0 ? static_cast<double>(duration) / AV_TIME_BASE : 0;
        info_.codec = avcodec_get_name(stream_->codecpar->codec_id);
        info_.container = file_.format().iformat->name;
        for (const AVDictionary* some : {file_.format().metadata, stream_->metadata}) {
            const AVDictionaryEntry* entry = nullptr;
            while ((entry = av_dict_get(some, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr)
                info_.metadata[entry->key] = entry->value;
        }
    }

    // Passes the next packet of the film, or its end, to the decoder.
    void feed() {
        for (;;) {
            int code = av_read_frame(&file_.format(), packet_.get());
            if (code == AVERROR_EOF) {
                const AVIOContext* io = file_.format().pb;
                if (io != nullptr && io->error < 0) file_.refuse("reading failed", io->error);
                drained_ = true;
                code = avcodec_send_packet(codec_.get(), nullptr);
                if (code < 0 && code != AVERROR_EOF) file_.refuse(kDamaged, code);
                return;
            }
            if (code < 0) file_.refuse(kDamaged, code);
            if (packet_->stream_index != stream_->index) {
                av_packet_unref(packet_.get());
                continue;
            }
            if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) file_.refuse(kDamaged);
            code = avcodec_send_packet(codec_.get(), packet_.get());
            av_packet_unref(packet_.get());
            if (code < 0) file_.refuse(kDamaged, code);
            return;
        }
    }

    // The converter as FFmpeg's filter "scale" configures it for this frame.
    void prepare_scaler() {
        const auto from = static_cast<AVPixelFormat>(frame_->format);
        if (scaler_ != nullptr && from == scaler_from_) return;
        sws_freeContext(scaler_);
        scaler_ = sws_alloc_context();
        scaler_from_ = from;
        if (scaler_ == nullptr) throw std::bad_alloc();
        const std::pair<const char*, std::int64_t> options[] = {
            {"srcw", frame_->width},  {"srch", frame_->height},        {"src_format", from},   {"dstw", frame_->width},
            {"dsth", frame_->height}, {"dst_format", AV_PIX_FMT_RGBA}, {"sws_flags", kScaling}};
        for (const auto& [name, value] : options) av_opt_set_int(scaler_, name, value, 0);
        if (from == AV_PIX_FMT_YUV420P) av_opt_set_int(scaler_, "src_v_chr_pos", 128, 0);
        // Between 16 and 8 bits swscale converts RGB through YUV, which AVCOL_SPC_RGB does not define.
        const bool rgb = frame_->colorspace == AVCOL_SPC_RGB;
        const int* const matrix = sws_getCoefficients(rgb ? SWS_CS_DEFAULT : static_cast<int>(frame_->colorspace));
        const bool full = frame_->color_range == AVCOL_RANGE_JPEG;
        sws_setColorspaceDetails(scaler_, matrix, full, matrix, 0, 0, 1 << 16, 1 << 16);
        const int code = sws_init_context(scaler_, nullptr, nullptr);
        if (code < 0) file_.refuse("its pixel format cannot be converted", code);
    }

    void convert(std::uint8_t* rgba) {
        const AVFrame& f = *frame_;
        if (f.width != info_.width || f.height != info_.height) file_.refuse("its pictures have different sizes");
        if ((f.flags & AV_FRAME_FLAG_CORRUPT) != 0 || f.decode_error_flags != 0) file_.refuse(kDamaged);
        if (rgba == nullptr) return;
        prepare_scaler();
        std::uint8_t* const to[4] = {rgba, nullptr, nullptr, nullptr};
        const int stride[4] = {4 * f.width, 0, 0, 0};
        if (sws_scale(scaler_, f.data, f.linesize, 0, f.height, to, stride) != f.height)
            file_.refuse("its pixel format cannot be converted");
    }

    InputFile file_;
    const AVStream* stream_ = nullptr;
    Owned<AVCodecContext> codec_;
    Owned<AVPacket> packet_ = owned(av_packet_alloc());
    Owned<AVFrame> frame_ = owned(av_frame_alloc());
    SwsContext* scaler_ = nullptr;
    AVPixelFormat scaler_from_ = AV_PIX_FMT_NONE;
    bool drained_ = false;  // the decoder has received the end of the film
    VideoInfo info_;
};

}  // namespace

std::unique_ptr<Decoder> open_decoder(const std::filesystem::path& file) {
    return std::make_unique<FfmpegDecoder>(file);
}

}  // namespace beamcam::output::ffmpeg
