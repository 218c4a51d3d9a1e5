// The scene files that comparisons name ("compare": [{"scene": …}]). Each file is read once. Cycles, long chains and
// too many files are errors that list the files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "output/json/tree.hpp"

namespace beamcam::scenes {

class SceneFiles {
  public:
    // hub, beam, cam, contact, gravity, initial and solver of the scene in this file, or why it has none.
    struct Mechanics {
        std::optional<Node> sections;
        std::string problem;
    };
    const Mechanics& mechanics(const std::string& path);

    // Marks a file as being read during its lifetime.
    class BeingRead {
      public:
        BeingRead(SceneFiles& files, const std::string& path);
        ~BeingRead() { files_.chain_.pop_back(); }
        BeingRead(const BeingRead&) = delete;
        BeingRead& operator=(const BeingRead&) = delete;

      private:
        SceneFiles& files_;
    };

  private:
    struct Link {
        std::filesystem::path file;  // canonical
        std::string name;            // as the scene gives it
    };

    std::string chain_problem(const std::filesystem::path& file, const std::string& path) const;
    Mechanics read(const std::string& path);

    std::vector<Link> chain_;                          // files being read, outermost first
    std::map<std::filesystem::path, Mechanics> read_;  // by canonical path
    std::string chain_problem_;                        // first problem while the innermost file is read
};

// The sections of a scene that two compared motions can differ in: hub, beam, …
const std::vector<std::string>& mechanics_sections();
bool is_mechanics(std::string_view section);
Node mechanics_of(const Node& root);

}  // namespace beamcam::scenes
