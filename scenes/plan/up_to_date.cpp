#include "scenes/plan/up_to_date.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <variant>

#include "output/files/digest.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

class Files {
  public:
    Files(const std::string& directory, output::FileList& file_list) : directory_(directory), file_list_(file_list) {}

    bool up_to_date(const std::string& file, const std::string& inputs) {
        return file_list_.is_up_to_date(place_of(directory_, file), inputs);
    }

    // Numbers of the up-to-date frames, whatever their range, which may depend on events.
    std::set<long> frames(const std::string& numbered, const std::string& inputs) {
        std::set<long> there;
        const fs::path pattern = numbered, folder = place_of(directory_, pattern.parent_path().string());
        std::error_code failed;  // no folder, no frames
        for (fs::directory_iterator at(folder.empty() ? "." : folder, failed), end; !failed && at != end;
             at.increment(failed))
            if (const auto number = number_of(pattern.filename().string(), at->path().filename().string());
                number && up_to_date(numbered_file(numbered, *number), inputs))
                there.insert(*number);
        return there;
    }

  private:
    const std::string& directory_;
    output::FileList& file_list_;
};

// The end of the motion on which an output depends [s]; 0 if its own keys say where it ends.
double end_of_inputs(const Output& output, const Scene& scene) {
    const auto unless = [&](bool by_own_keys) { return by_own_keys ? 0 : scene.end_time; };
    if (std::holds_alternative<ImpactsOutput>(output) || std::holds_alternative<SummaryOutput>(output))
        return run_end(scene);
    if (const auto* table = std::get_if<TrajectoryOutput>(&output)) return unless(!table->times.empty());
    if (const auto* p = std::get_if<PictureOutput>(&output)) return unless(p->span.to.has_value());
    if (const auto* figure = std::get_if<FigureOutput>(&output)) return unless(figure->series.to.has_value());
    return scene.end_time;
}

}  // namespace

std::string inputs_key(const Scene& scene, std::size_t output) {
    const Output& one = scene.outputs.at(output);
    const OutputInputs shown = inputs_of(one);
    const auto* figure = std::get_if<FigureOutput>(&one);
    const FigureType* type = figure ? figure_type(figure->figure) : nullptr;
    const bool of_sweep = shown.sweep || (type && type->of_sweep());
    Scene inputs = scene;
    inputs.outputs = {one};
    if (!shown.title) inputs.title.clear();
    if (!shown.units) inputs.units = {};
    if (!shown.data) inputs.data.clear();
    if (!of_sweep) inputs.sweep.reset();
    inputs.end_time = of_sweep ? 0 : end_of_inputs(one, scene);
    const auto* sweep = std::get_if<SweepOutput>(&one);
    std::string other = sweep && !sweep->shard.whole() ? sweep->shard.text() : "";
    for (const Measurement& each : inputs.data) other += "\n" + each.digest;
    if (figure) {  // not part of the scene
        const char* epoch = figure->file.ends_with(".png") ? nullptr : std::getenv("SOURCE_DATE_EPOCH");
        other += fmt::format("\n{}{}", epoch ? epoch : "", figure->table.digest);
    }
    return output::sha256(fmt::format("inputs\n{}\n{}\n{}", program_identity(), other, metadata_json(inputs)));
}

std::vector<std::string> inputs_keys(const Scene& scene) {
    std::vector<std::string> all(scene.outputs.size());
    for (std::size_t i = 0; i < scene.outputs.size(); ++i)
        if (!is_stdout(file_of(scene.outputs[i]))) all[i] = inputs_key(scene, i);
    return all;
}

ExistingWork find_existing(const Scene& scene, const std::vector<std::string>& inputs, const std::string& directory,
                           output::FileList& file_list) {
    ExistingWork found;
    Files files(directory, file_list);
    for (std::size_t i = 0; i < scene.outputs.size(); ++i) {
        const Output& output = scene.outputs[i];
        if (inputs[i].empty()) continue;
        if (picture_of(output, PictureOutput::Kind::frames)) {
            found.frames[i] = files.frames(file_of(output), inputs[i]);
            continue;
        }
        if (std::ranges::all_of(written_by(output),
                                [&](const std::string& file) { return files.up_to_date(file, inputs[i]); }))
            found.finished.insert(i);
    }
    return found;
}

fs::path place_of(const std::string& directory, const std::string& file) {
    return directory.empty() ? fs::path(file) : fs::path(directory) / file;
}

}  // namespace beamcam::scenes
