// Encodes films: encoders of libavcodec, containers of libavformat.
#include <algorithm>
#include <array>
#include <cerrno>
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
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace beamcam::output::ffmpeg {
namespace {

constexpr int kThreads = 4;  // with more, the bits depend on their number

using OptionList = std::vector<std::pair<std::string, std::string>>;

void add_options(AVDictionary** to, const OptionList& options) {
    for (const auto& [key, value] : options) av_dict_set(to, key.c_str(), value.c_str(), 0);
}

// FFmpeg's settings of an encoder and its container.
struct EncoderSettings {
    const char* pixel_format = "";
    PixelLayout layout = PixelLayout::yuv420;  // of that pixel format
    OptionList encoder_options = {}, container_options = {};
};

EncoderSettings settings_of(const VideoOptions& o, const std::string& ending) {
    EncoderSettings s;
    const auto pixels = [&s](const char* format, PixelLayout layout) { s.pixel_format = format, s.layout = layout; };
    const std::string crf = std::to_string(o.crf.value_or(quality_scale(o.codec).value_or(QualityScale{}).usual));
    switch (o.codec) {
        case Codec::h264:  // without cpu-independent, the rounding of x264 depends on the processor
            pixels("yuv420p", PixelLayout::yuv420);
            s.encoder_options = {{"preset", o.preset}, {"crf", crf}, {"x264-params", "cpu-independent=1"}};
            // The duration of an MP4 is that of its packets in decoding order, which must be the display order.
            if (o.variable_rate) s.encoder_options.emplace_back("bf", "0");
            break;
        case Codec::vp9:  // tile columns run on several threads; the picture does not depend on their number
            o.transparent ? pixels("yuva420p", PixelLayout::yuva420) : pixels("yuv420p", PixelLayout::yuv420);
            s.encoder_options = {
                {"crf", crf}, {"b", "0"}, {"deadline", "good"}, {"cpu-used", "4"}, {"tile-columns", "2"}};
            // Films with alpha cannot have alternative reference frames.
            if (o.transparent) s.encoder_options.emplace_back("auto-alt-ref", "0");
            break;
        case Codec::prores:
            pixels("yuva444p10le", PixelLayout::yuva444p10);
            s.encoder_options = {{"profile", "4444"}, {"vendor", "apl0"}, {"alpha_bits", o.transparent ? "16" : "0"}};
            break;
        case Codec::ffv1:
            pixels(o.transparent ? "bgra" : "bgr0", PixelLayout::bgra);
            s.encoder_options = {{"level", "3"}, {"slicecrc", "1"}, {"slices", "4"}};
            break;
        case Codec::gif:
            pixels("pal8", PixelLayout::indices);
            s.container_options = {{"loop", "0"}};
            break;
        case Codec::webp:
            pixels("bgra", PixelLayout::bgra);
            // Lossy animations keep remains of soft shadows: libwebp does not repaint what changes by a few levels.
            s.encoder_options = {{"lossless", "1"}, {"compression_level", "1"}};
            s.container_options = {{"loop", "0"}};
            break;
    }
    // faststart: the index comes first, so that players can start before they have the whole file.
    // use_metadata_tags: keeps our own keys.
    if (ending == ".mp4" || ending == ".mov")
        s.container_options.emplace_back("movflags", "+faststart+use_metadata_tags");
    return s;
}

// A film that is being written: a container with one stream of pictures.
class OutputFile {
  public:
    OutputFile(const std::filesystem::path& file, std::filesystem::path named) : named_(std::move(named)) {
        const AVOutputFormat* container = av_guess_format(nullptr, named_.c_str(), nullptr);  // by the ending
        const int code = avformat_alloc_output_context2(&format_, container, nullptr, url_of(file).c_str());
        if (code < 0) fail("setting up the film", code);
        stream_ = avformat_new_stream(format_, nullptr);
        if (stream_ == nullptr) {
            avformat_free_context(format_);
            throw std::bad_alloc();
        }
    }
    ~OutputFile() {
        avio_closep(&format_->pb);
        avformat_free_context(format_);
    }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    AVFormatContext& format() const { return *format_; }
    AVStream& stream() const { return *stream_; }

    void write_header(const OptionList& options) {
        require(avio_open(&format_->pb, format_->url, AVIO_FLAG_WRITE));
        format_->flags |= AVFMT_FLAG_BITEXACT;  // no library version, no date
        AVDictionary* dictionary = nullptr;
        add_options(&dictionary, options);
        const int code = avformat_write_header(format_, &dictionary);
        av_dict_free(&dictionary);
        require(code);
    }
    void write(AVPacket& packet) {  // of the stream's time base
        const int code = av_interleaved_write_frame(format_, &packet);
        require(code >= 0 ? std::min(format_->pb->error, 0) : code);
    }
    // The muxer of GIF reads this option when it ends [time base of the stream]; by default the last picture would last
    // as long as the one before.
    void set_last_delay(std::int64_t delay) { av_opt_set_int(format_->priv_data, "final_delay", delay, 0); }
    void end() {
        const int code = av_write_trailer(format_), error = format_->pb->error;
        const int closed = avio_closep(&format_->pb);
        for (const int each : {code, error, closed}) require(each);
    }

  private:
    void require(int code) const {
        if (code >= 0) return;
        if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
        const int error_number = AVUNERROR(code);
        throw write_error(named_, error_number > 0 ? error_number : EIO);
    }

    std::filesystem::path named_;
    AVFormatContext* format_ = nullptr;
    AVStream* stream_ = nullptr;
};

struct OwnedFrame : FramePlanes {
    Owned<AVFrame> av = owned(av_frame_alloc());

    void show_planes() {
        for (int i = 0; i < 4; ++i) {
            plane[i] = av->data[i];
            stride[i] = av->linesize[i];
        }
    }
};

const AVCodec& encoder_of(Codec codec) {
    if (const AVCodec* found = avcodec_find_encoder_by_name(encoder_name(codec))) return *found;
    throw MissingCodec(std::string("the FFmpeg libraries on this machine have no ") + title(codec) + " encoder (" +
                       encoder_name(codec) +
                       "); install the distribution's full build of libavcodec, or choose another codec");
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
    FfmpegEncoder(const VideoOptions& options, const std::filesystem::path& file, const std::filesystem::path& named)
        : options_(options),
          settings_(settings_of(options, named.extension().string())),
          encoder_(encoder_of(options.codec)),
          file_(file, named) {
        describe_pictures();
        open_codec();
        open_file();
    }

    PixelLayout layout() const override { return settings_.layout; }

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
        if (settings_.layout == PixelLayout::indices) {
            std::array<std::uint32_t, 256> palette;
            palette.fill(0xff000000U);
            std::ranges::copy(options_.palette, palette.begin());
            std::memcpy(frame->av->data[1], palette.data(), sizeof palette);
        }
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
        codec_->width = options_.width;
        codec_->height = options_.height;
        codec_->time_base = {options_.fps.denominator, options_.fps.numerator};
        codec_->framerate = {options_.fps.numerator, options_.fps.denominator};
        codec_->sample_aspect_ratio = {1, 1};
        codec_->pix_fmt = av_get_pix_fmt(settings_.pixel_format);
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
        for (const auto& [key, value] : options_.metadata)
            av_dict_set(&file_.format().metadata, key.c_str(), value.c_str(), 0);
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

    const VideoOptions options_;
    const EncoderSettings settings_;
    const AVCodec& encoder_;
    OutputFile file_;
    Owned<AVPacket> packet_ = owned(av_packet_alloc());
    Owned<AVCodecContext> codec_ = owned(avcodec_alloc_context3(&encoder_));
    std::vector<std::unique_ptr<OwnedFrame>> frames_;
    std::int64_t next_frame_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> open_encoder(const VideoOptions& options, const std::filesystem::path& file,
                                      const std::filesystem::path& named) {
    return std::make_unique<FfmpegEncoder>(options, file, named);
}

}  // namespace beamcam::output::ffmpeg
