#include "scenes/scene/scene.hpp"

#include <algorithm>
#include <filesystem>

namespace beamcam::scenes {

const std::string& file_of(const Output& output) {
    return std::visit([](const auto& o) -> const std::string& { return o.file; }, output);
}

std::string poster_file(const VideoOutput& video) {
    return std::filesystem::path(video.file).replace_extension(".png").generic_string();
}

std::vector<std::string> written_by(const Output& output) {
    std::vector<std::string> files{file_of(output)};
    if (const auto* video = std::get_if<VideoOutput>(&output); video && video->span.poster)
        files.push_back(poster_file(*video));
    return files;
}

double memory_of(const Picture& picture) {
    // Measured on pictures of 8192 × 8192 pixels: three layers and the rows of a PNG; what OpenGL adds to them.
    const double pixels = double(picture.size.width) * picture.size.height;
    switch (picture.view.style) {
        case render::Style::flat:
            return 16 * pixels;
        case render::Style::lit:
            return 28 * pixels;
        case render::Style::solid:
            return 60 * pixels;
    }
    return 0;
}

bool is_data(const Output& output) {
    return std::visit([](const auto& o) { return o.kIsData; }, output);
}

bool FrameSpan::looks_at_impacts() const {
    return speed.around || (poster && poster->kind != Instant::Kind::time) ||
           std::any_of(events.begin(), events.end(),
                       [](const FilmEvent& event) { return event.at.kind != Instant::Kind::time; });
}

VideoOutput default_film(const Scene& scene) {
    VideoOutput film;
    film.file = scene.name + ".mp4";
    return film;
}

}  // namespace beamcam::scenes
