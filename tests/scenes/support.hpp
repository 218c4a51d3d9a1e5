// What the tests of scenes share.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scenes/format/reader.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::scenes::testing {

inline const std::filesystem::path kCorpus = BEAMCAM_TEST_DIR "/scenes/corpus";

inline Reading read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return read_scene({"scene.json", text, true}, overrides);
}

// "line:column text" of every message.
inline std::vector<std::string> messages(const Reading& reading) {
    std::vector<std::string> all;
    for (const Message& message : reading.messages) {
        const Source& source = reading.sources[message.place.source];
        const LineColumn at = locate(source.text, message.place.offset);
        all.push_back((source.is_file ? std::to_string(at.line) + ":" + std::to_string(at.column) : source.name) + " " +
                      message.text);
    }
    return all;
}

inline std::string slurp(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

struct Finished {
    int code = -1;
    std::string out, err;
};

// A folder of its own for each test, gone with it.
class Folder {
  public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "beamcam-scenes-XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

// A shell function: the SHA-256 of the decoded pixels of each picture of the files, as FFmpeg takes them.
inline constexpr const char* kPictureHash =
    "picture_hash() { for f; do ffmpeg -v error -i \"$f\" -sws_flags bicubic+accurate_rnd+full_chroma_int+bitexact "
    "-pix_fmt rgba -f framehash -hash sha256 - | grep -v '^#' | sed \"s|.* ||; s|$|  $f|\"; done; }; ";

// Runs a shell command in a folder; the program is $BEAMCAM.
inline Finished shell(const Folder& folder, const std::string& command) {
    const std::string line = "cd '" + folder.path().string() +
                             "' && BEAMCAM='" BEAMCAM_PROGRAM "'; " +
                             kPictureHash + "{ " + command + " ; } >.stdout 2>.stderr </dev/null";
    const int status = std::system(line.c_str());
    Finished finished;
    finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    finished.out = slurp(folder / ".stdout");
    finished.err = slurp(folder / ".stderr");
    return finished;
}

}  // namespace beamcam::scenes::testing
