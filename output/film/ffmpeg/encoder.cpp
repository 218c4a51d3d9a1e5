// Encodes films: encoders of libavcodec, containers of libavformat.
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "output/film/encoder_recipe.hpp"
#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
}

namespace beamcam::output::ffmpeg {
namespace {

constexpr int kThreads = 4;  // with more, the bits depend on their number

struct OwnedFrame : FramePlanes {
    Owned<AVFrame> av = owned(av_frame_alloc());

    void show_planes() {
        for (int i = 0; i < 4; ++i) {
            plane[i] = av->data[i];
            stride[i] = av->linesize[i];
        }
    }
};

// Empty: unknown.
std::vector<std::string> pixel_formats_of(const AVCodec& codec) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 13, 100)
    const void* found = nullptr;
    if (avcodec_get_supported_config(nullptr, &codec, AV_CODEC_CONFIG_PIX_FORMAT, 0, &found, nullptr) < 0) return {};
    const auto* format = static_cast<const AVPixelFormat*>(found);
#else
    const AVPixelFormat* format = codec.pix_fmts;
#endif
    std::vector<std::string> out;
    for (; format != nullptr && *format != AV_PIX_FMT_NONE; ++format) out.emplace_back(av_get_pix_fmt_name(*format));
    return out;
}

const AVCodec& first_encoder(const EncoderSettings& s) {
    std::vector<AvailableEncoder> available;
    for (const std::string& name : s.encoders)
        if (const AVCodec* codec = avcodec_find_encoder_by_name(name.c_str()))
            available.push_back({name, pixel_formats_of(*codec)});
    const AvailableEncoder* chosen = chosen_encoder(s.encoders, s.pixel_format, available);
    if (chosen == nullptr) throw MissingCodec(s.missing);
    return *avcodec_find_encoder_by_name(chosen->name.c_str());
}

bool is_yuv(AVPixelFormat format) {
    const AVPixFmtDescriptor* d = av_pix_fmt_desc_get(format);
    return d != nullptr && (d->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) == 0;
}

class FfmpegEncoder : public Encoder {
  public:
    explicit FfmpegEncoder(const EncoderSettings& s)
        : encoder_(first_encoder(s)), file_(s.file, s.named, s.container), settings_(s) {
        describe_pictures();
        open_codec();
        open_file();
    }
    ~FfmpegEncoder() override { run_dry(); }
    FfmpegEncoder(const FfmpegEncoder&) = delete;
    FfmpegEncoder& operator=(const FfmpegEncoder&) = delete;

    FramePlanes& make_frame() override {
        auto frame = std::make_unique<OwnedFrame>();
        frame->av->format = codec_->pix_fmt;
        frame->av->width = codec_->width;
        frame->av->height = codec_->height;
        // ProRes uses the tags of its frames, not those of the encoder.
        frame->av->color_primaries = codec_->color_primaries;
        frame->av->color_trc = codec_->color_trc;
        frame->av->colorspace = codec_->colorspace;
        frame->av->color_range = codec_->color_range;
        if (const int code = av_frame_get_buffer(frame->av.get(), 0); code < 0) fail("making a frame", code);
        if (settings_.palette) std::memcpy(frame->av->data[1], settings_.palette->data(), 1024);
        frame->show_planes();
        frames_.push_back(std::move(frame));
        return *frames_.back();
    }

    void encode(FramePlanes& planes) override {
        auto& frame = static_cast<OwnedFrame&>(planes);
        frame.av->pts = next_frame_++;
        int code = avcodec_send_frame(codec_.get(), frame.av.get());
        if (code < 0) fail("encoding", code);
        drain();
        // x264 has copied the picture; an encoder that still reads it keeps the old buffer.
        code = av_frame_make_writable(frame.av.get());
        if (code < 0) fail("encoding", code);
        frame.show_planes();
    }

    void hold(std::int64_t frames) override { next_frame_ += frames; }

    void finish() override {
        if (const int code = avcodec_send_frame(codec_.get(), nullptr); code < 0) fail("encoding", code);
        drain();
        ended_ = true;
        file_.end();
    }

