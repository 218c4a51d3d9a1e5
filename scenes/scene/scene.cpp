#include "scenes/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace beamcam::scenes {

std::string file_of(const Output& output) {
    if (const auto* sweep = std::get_if<SweepOutput>(&output); sweep && !sweep->shard.whole())
        return part_file(sweep->file, sweep->shard);
    return std::visit([](const auto& o) { return o.file; }, output);
}

PictureOutput PictureOutput::of(Kind kind) {
    constexpr FrameRate kPosesOfPage{1000, 1};
    PictureOutput picture;
    picture.kind = kind;
    if (kind == Kind::page) picture.span.fps = kPosesOfPage;
    return picture;
}

std::string poster_file(const PictureOutput& video) {
    if (!video.span.poster) return {};
    return std::filesystem::path(video.file).replace_extension(".png").generic_string();
}

std::vector<std::string> written_by(const Output& output) {
    std::vector<std::string> files{file_of(output)};
    const auto add_unless_empty = [&files](std::initializer_list<std::string> beside) {
        std::ranges::copy_if(beside, std::back_inserter(files), [](const std::string& file) { return !file.empty(); });
    };
    if (const auto* video = picture_of(output, PictureOutput::Kind::video)) add_unless_empty({poster_file(*video)});
    if (const auto* figure = std::get_if<FigureOutput>(&output))
        add_unless_empty({figure->data_file, figure->caption_file});
    return files;
}

std::string metadata_json(const Scene& scene) {
    const auto strip = [](std::string& file) { file.erase(0, file.rfind('/') + 1); };  // npos + 1 is 0
    Scene here = scene;
    std::set<std::string> names;
    bool distinct = true;
    for (Output& output : here.outputs) {
        std::visit([&](auto& each) { strip(each.file); }, output);
        if (auto* figure = std::get_if<FigureOutput>(&output)) strip(figure->data_file), strip(figure->caption_file);
        for (const std::string& name : written_by(output)) distinct = names.insert(name).second && distinct;
    }
    return to_json(distinct ? here : scene);
}

const PictureOutput* picture_of(const Output& output, PictureOutput::Kind kind) {
    const auto* picture = std::get_if<PictureOutput>(&output);
    return picture && picture->kind == kind ? picture : nullptr;
}

OutputInputs inputs_of(const Output& output) {
    return std::visit([](const auto& o) { return o.kInputs; }, output);
}

bool is_data(const Output& output) { return !inputs_of(output).title; }

std::string name_of(const Instant& at) {
    for (const EventWord& each : kEventWords)
        if (each.kind == at.kind) return fmt::format("{} {}", each.word, at.number);
    return at.kind == Instant::Kind::last ? "the end" : fmt::format("{:g} s", at.t);
}

std::string event_notations() {
    std::string text;
    for (const EventWord& each : kEventWords) text += fmt::format("{}{}:N", text.empty() ? "" : ", ", each.word);
    return text;
}

std::vector<Instant> FrameSpan::instants() const {
    std::vector<Instant> all;
    for (const FilmEvent& event : events) all.push_back(event.at);
    for (const SpeedInterval& each : speed.intervals) all.push_back(each.from), all.push_back(each.to);
    for (const auto& each : {from_event, to_event, poster})
        if (each) all.push_back(*each);
    return all;
}

bool FrameSpan::needs_events() const {
    return story || speed.around || std::ranges::any_of(instants(), &Instant::is_event);
}

PictureOutput default_film(const Scene& scene) {
    PictureOutput film;
    film.file = scene.name + ".mp4";
    return film;
}

}  // namespace beamcam::scenes
