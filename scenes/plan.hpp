// What a scene's outputs need, found by walking backwards from them:
// files → pictures → poses and channels → instants → a simulation, of which model, until when.
//
// Pure: a Plan is a value, made in microseconds, that run.hpp carries out. What nobody needs is not
// in it; there are no switches that turn a stage off.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "sim/simulate.hpp"

namespace beamcam::scenes {

// One run of the mechanics serves every output.
struct Simulation {
    sim::Request request;
    std::string until_because;  // the output that looks furthest: "fall.mp4"
};

// A film, a sequence or a still: the same pictures, put away differently.
struct Pictures {
    enum class Kind { video, frames, still };
    Kind kind = Kind::video;
    std::size_t output = 0;  // index into the scene's outputs
    std::string file;
    Size size;
    render::View view;
    FrameRate fps;                     // of video and frames
    Encoding encoding;                 // of video
    long first_frame = 0;              // number of the first frame; the others follow
    std::size_t poses = 0;             // index into Request::poses, whose times are the frames' instants
    std::size_t chart = 0;             // index into Request::tables: t, theta, contact_force
    std::optional<std::size_t> trace;  // t, contact_x, contact_s, contact_force; absent without a cam
};
struct TableFile {
    std::size_t output = 0;
    std::string file;
    std::size_t table = 0;  // index into Request::tables
};
struct ImpactsFile {
    std::size_t output = 0;
    std::string file;
};
struct SummaryFile {
    std::size_t output = 0;
    std::string file;
};

struct Skipped {
    std::string what, why;
};

struct Plan {
    std::optional<Simulation> simulation;
    std::vector<Pictures> pictures;
    std::vector<TableFile> tables;
    std::vector<ImpactsFile> impacts;
    std::vector<SummaryFile> summaries;
    std::vector<Skipped> skipped;

    bool needs_gl() const;       // a lit view
    bool needs_encoder() const;  // a video
    std::size_t frames() const;  // drawn altogether
};

Plan plan(const Scene& scene);

// Words of the plan: "lit", "video".
const char* view_name(const render::View& view);
const char* kind_name(Pictures::Kind kind);

// For people, and for programs.
std::string to_text(const Plan& plan, const Scene& scene);
std::string to_json(const Plan& plan, const Scene& scene);

}  // namespace beamcam::scenes
