// Functions that the files of this module share: FFmpeg's errors as exceptions, and the file that is written.
#pragma once

#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

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

std::unique_ptr<Encoder> open_encoder(const VideoOptions& options, const std::filesystem::path& file,
                                      const std::filesystem::path& named);

using OptionList = std::vector<std::pair<std::string, std::string>>;

// A film that is being written: a container with one stream of pictures.
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
    void write_header(const OptionList& options);
    void write(AVPacket& packet);             // of the stream's time base
    void set_last_delay(std::int64_t delay);  // of a GIF: of its last picture, in the time base of the stream
    void end();

  private:
    [[noreturn]] void fail_to_write(int code) const;

    std::filesystem::path named_;
    AVFormatContext* format_ = nullptr;
    AVStream* stream_ = nullptr;
};

void add_options(AVDictionary** to, const OptionList& options);

}  // namespace beamcam::output::ffmpeg
