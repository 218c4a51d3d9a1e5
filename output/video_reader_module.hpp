// The second door into the module that links FFmpeg (beamcam_video.so): films as pixels. As in video_module.hpp neither
// exceptions nor C++ objects pass through it.
#pragma once

#include <cstdint>

#include "output/video_module.hpp"

extern "C" {

struct BeamcamVideoReader;

struct BeamcamVideoFacts {
    int width, height;            // [px]
    long long frames;             // as the file says, 0 when it does not
    double seconds;               // as the file says, 0 when it does not
    char codec[32];               // FFmpeg's name: "h264"
    char container[64];           // FFmpeg's name: "mov,mp4,m4a,3gp,3g2,mj2"
    const char* const* metadata;  // key, value, …, null; of the file, then of the stream; lives with the reader
};

struct BeamcamVideoReaderModule {
    int version;  // kBeamcamVideoReaderVersion of the module
    BeamcamVideoStatus (*open)(const char* file, BeamcamVideoReader**, BeamcamVideoFacts*, BeamcamVideoError*);
    // The next picture as 4·width·height bytes R, G, B, A. `*got` is 0 after the last one.
    BeamcamVideoStatus (*next)(BeamcamVideoReader*, std::uint8_t* rgba, int* got, BeamcamVideoError*);
    void (*close)(BeamcamVideoReader*);
    const char* (*versions)();             // of the libraries, in words
    int (*has_encoder)(const char* name);  // by FFmpeg's name
};

const BeamcamVideoReaderModule* beamcam_video_reader_module();
}

constexpr int kBeamcamVideoReaderVersion = 1;
