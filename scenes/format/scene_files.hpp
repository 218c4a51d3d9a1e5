// The scene files that comparisons name ("compare": [{"scene": …}]). Each file is read once, however often it is named;
// rings, long chains and great numbers of files are refused with the chain of names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/format/tree.hpp"

namespace beamcam::scenes {

class SceneFiles {
  public:
    // hub, beam, cam, contact, gravity, initial and solver of the scene in this file, or why there are none.
    struct Mechanics {
        std::optional<Node> sections;
        std::string problem;
    };
    const Mechanics& mechanics(const std::string& path);

    // While it lives, the file is being read.
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
        std::filesystem::path file;  // without symbolic links
        std::string name;            // as it was given
    };

    std::string chain_problem(const std::filesystem::path& file, const std::string& path) const;
    Mechanics read(const std::string& path);

    std::vector<Link> chain_;                          // files being read, from the first to the one named last
    std::map<std::filesystem::path, Mechanics> read_;  // by their path without symbolic links
    std::string chain_problem_;                        // the first that was met while the file named last is read
};

// The sections of a scene that two compared motions can differ in: hub, beam, …
const std::vector<std::string>& mechanics_sections();
bool is_mechanics(std::string_view section);
Node mechanics_of(const Node& root);

}  // namespace beamcam::scenes