  private:
    void describe_pictures() {
        codec_->width = settings_.width;
        codec_->height = settings_.height;
        codec_->time_base = {settings_.fps.denominator, settings_.fps.numerator};
        codec_->framerate = {settings_.fps.numerator, settings_.fps.denominator};
        codec_->sample_aspect_ratio = {1, 1};
        codec_->pix_fmt = av_get_pix_fmt(settings_.pixel_format.c_str());
        if (encoder_.id == AV_CODEC_ID_HEVC)
            codec_->codec_tag = MKTAG('h', 'v', 'c', '1');  // required by Apple's players
        if (!is_yuv(codec_->pix_fmt)) return;
        codec_->color_primaries = AVCOL_PRI_BT709;
        codec_->color_trc = AVCOL_TRC_BT709;
        codec_->colorspace = AVCOL_SPC_BT709;
        codec_->color_range = AVCOL_RANGE_MPEG;
        codec_->chroma_sample_location = AVCHROMA_LOC_CENTER;
    }

    void open_codec() {
        codec_->thread_count = kThreads;
        if ((file_.format().oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        AVDictionary* options = nullptr;
        add_options(&options, settings_.encoder_options, encoder_.name);
        int code = avcodec_open2(codec_.get(), &encoder_, &options);
        if (code >= 0 && av_dict_count(options) > 0) code = AVERROR_OPTION_NOT_FOUND;
        av_dict_free(&options);
        if (code == AVERROR(ENOTSUP)) throw MissingCodec(settings_.missing);  // a libx265 without alpha
        if (code < 0) fail("opening the encoder", code);
    }

    void open_file() {
        AVStream& stream = file_.stream();
        stream.time_base = codec_->time_base;
        stream.avg_frame_rate = codec_->framerate;
        stream.sample_aspect_ratio = {1, 1};
        const int code = avcodec_parameters_from_context(stream.codecpar, codec_.get());
        if (code < 0) fail("setting up the film", code);
        for (const auto& [key, value] : settings_.metadata) file_.set_tag(key, value);
        file_.set_chapters(settings_.chapters);
        file_.set_subtitles(settings_.subtitles, settings_.subtitle_language);
        file_.write_header(settings_.container_options);
    }

    // Writes the finished packets of the encoder to the file.
    void drain() {
        for (;;) {
            const int code = avcodec_receive_packet(codec_.get(), packet_.get());
            if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
            if (code < 0) fail("encoding", code);
            packet_->stream_index = file_.stream().index;
            // libx264 omits it, and the last frame would have no duration. An animated WebP is one packet.
            if (packet_->duration == 0) packet_->duration = 1;
            av_packet_rescale_ts(packet_.get(), codec_->time_base, file_.stream().time_base);
            file_.write(*packet_);
        }
    }

    // SVT-AV1 waits forever if it is closed before it has received a picture and the end of the film: sends them and
    // drops the packets.
    void run_dry() noexcept {
        if (!codec_ || !avcodec_is_open(codec_.get()) || ended_ || std::strcmp(encoder_.name, "libsvtav1") != 0) return;
        if (next_frame_ == 0) {
            const Owned<AVFrame> blank(av_frame_alloc());
            if (!blank) return;
            blank->format = codec_->pix_fmt;
            blank->width = codec_->width;
            blank->height = codec_->height;
            blank->pts = 0;
            if (av_frame_get_buffer(blank.get(), 0) >= 0) avcodec_send_frame(codec_.get(), blank.get());
        }
        avcodec_send_frame(codec_.get(), nullptr);
        while (avcodec_receive_packet(codec_.get(), packet_.get()) >= 0) av_packet_unref(packet_.get());
    }

    const AVCodec& encoder_;
    OutputFile file_;
    EncoderSettings settings_;
    Owned<AVPacket> packet_ = owned(av_packet_alloc());
    Owned<AVCodecContext> codec_ = owned(avcodec_alloc_context3(&encoder_));
    std::vector<std::unique_ptr<OwnedFrame>> frames_;
    std::int64_t next_frame_ = 0;
    bool ended_ = false;  // all packets are written
};

}  // namespace

std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings) {
    return std::make_unique<FfmpegEncoder>(settings);
}

}  // namespace beamcam::output::ffmpeg
