// Functions that the files of this module share: FFmpeg's errors as exceptions, input and output files.
#pragma once

#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "output/film/video_library.hpp"

struct AVCodecContext;
struct AVDictionary;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct AVStream;

namespace beamcam::output::ffmpeg {

// Objects of FFmpeg. Throws std::bad_alloc for a null pointer.
struct Free {
    void operator()(AVPacket* packet) const;
    void operator()(AVFrame* frame) const;
    void operator()(AVCodecContext* codec) const;
};
template <class Object>
using Owned = std::unique_ptr<Object, Free>;
template <class Object>
Owned<Object> owned(Object* made) {
    if (made == nullptr) throw std::bad_alloc();
    return Owned<Object>(made);
}

// FFmpeg's message for a negative status.
std::string reason(int code);

// Throws std::bad_alloc if memory is short, else CodecFailure "doing: reason".
[[noreturn]] void fail(const char* doing, int code);

// A film or picture, opened for reading. Only containers of pictures are recognized, and only this file is read: play
// lists, scripts and names with patterns could open other files or addresses.
class InputFile {
  public:
    // Throws IoError.
    explicit InputFile(const std::filesystem::path& file);
    ~InputFile();
    InputFile(InputFile&& other) noexcept;
    InputFile& operator=(InputFile&&) = delete;

    AVFormatContext& format() const { return *format_; }
    const std::filesystem::path& file() const { return file_; }
    std::string tag(const char* key) const;                     // of its metadata; empty when there is none
    [[noreturn]] void refuse(const std::string& why) const;     // IoError with the file's name
    [[noreturn]] void refuse(const char* why, int code) const;  // the same with FFmpeg's reason

  private:
    std::filesystem::path file_;
    AVFormatContext* format_ = nullptr;
};

// Frames that a part of a film contains: first ≤ n < end, of those of the whole film. From the tag "beamcam-frames".
struct FrameRange {
    long first = 0, end = 0, begin_of_all = 0, end_of_all = 0;
    long count() const { return end - first; }
};
std::optional<FrameRange> frame_range(const InputFile& file);

// The number of frames that the file states for this stream; 0: not stated.
long declared_frames(const InputFile& file, const AVStream& stream);

constexpr const char* kDamaged = "the film is damaged or cut off; make or copy it again";

// Whether a Matroska or WebM file (RFC 8794, RFC 9559) ends before its segment; FFmpeg does not report this.
bool is_cut_matroska(const std::filesystem::path& file);

// The other files of the module.
std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings);
std::unique_ptr<Decoder> open_decoder(const std::filesystem::path& file);
std::int64_t concatenate(const std::vector<std::filesystem::path>& segments, const std::filesystem::path& file,
                         const std::filesystem::path& named, const std::string& container);

// A film that is being written: a container with one stream of pictures and, if there are subtitles, one of these.
class OutputFile {
  public:
    // `named`: its name in messages.
    OutputFile(const std::filesystem::path& file, std::filesystem::path named, const std::string& container);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    AVFormatContext& format() const { return *format_; }
    AVStream& stream() const { return *stream_; }
    void set_tag(const std::string& key, const std::string& value);
    void set_chapters(const std::vector<Chapter>& chapters);
    void set_subtitles(const std::vector<Chapter>& texts, const std::string& language);  // before the header
    void write_header(const OptionList& options);
    void write(AVPacket& packet);  // of the stream's time base; after the subtitles that begin until then
    void end();

  private:
    [[noreturn]] void fail_to_write(int code) const;
    void write_packet(AVPacket& packet);
    void write_subtitles(double until);

    std::filesystem::path named_;
    AVFormatContext* format_ = nullptr;
    AVStream *stream_ = nullptr, *subtitles_ = nullptr;
    std::vector<Chapter> texts_;  // not yet written ones from next_text_ on
    std::size_t next_text_ = 0;
};

// Adds to a dictionary; keys of the form "name:key" are for the encoder of that name alone.
void add_options(AVDictionary** to, const OptionList& options, const std::string& encoder);

}  // namespace beamcam::output::ffmpeg
