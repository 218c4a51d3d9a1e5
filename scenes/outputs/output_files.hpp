// The files of one scene's outputs: what cannot be written is refused before any work, and each file is recorded with
// what it was made from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/files/target.hpp"
#include "scenes/outputs/run_context.hpp"

namespace beamcam::scenes {

class OutputFiles {
  public:
    // `inputs`: key of what each output is made from. All must outlive this.
    OutputFiles(const Scene& scene, const std::vector<std::string>& inputs, RunContext& context)
        : scene_(scene), inputs_(inputs), context_(context) {}

    std::filesystem::path path_of(const std::string& file) const;
    // Removes or records what runs that were killed have left in the folders of all outputs.
    void recover();
    // Throws what would be thrown when the files that the plan makes are written.
    void claim(const Plan& plan);
    // The files of a film, a sequence or a still.
    std::vector<std::filesystem::path> files_of(const Pictures& p) const;

    // Without `output`: nothing is recorded of what the file is made from.
    output::Target target(const std::filesystem::path& file, std::optional<std::size_t> output = {}) const;
    // Counts a file that was written, and says so.
    void wrote(const std::filesystem::path& file, const std::string& what);
    void count_written(const std::filesystem::path& file);
    // Remembers what making these files took, for the plans of later runs.
    void note_work(const std::vector<std::string>& names, double units, Clock::time_point since,
                   const std::vector<std::filesystem::path>& made);

  private:
    std::vector<std::filesystem::path> files_of(const Plan& plan) const;

    const Scene& scene_;
    const std::vector<std::string>& inputs_;
    RunContext& context_;
};

}  // namespace beamcam::scenes
