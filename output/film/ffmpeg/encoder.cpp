// Encodes films: encoders of libavcodec, containers of libavformat.
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/intreadwrite.h>
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

const AVCodec& encoder_of(const EncoderSettings& s) {
    const AVCodec* codec = avcodec_find_encoder_by_name(s.encoder.c_str());
    if (codec == nullptr) throw MissingCodec(s.missing);
    return *codec;
}

// libwebp gives the last picture of an animation the mean duration of the others. Sets its duration such that all last
// `total` [ms]. A WebP of one picture has no durations. Layout: "RIFF", size, "WEBP", then chunks of name, size,
// content and a byte of padding for odd sizes; a chunk "ANMF" begins with five numbers of 24 bits, of which the last is
// the duration (https://developers.google.com/speed/webp/docs/riff_container).
void put_last_duration(AVPacket& packet, std::int64_t total) {
    constexpr std::size_t kFirstChunk = 12, kHead = 8, kDuration = 12;  // [bytes]
    std::uint8_t* last = nullptr;
    const auto size = static_cast<std::size_t>(packet.size);
    for (std::size_t at = kFirstChunk; at + kHead + kDuration + 3 <= size;) {
        std::uint8_t* chunk = packet.data + at;
        if (std::memcmp(chunk, "ANMF", 4) == 0) {
            if (last != nullptr) total -= AV_RL24(last);
            last = chunk + kHead + kDuration;
        }
        const std::size_t content = AV_RL32(chunk + 4);
        at += kHead + content + content % 2;
    }
    if (last != nullptr) AV_WL24(last, static_cast<std::uint32_t>(total));
}

bool is_yuv(AVPixelFormat format) {
    const AVPixFmtDescriptor* d = av_pix_fmt_desc_get(format);
    return d != nullptr && (d->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) == 0;
}

class FfmpegEncoder : public Encoder {
  public:
    explicit FfmpegEncoder(const EncoderSettings& s)
        : encoder_(encoder_of(s)), file_(s.file, s.named, s.container), settings_(s) {
        describe_pictures();
        open_codec();
        open_file();
    }

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
        if (encoder_.id == AV_CODEC_ID_GIF) file_.set_last_delay(stamp_of(next_frame_) - stamp_of(next_frame_ - 1));
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
        add_options(&options, settings_.encoder_options);
        int code = avcodec_open2(codec_.get(), &encoder_, &options);
        if (code >= 0 && av_dict_count(options) > 0) code = AVERROR_OPTION_NOT_FOUND;
        av_dict_free(&options);
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
        file_.write_header(settings_.container_options);
    }

    // The time stamp in the file at the beginning of a frame; at the end of the film for the number of frames.
    std::int64_t stamp_of(std::int64_t frame) const {
        return av_rescale_q(frame, codec_->time_base, file_.stream().time_base);
    }
    std::int64_t milliseconds() const { return av_rescale_q(next_frame_, codec_->time_base, {1, 1000}); }

    // Writes the finished packets of the encoder to the file.
    void drain() {
        for (;;) {
            const int code = avcodec_receive_packet(codec_.get(), packet_.get());
            if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
            if (code < 0) fail("encoding", code);
            packet_->stream_index = file_.stream().index;
            // libx264 omits it, and the last frame would have no duration. An animated WebP is one packet.
            if (packet_->duration == 0) packet_->duration = 1;
            if (encoder_.id == AV_CODEC_ID_WEBP) put_last_duration(*packet_, milliseconds());
            av_packet_rescale_ts(packet_.get(), codec_->time_base, file_.stream().time_base);
            file_.write(*packet_);
        }
    }

    const AVCodec& encoder_;
    OutputFile file_;
    EncoderSettings settings_;
    Owned<AVPacket> packet_ = owned(av_packet_alloc());
    Owned<AVCodecContext> codec_ = owned(avcodec_alloc_context3(&encoder_));
    std::vector<std::unique_ptr<OwnedFrame>> frames_;
    std::int64_t next_frame_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings) {
    return std::make_unique<FfmpegEncoder>(settings);
}

}  // namespace beamcam::output::ffmpeg
