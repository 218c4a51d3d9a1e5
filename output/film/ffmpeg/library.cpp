// The entry of the module, and functions that its files share (library.hpp). libavformat and libavcodec 59 to 61
// (FFmpeg 5 to 7).
#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <new>
#include <utility>

#include "render/base/modules.hpp"

namespace beamcam::output::ffmpeg {
namespace {

// Containers of films, and pictures other than PNG.
constexpr const char* kContainers =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,gif,apng,avi,mpegts,nut,flv,ogg,ivf,h264,hevc,"
    "yuv4mpegpipe,png_pipe,webp_pipe,jpeg_pipe,bmp_pipe,tiff_pipe,image2";

std::string url_of(const std::filesystem::path& file) {
    return "file:" + file.string();  // so that FFmpeg finds no protocol in names such as "a:b.mp4"
}

class Library : public VideoLibrary {
  public:
    Library() { av_log_set_level(AV_LOG_QUIET); }  // errors are exceptions
    std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings) const override {
        return ffmpeg::open_encoder(settings);
    }
    std::unique_ptr<Decoder> open_decoder(const std::filesystem::path& file) const override {
        return ffmpeg::open_decoder(file);
    }
    std::int64_t concatenate(const std::vector<std::filesystem::path>& segments, const std::filesystem::path& file,
                             const std::filesystem::path& named, const std::string& container) const override {
        return ffmpeg::concatenate(segments, file, named, container);
    }
    std::string versions() const override {
        const auto version = [](const char* name, unsigned number) {
            return std::string(name) + " " + std::to_string(number >> 16 & 0xff) + "." +
                   std::to_string(number >> 8 & 0xff) + "." + std::to_string(number & 0xff);
        };
        return version("libavcodec", avcodec_version()) + ", " + version("libavformat", avformat_version()) + ", " +
               version("libswscale", swscale_version());
    }
    bool has_encoder(const std::string& name) const override {
        return avcodec_find_encoder_by_name(name.c_str()) != nullptr;
    }
};

const Library kLibrary;

}  // namespace

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

void add_options(AVDictionary** to, const OptionList& options, const std::string& encoder) {
    for (const auto& [key, value] : options) {
        const std::size_t colon = key.find(':');
        if (colon == std::string::npos)
            av_dict_set(to, key.c_str(), value.c_str(), 0);
        else if (key.compare(0, colon, encoder) == 0)
            av_dict_set(to, key.c_str() + colon + 1, value.c_str(), 0);
    }
}

// ---- reading -------------------------------------------------------------------------------------

InputFile::InputFile(const std::filesystem::path& file) : file_(file) {
    format_ = avformat_alloc_context();
    if (format_ == nullptr) throw std::bad_alloc();
    format_->format_whitelist = av_strdup(kContainers);
    format_->protocol_whitelist = av_strdup("file");
    AVDictionary* options = nullptr;
    av_dict_set(&options, "pattern_type", "none", 0);  // of pictures: "%d" and "*" are literal characters
    int code = avformat_open_input(&format_, url_of(file).c_str(), nullptr, &options);  // frees it when it fails
    av_dict_free(&options);
    if (code == AVERROR_INVALIDDATA || code == AVERROR(EINVAL))
        refuse("it is not a film or picture that FFmpeg can read, or its beginning is damaged", code);
    if (code < 0) refuse(reason(code));
    const auto close = [&](const char* why, int status) {
        avformat_close_input(&format_);
        if (status < 0) refuse(why, status);
        refuse(why);
    };
    code = avformat_find_stream_info(format_, nullptr);
    if (code < 0) close(kDamaged, code);
    if (std::string_view(format_->iformat->name).starts_with("matroska") && is_cut_matroska(file)) close(kDamaged, 0);
}

InputFile::~InputFile() { avformat_close_input(&format_); }

InputFile::InputFile(InputFile&& other) noexcept
    : file_(std::move(other.file_)), format_(std::exchange(other.format_, nullptr)) {}

std::string InputFile::tag(const char* key) const {
    const AVDictionaryEntry* entry = av_dict_get(format_->metadata, key, nullptr, 0);
    return entry != nullptr ? entry->value : "";
}

void InputFile::refuse(const std::string& why) const { throw IoError("cannot read " + file_.string() + ": " + why); }

void InputFile::refuse(const char* why, int code) const {
    if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
    refuse(std::string(why) + " (FFmpeg: " + reason(code) + ")");
}

std::optional<FrameRange> frame_range(const InputFile& file) {
    FrameRange range;
    const std::string text = file.tag("beamcam-frames");
    const bool read = std::sscanf(text.c_str(), "%9ld:%9ld of %9ld:%9ld", &range.first, &range.end, &range.begin_of_all,
                                  &range.end_of_all) == 4;
    const bool sound = range.begin_of_all <= range.first && range.first < range.end && range.end <= range.end_of_all;
    return read && sound ? std::optional(range) : std::nullopt;
}

long declared_frames(const InputFile& file, const AVStream& stream) {
    if (const auto range = frame_range(file)) return range->count();
    return stream.nb_frames;
}

// ---- writing -------------------------------------------------------------------------------------

OutputFile::OutputFile(const std::filesystem::path& file, std::filesystem::path named, const std::string& container)
    : named_(std::move(named)) {
    const int code = avformat_alloc_output_context2(&format_, nullptr, container.c_str(), url_of(file).c_str());
    if (code < 0) fail("setting up the film", code);
    stream_ = avformat_new_stream(format_, nullptr);
    if (stream_ == nullptr) {
        avformat_free_context(format_);
        throw std::bad_alloc();
    }
}

OutputFile::~OutputFile() {
    avio_closep(&format_->pb);
    avformat_free_context(format_);
}

