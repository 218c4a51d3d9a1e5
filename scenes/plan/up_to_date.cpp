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

class UpToDateCheck {
  public:
    UpToDateCheck(const Scene& scene, const Shard& shard, const std::string& directory, output::FileList& file_list)
        : scene_(scene), whole_(plan(scene, shard)), directory_(directory), file_list_(file_list) {
        found_.inputs.resize(scene.outputs.size());
    }

    UpToDate run(bool ignore_files) {
        const double until = whole_.simulation ? whole_.simulation->request.end_time : 0;
        for (std::size_t i = 0; i < scene_.outputs.size(); ++i)
            if (!is_stdout(file_of(scene_.outputs[i]))) found_.inputs[i] = inputs_key(scene_, i, until, part_of(i));
        found_.existing.until = until;
        if (!ignore_files) check_files();
        return std::move(found_);
    }

  private:
    std::string part_of(std::size_t output) const {
        for (const DataFile& d : whole_.data)
            if (d.output == output) return d.part;
        return {};
    }

    bool is_up_to_date(const std::string& file, std::size_t output) {
        return !is_stdout(file) && file_list_.is_up_to_date(place_of(directory_, file), found_.inputs[output]);
    }

    void check_files() {
        for (const Pictures& p : whole_.pictures)
            if (p.kind == Pictures::Kind::frames)
                check_frames(p);
            else
                check(p.file, p.output);
        for (const FigureFile& f : whole_.figures) check(f.file, f.output);
        for (const DataFile& d : whole_.data) check(d.file, d.output);
    }

    // A file without those that are written beside it, such as the poster of a film, is not up to date. A part of the
    // work has another name, and its first file alone.
    void check(const std::string& file, std::size_t output) {
        const std::vector<std::string> whole = written_by(scene_.outputs[output]);
        const std::vector<std::string> files = file == whole.front() ? whole : std::vector{file};
        if (std::ranges::all_of(files, [&](const std::string& each) { return is_up_to_date(each, output); }))
            found_.existing.finished.emplace(output, file);
    }

    void check_frames(const Pictures& p) {
        std::set<long> there;
        if (!p.times_known) {  // their number depends on events
            there = existing_frames(p);
            if (!there.empty()) found_.existing.frames[p.output] = std::move(there);
            return;
        }
        for (int k : p.draw)
            if (const long number = p.first_frame + k; is_up_to_date(numbered_file(p.file, number), p.output))
                there.insert(number);
        if (there.size() == p.draw.size())
            found_.existing.finished.emplace(p.output, p.file);
        else if (!there.empty())
            found_.existing.frames[p.output] = std::move(there);
    }

    // Numbers of the up-to-date frames, whatever their range.
    std::set<long> existing_frames(const Pictures& p) {
        std::set<long> there;
        const fs::path pattern = p.file, folder = place_of(directory_, pattern.parent_path().string());
        std::error_code failed;  // no folder, no frames
        for (fs::directory_iterator at(folder.empty() ? "." : folder, failed), end; !failed && at != end;
             at.increment(failed))
            if (const auto number = number_of(pattern.filename().string(), at->path().filename().string());
                number && is_up_to_date(numbered_file(p.file, *number), p.output))
                there.insert(*number);
        return there;
    }

    const Scene& scene_;
    const Plan whole_;
    const std::string& directory_;
    output::FileList& file_list_;
    UpToDate found_;
};

}  // namespace

std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part) {
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
    const Extent extent = std::visit([](const auto& o) { return o.extent(); }, one);
    if (extent != Extent::scene || of_sweep) inputs.end_time = extent == Extent::run ? until : 0;
    std::string other = part;
    for (const Measurement& each : inputs.data) other += "\n" + each.digest;
    if (figure) {  // not part of the scene
        const char* epoch = figure->file.ends_with(".png") ? nullptr : std::getenv("SOURCE_DATE_EPOCH");
        other += fmt::format("\n{}", epoch ? epoch : "");
    }
    return output::sha256(fmt::format("inputs\n{}\n{}\n{}", program_identity(), other, metadata_json(inputs)));
}

UpToDate check_up_to_date(const Scene& scene, const Shard& shard, const std::string& directory,
                          output::FileList& file_list, bool ignore_files) {
    return UpToDateCheck(scene, shard, directory, file_list).run(ignore_files);
}

fs::path place_of(const std::string& directory, const std::string& file) {
    return directory.empty() ? fs::path(file) : fs::path(directory) / file;
}

}  // namespace beamcam::scenes
