// The files of one scene's outputs: checks that they can be written, and records the inputs of each.
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
    // `inputs`: inputs_key of each output. All must outlive this.
    OutputFiles(const Scene& scene, const std::vector<std::string>& inputs, RunContext& context)
        : scene_(scene), inputs_(inputs), context_(context) {}

    std::filesystem::path path_of(const std::string& file) const;
    // Throws if one of these files of outputs cannot be written. Makes their folders, and cleans up after killed runs.
    void claim(const std::vector<std::string>& files);

    // No inputs are recorded without `output`.
    output::FileTarget target(const std::filesystem::path& file, std::optional<std::size_t> output = {}) const;
    // Counts and reports a written file.
    void wrote(const std::filesystem::path& file, const std::string& what);
    void count_written(const std::filesystem::path& file);

  private:
    const Scene& scene_;
    const std::vector<std::string>& inputs_;
    RunContext& context_;
};

}  // namespace beamcam::scenes