void OutputFile::fail_to_write(int code) const {
    if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
    const int error_number = AVUNERROR(code);
    throw write_error(named_, error_number > 0 ? error_number : EIO);
}

void OutputFile::set_tag(const std::string& key, const std::string& value) {
    av_dict_set(&format_->metadata, key.c_str(), value.c_str(), 0);
}

// The container frees them.
void OutputFile::set_chapters(const std::vector<Chapter>& chapters) {
    if (chapters.empty()) return;
    format_->chapters = static_cast<AVChapter**>(av_calloc(chapters.size(), sizeof(AVChapter*)));
    if (format_->chapters == nullptr) throw std::bad_alloc();
    for (const Chapter& each : chapters) {
        auto* chapter = static_cast<AVChapter*>(av_mallocz(sizeof(AVChapter)));
        if (chapter == nullptr) throw std::bad_alloc();
        format_->chapters[format_->nb_chapters++] = chapter;
        chapter->id = format_->nb_chapters;
        chapter->time_base = {1, 1000};
        chapter->start = std::llround(each.from * 1000);
        chapter->end = std::llround(each.to * 1000);
        av_dict_set(&chapter->metadata, "title", each.title.c_str(), 0);
    }
}

namespace {

// The default style of a track of MOV text (3GPP TS 26.245): white letters at the lower edge.
constexpr std::array<std::uint8_t, 48> kTextStyle{
    0, 0,  0,    0,    1,    0xFF, 0, 0, 0, 0,  0,   0,   0,   0,   0, 0, 0, 0, 0, 0,   0,   0,   0,   1,
    0, 18, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 18, 'f', 't', 'a', 'b', 0, 1, 0, 1, 5, 'S', 'e', 'r', 'i', 'f'};

AVCodecID subtitle_codec(const std::string& container) {
    if (container == "matroska") return AV_CODEC_ID_SUBRIP;
    return container == "webm" ? AV_CODEC_ID_WEBVTT : AV_CODEC_ID_MOV_TEXT;
}

}  // namespace

void OutputFile::set_subtitles(const std::vector<Chapter>& texts, const std::string& language) {
    if (texts.empty()) return;
    texts_ = texts;
    subtitles_ = avformat_new_stream(format_, nullptr);
    if (subtitles_ == nullptr) throw std::bad_alloc();
    subtitles_->time_base = {1, 1000};
    subtitles_->codecpar->codec_type = AVMEDIA_TYPE_SUBTITLE;
    subtitles_->codecpar->codec_id = subtitle_codec(format_->oformat->name);
    av_dict_set(&subtitles_->metadata, "language", language.c_str(), 0);
    if (subtitles_->codecpar->codec_id != AV_CODEC_ID_MOV_TEXT) return;
    auto* style = static_cast<std::uint8_t*>(av_mallocz(kTextStyle.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    if (style == nullptr) throw std::bad_alloc();
    std::ranges::copy(kTextStyle, style);
    subtitles_->codecpar->extradata = style;
    subtitles_->codecpar->extradata_size = static_cast<int>(kTextStyle.size());
}

void OutputFile::write_header(const OptionList& options) {
    int code = avio_open(&format_->pb, format_->url, AVIO_FLAG_WRITE);
    if (code < 0) fail_to_write(code);
    // bitexact: no library version, no date.
    format_->flags |= AVFMT_FLAG_BITEXACT;
    AVDictionary* dictionary = nullptr;
    add_options(&dictionary, options, "");
    code = avformat_write_header(format_, &dictionary);
    av_dict_free(&dictionary);
    if (code < 0) fail_to_write(code);
}

void OutputFile::write(AVPacket& packet) {
    write_subtitles(static_cast<double>(packet.dts) * av_q2d(stream_->time_base));
    write_packet(packet);
}

void OutputFile::write_subtitles(double until) {
    for (; next_text_ < texts_.size() && texts_[next_text_].from <= until; ++next_text_) {
        const Chapter& text = texts_[next_text_];
        // MOV text begins with its length.
        std::string bytes = text.title.substr(0, 0xFFFF);
        if (subtitles_->codecpar->codec_id == AV_CODEC_ID_MOV_TEXT)
            bytes.insert(bytes.begin(),
                         {static_cast<char>(bytes.size() >> 8U), static_cast<char>(bytes.size() & 0xFFU)});
        const Owned<AVPacket> packet = owned(av_packet_alloc());
        if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) throw std::bad_alloc();
        std::ranges::copy(bytes, packet->data);
        packet->stream_index = subtitles_->index;
        packet->pts = packet->dts = std::llround(text.from * 1000);
        packet->duration = std::llround(text.to * 1000) - packet->pts;
        packet->flags = AV_PKT_FLAG_KEY;
        av_packet_rescale_ts(packet.get(), {1, 1000}, subtitles_->time_base);
        write_packet(*packet);
    }
}

void OutputFile::write_packet(AVPacket& packet) {
    int code = av_interleaved_write_frame(format_, &packet);
    if (code >= 0 && format_->pb->error < 0) code = format_->pb->error;
    if (code < 0) fail_to_write(code);
}

void OutputFile::end() {
    write_subtitles(std::numeric_limits<double>::infinity());
    int code = av_write_trailer(format_);
    if (code >= 0 && format_->pb->error < 0) code = format_->pb->error;
    const int closed = avio_closep(&format_->pb);
    if (code >= 0) code = closed;
    if (code < 0) fail_to_write(code);
}

}  // namespace beamcam::output::ffmpeg

BEAMCAM_MODULE(static_cast<const beamcam::output::VideoLibrary&>(beamcam::output::ffmpeg::kLibrary))
