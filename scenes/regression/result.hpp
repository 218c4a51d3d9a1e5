// What a regression test finds: of each picture, of each entry, of all; and what passes.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/regression/baselines.hpp"
#include "scenes/regression/comparison.hpp"

namespace beamcam::scenes {

struct FrameResult {
    Verdict verdict = Verdict::identical;
    std::string sha256;  // of what was drawn
    PictureComparison comparison;
    bool compared = false;                               // with a reference picture
    bool reference_accepted = true;                      // the reference picture belongs to an accepted digest
    std::filesystem::path expected, actual, difference;  // files, where there are any
    // How far it is from what is expected: what reports begin with.
    double weight() const;
};

struct EntryResult {
    std::string name;
    std::optional<Verdict> picture, motion;                // absent: the entry does not ask for it
    std::map<long, FrameResult> frames;                    // by number, from 0
    std::vector<std::string> picture_lines, motion_lines;  // what there is to say
    std::map<std::string, std::string> motion_files;       // in the report, where the motion differs: SHA-256 by name
    std::optional<double> reproducible_until;              // [s], where it was asked for
    std::string not_reproducible;                          // in words, where the pictures show such a motion
    std::string old_digest, new_digest;                    // of the first picture that is another, on --update
    bool updated = false, digest_added = false;
    std::string renderer;  // the fingerprint of what drew the pictures, where they are not identical
    double seconds = 0;    // of drawing and judging it
    int exit_code = 0;     // what the program is to end with when there was nothing to judge; 0: judged

    Verdict verdict() const;
    // The frame that changed most, when one changed.
    const std::pair<const long, FrameResult>* worst() const;
    std::size_t frames_with(Verdict verdict) const;
};

// What pictures of a new renderer come to: a failure, a pass that is told, or digests that are accepted from now on.
enum class NewRenderer { fail, warn, accept };

// Which verdicts pass.
struct PassRule {
    bool strict = false;  // only what is identical
    NewRenderer new_renderer = NewRenderer::fail;
    bool passes(Verdict verdict) const;
    bool passes(const EntryResult& entry) const;  // its picture and its motion, each by itself
};

struct RegressionResult {
    std::string baselines;                           // the file, as it was named
    std::map<std::string, RendererParts> renderers;  // those of the entries
    std::vector<EntryResult> entries;
    std::size_t simulations = 0, pictures = 0;
    double seconds = 0;
    bool changed = false;  // the baselines were rewritten
};

}  // namespace beamcam::scenes
