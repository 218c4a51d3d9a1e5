// Functions that the files of this module share: FFmpeg's objects, and its errors as exceptions.
#pragma once

#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "output/film/video_library.hpp"

struct AVCodecContext;
struct AVFrame;
struct AVPacket;

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

std::string url_of(const std::filesystem::path& file);

// FFmpeg's message for a negative status.
std::string reason(int code);

// Throws std::bad_alloc if memory is short, else CodecFailure "doing: reason".
[[noreturn]] void fail(const char* doing, int code);

std::unique_ptr<Encoder> open_encoder(const VideoOptions& options, const std::filesystem::path& file,
                                      const std::filesystem::path& named);

}  // namespace beamcam::output::ffmpeg
