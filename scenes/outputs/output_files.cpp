#include "scenes/outputs/output_files.hpp"

#include "output/files/atomic_file.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

fs::path OutputFiles::path_of(const std::string& file) const { return place_of(context_.options.directory, file); }

void OutputFiles::claim(const std::vector<std::string>& files) {
    const std::string& directory = context_.options.directory;
    for (const std::string& file : files) {
        if (is_stdout(file)) continue;
        const fs::path path = path_of(file);
        if (!directory.empty()) {
            output::require_within(path, directory);
            output::ensure_directory(path.parent_path());
        }
        context_.file_list.require_replaceable(path);
    }
}

output::FileTarget OutputFiles::target(const fs::path& file, std::optional<std::size_t> output) const {
    output::Origin origin;
    if (output) origin.inputs = inputs_[*output];
    if (kind_without_scene(ending_of(file))) origin.version = kVersion, origin.scene = metadata_json(scene_);
    output::FileTarget target = context_.file_list.target(file, std::move(origin));
    target.within = context_.options.directory;
    return target;
}

void OutputFiles::wrote(const fs::path& file, const std::string& what) {
    count_written(file);
    context_.progress.end();
    context_.print("wrote {}{}\n", file.string(), what.empty() ? "" : " (" + what + ")");
}

void OutputFiles::count_written(const fs::path& file) {
    std::error_code ignored;
    ++context_.work.files_written;
    context_.work.bytes_written += static_cast<long>(fs::file_size(file, ignored));
}

}  // namespace beamcam::scenes
