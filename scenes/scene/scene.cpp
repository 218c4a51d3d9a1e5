#include "scenes/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace beamcam::scenes {

const std::string& file_of(const Output& output) {
    return std::visit([](const auto& o) -> const std::string& { return o.file; }, output);
}

std::string poster_file(const VideoOutput& video) {
    return std::filesystem::path(video.file).replace_extension(".png").generic_string();
}

std::string subtitles_file(const VideoOutput& video) {
    if (video.subtitles == Subtitles::none) return {};
    const char* ending = video.subtitles == Subtitles::vtt ? ".vtt" : ".srt";
    return std::filesystem::path(video.file).replace_extension(ending).generic_string();
}

std::vector<std::string> written_by(const Output& output) {
    std::vector<std::string> files{file_of(output)};
    if (const auto* video = std::get_if<VideoOutput>(&output)) {
        if (video->span.poster) files.push_back(poster_file(*video));
        if (video->subtitles != Subtitles::none) files.push_back(subtitles_file(*video));
    }
    if (const auto* figure = std::get_if<FigureOutput>(&output))
        for (const std::string& beside : {figure->data_file, figure->caption_file})
            if (!beside.empty()) files.push_back(beside);
    return files;
}

double memory_of(const Picture& picture) {
    // Bytes per pixel, measured at 8192 × 8192 pixels: three layers and the rows of a PNG, and the buffers of OpenGL.
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

bool is_picture(const Output& output) {
    return std::visit([](const auto& o) { return std::is_base_of_v<Picture, std::decay_t<decltype(o)>>; }, output);
}

bool is_data(const Output& output) {
    return std::visit([](const auto& o) { return o.kIsData; }, output);
}

std::string name_of(const Instant& at) {
    for (const EventWord& each : kEventWords)
        if (each.kind == at.kind) return fmt::format("{} {}", each.word, at.number);
    return at.kind == Instant::Kind::last ? "the end" : fmt::format("{:g} s", at.t);
}

std::vector<Instant> FrameSpan::instants() const {
    std::vector<Instant> all;
    for (const FilmEvent& event : events) all.push_back(event.at);
    for (const SpeedInterval& each : speed.intervals) all.push_back(each.from), all.push_back(each.to);
    for (const auto& each : {from_event, to_event, poster})
        if (each) all.push_back(*each);
    return all;
}

bool FrameSpan::needs_events() const { return speed.around || std::ranges::any_of(instants(), &Instant::is_event); }

VideoOutput default_film(const Scene& scene) {
    VideoOutput film;
    film.file = scene.name + ".mp4";
    return film;
}

}  // namespace beamcam::scenes
