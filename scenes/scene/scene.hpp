// A scene with resolved defaults and SI units: plain values without reading, checks or work. FORMAT.md describes the
// keys; `reader.hpp` reads a Scene from a file.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene/measurement.hpp"
#include "scenes/scene/outputs.hpp"
#include "scenes/scene/sweep.hpp"

namespace beamcam::scenes {

std::string file_of(const Output& output);                  // of a part of a sweep: that of the part
std::string poster_file(const PictureOutput& video);        // "fall.png" beside "fall.mp4"; empty: none
std::vector<std::string> written_by(const Output& output);  // its file and its secondary files
OutputInputs inputs_of(const Output& output);
bool is_data(const Output& output);
const PictureOutput* picture_of(const Output& output, PictureOutput::Kind kind);  // null: it is none of this kind

struct Scene {
    std::string name = "scene";  // the file's name without its ending
    std::string title;
    render::Units units;  // of the labels in films
    sim::Problem problem;
    double end_time = 1.5;  // [s], > 0
    std::optional<Sweep> sweep;
    std::vector<Measurement> data;
    std::vector<Output> outputs;
    std::vector<std::string> notes;  // what is assumed where the scene says nothing; `beamcam check` prints them
    // Position of each output in the file, for messages: "fall.json:12:5"; of the default film "fall.json". Outputs of
    // commands have none.
    std::vector<std::string> output_places;

    void set_outputs(std::vector<Output> others) {
        outputs = std::move(others);
        output_places.clear();
    }
};

// The output of a scene without outputs.
PictureOutput default_film(const Scene& scene);

// The scene as JSON in the scene format with all defaults. It reads back to the same scene.
std::string to_json(const Scene& scene);
// The same for the metadata of files made from it, which name their outputs without folders: they are the same bytes in
// every folder.
std::string metadata_json(const Scene& scene);

}  // namespace beamcam::scenes
