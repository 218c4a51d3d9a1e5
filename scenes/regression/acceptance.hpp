// Pictures and motions of a test become references: of the present test (`test --update`, `--add-digest`) or of a
// report of another one (`accept`).
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "scenes/regression/references.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// Pictures that are compared with a file of the user are never accepted.
bool accepts_pictures(const Baseline& entry, const EntryResult& found);

class Acceptance {
  public:
    // `tested`: the folder of the pictures and motions of the test. `complete`: it has all of them; else those that
    // differ. All references must outlive this.
    Acceptance(const Baselines& baselines, ReferenceUpdate& update, std::filesystem::path tested, bool complete);

    // With `replaces` they replace those of the entry, else the pictures are added to them for another renderer. Throws
    // WouldOverwrite, and IoError for a file that is damaged or missing; then nothing changes.
    void accept(const Baseline& entry, const EntryResult& found, bool replaces);
    // Carries out what was accepted. `renderers`: of the results. False: nothing changed.
    bool commit(const std::map<std::string, RendererParts>& renderers);

  private:
    void replace(const Baseline& entry, const EntryResult& found);
    void add_pictures(const Baseline& entry, const EntryResult& found);
    void copy_picture(const Baseline& entry, long number, const FrameResult& frame,
                      const std::filesystem::path& target);
    void copy_motion(const Baseline& entry, const EntryResult& found, const std::filesystem::path& target);
    std::filesystem::path folder_of(const Baseline& entry) const { return baselines_.references / entry.name; }

    const Baselines& baselines_;
    Baselines changed_;
    ReferenceUpdate& update_;
    const std::filesystem::path tested_;
    const bool complete_;
    std::map<std::string, std::filesystem::path> by_digest_;            // reference pictures of the entry
    std::map<std::string, std::map<std::string, std::string>> pixels_;  // digests by entry and file
};

}  // namespace beamcam::scenes
