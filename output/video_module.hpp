// The plain C door between the program and the module that links FFmpeg (beamcam_video.so). The module is
// loaded when a film is really wanted, because linking libav* costs 24 ms of every start.
//
// Neither exceptions nor C++ objects pass through it. Every function that can fail returns a status and
// leaves a message in words in `error`.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

enum BeamcamVideoStatus {
    beamcam_video_ok = 0,
    beamcam_video_missing_codec = 1,
    beamcam_video_write_failed = 2,  // `error_number` holds errno
    beamcam_video_failed = 3,
    beamcam_video_read_failed = 4,
    beamcam_video_differs = 5
};

struct BeamcamVideoError {
    int error_number;
    char text[512];
};

struct BeamcamVideoSettings {
    const char* file;     // exists; it is overwritten
    int width, height;    // [px]
    int rate, rate_base;  // frames per second = rate / rate_base
    int threads;
    const char* container;                 // FFmpeg's name of the muxer
    const char* const* encoders;           // FFmpeg's names, the first that exists is taken; null ends them
    const char* pixel_format;              // FFmpeg's name
    const char* const* encoder_options;    // key, value, …, null; keys "x:name" are for encoder x alone
    const char* const* container_options;  // key, value, …, null
    const char* missing;                   // what to say when there is none of these encoders
    const std::uint32_t* palette;          // 256 times 0xAARRGGBB for "pal8"; else null
    const char* const* metadata;           // key, value, key, value, …, null
};

// A picture to be filled by the caller: the planes of its pixel format, those that it has.
struct BeamcamVideoFrame {
    std::uint8_t* plane[4];
    std::ptrdiff_t stride[4];  // [bytes]
};

struct BeamcamVideoSession;

struct BeamcamVideoModule {
    int version;  // kBeamcamVideoModuleVersion of the module
    BeamcamVideoStatus (*open)(const BeamcamVideoSettings*, BeamcamVideoSession**, BeamcamVideoError*);
    // A frame of the session's own, freed with it; null when memory is short. Any thread, one at a time.
    BeamcamVideoFrame* (*make_frame)(BeamcamVideoSession*);
    // Adds the frame to the film; the caller may change it again as soon as this returns.
    BeamcamVideoStatus (*encode)(BeamcamVideoSession*, BeamcamVideoFrame*, BeamcamVideoError*);
    // The frame added last is shown for so many frames' time more.
    void (*hold)(BeamcamVideoSession*, std::int64_t frames);
    BeamcamVideoStatus (*finish)(BeamcamVideoSession*, BeamcamVideoError*);
    void (*close)(BeamcamVideoSession*);  // finished or not
    // One film out of several, packets as they are. `segments`: file names, null. `file` exists; it is overwritten.
    // What does not fit together is `beamcam_video_differs`. Fills in how many frames there are.
    BeamcamVideoStatus (*concat)(const char* const* segments, const char* file, const char* container,
                                 std::int64_t* frames, BeamcamVideoError*);
};

// The one symbol of the module.
const BeamcamVideoModule* beamcam_video_module();
}

constexpr int kBeamcamVideoModuleVersion = 4;
