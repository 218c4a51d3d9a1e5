#include "scenes/regression/entry_test.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "scenes/outputs/run_context.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Structural similarity of similar pictures: other versions of the same fonts and libraries leave it above 0.9.
constexpr double kSimilar = 0.8;

// Parts of the other renderer that differ from this one: "freetype 2.12.1 for 2.13.3".
std::vector<std::string> differences(const RendererParts& mine, const RendererParts& other) {
    std::vector<std::string> parts;
    for (const auto& [part, version] : mine) {
        const auto its = other.find(part);
        if (its == other.end() || its->second != version)
            parts.push_back(fmt::format("{} {} for {}", part, its == other.end() ? "none" : its->second, version));
    }
    for (const auto& [part, version] : other)
        if (!mine.contains(part)) parts.push_back(fmt::format("{} {} for none", part, version));
    return parts;
}

bool is_new_renderer(const Baseline& entry, const std::string& id) {
    return !entry.accepted.empty() &&
           std::ranges::find(entry.accepted, id, &Accepted::renderer) == entry.accepted.end();
}

// Pictures that are compared with a file of the user are never replaced.
EntryReferences::Change change_of(const Baseline& entry, const RegressionOptions& options,
                                  const std::string& renderer) {
    using enum EntryReferences::Change;
    if (!options.update.empty()) return entry.expected.empty() || entry.has_motion() ? replace : none;
    return options.adds() && entry.expected.empty() && is_new_renderer(entry, renderer) ? add : none;
}

}  // namespace

EntryTest::EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
                     const Fingerprint& renderer, ReferenceUpdate& update, output::Manifest& report_files,
                     EntryResult& result)
    : baselines_(baselines),
      entry_(entry),
      options_(options),
      result_(result),
      renderer_(renderer),
      renderer_id_(renderer.id()),
      tolerance_(entry.tolerances.overridden_by({options.tolerance, {}}).of(renderer_id_)),
      references_(baselines.references, entry.name, update, change_of(entry, options, renderer_id_)),
      report_{options.report, report_files, entry.name},
      pictures_(entry, tolerance_, renderer_id_, references_, report_, result),
      motion_(entry, tolerance_, references_, report_, result) {
    if (entry.has_pictures()) result_.picture = Verdict::identical;
    if (entry.has_motion()) result_.motion = Verdict::identical;
}

void EntryTest::require_reproducible(const sim::Result& motion, double until) {
    const std::vector<sim::Interval>& lost = motion.not_reproducible;
    if (!result_.picture || !entry_.expected.empty() || lost.empty() || lost.front().from >= until) return;
    result_.not_reproducible = fmt::format(
        "not accepted: it shows the motion until {:.6g} s, and {}; end it before that, or guard a trajectory or a "
        "sweep",
        until, motion.reproducibility);
    if (is_updated()) throw render::PictureError(result_.not_reproducible);
}

void EntryTest::judge_file() {
    output::PictureSource source(entry_.file);
    output::Raster picture;
    std::string name;
    for (long frame = 0; source.next(picture, name); ++frame) {
        stop_if_interrupted();
        pictures_.judge(frame, picture);
    }
}

void EntryTest::finish() {
    if (result_.picture) pictures_.conclude();
}

void EntryTest::fail(const std::string& reason, Verdict verdict, int exit_code) {
    if (result_.picture) result_.picture = verdict;
    if (result_.motion) result_.motion = verdict;
    (result_.motion ? result_.motion_lines : result_.picture_lines) = {reason};
    result_.exit_code = exit_code;
    result_.frames.clear();  // a report of them must not be accepted
    result_.motion_files.clear();
    references_.drop();
}

bool EntryTest::attempt(const std::function<void()>& work) {
    try {
        work();
        return true;
    } catch (const sim::SolverError& error) {  // such as one of a variant that a figure compares with the scene
        fail(fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what()));
    } catch (const render::PictureError& error) {  // such as an impact that does not occur any more
        fail(error.what());
    } catch (const SceneError& error) {  // such as a value that a sweep cannot give to a key
        fail(error.what(), Verdict::missing, kBadScene);
    } catch (const output::IoError& error) {  // such as a damaged reference
        fail(error.what(), Verdict::missing, kInputOutput);
    } catch (const fs::filesystem_error& error) {
        fail(output::io_error(error).what(), Verdict::missing, kInputOutput);
    }
    return false;
}

void EntryTest::judge_renderer() {
    const auto has_accepted_reference = [](const auto& frame) { return frame.second.reference_accepted; };
    has_new_renderer_ = result_.picture == Verdict::different && result_.exit_code == 0 &&
                        result_.motion.value_or(Verdict::identical) <= Verdict::equivalent &&
                        is_new_renderer(entry_, renderer_id_) &&
                        std::ranges::all_of(result_.frames, has_accepted_reference) &&
                        entry_.accepted.front().sha256.size() == result_.frames.size();
    if (!has_new_renderer_) return;
    const auto is_similar = [](const auto& each) {
        const FrameResult& frame = each.second;
        return frame.verdict == Verdict::identical ||
               (frame.compared && frame.comparison.same_size() && frame.comparison.difference.ssim > kSimilar);
    };
    if (std::ranges::all_of(result_.frames, is_similar)) result_.picture = Verdict::new_renderer;
    if (!options_.add_digest) result_.picture_lines.push_back(renderer_message());
}

std::string EntryTest::renderer_message() const {
    std::string text = fmt::format("no picture of this renderer, {} (beamcam doctor), is accepted yet", renderer_id_);
    std::optional<std::pair<std::vector<std::string>, std::string>> nearest;  // different parts, and the id
    for (const Accepted& accepted : entry_.accepted)
        if (const auto parts = baselines_.renderers.find(accepted.renderer); parts != baselines_.renderers.end()) {
            auto differing = differences(renderer_.parts, parts->second);
            if (!nearest || differing.size() < nearest->first.size())
                nearest = {std::move(differing), accepted.renderer};
        }
    if (nearest) text += fmt::format("; the nearest is {}, with {}", nearest->second, fmt::join(nearest->first, ", "));
    return text + "; check the picture, then use --add-digest";
}

// Then the accepted pictures, also of other renderers, stay.
bool EntryTest::has_new_motion_only() const {
    return result_.picture == Verdict::identical && result_.motion && !result_.frames.empty() &&
           !entry_.accepted.empty() && entry_.expected.empty();
}

std::optional<BaselineEdit> EntryTest::edit() {
    BaselineEdit change{entry_.name, entry_.accepted, entry_.reproducible_until};
    Accepted own{renderer_id_, {}};
    for (const auto& [number, frame] : result_.frames) own.sha256.push_back(frame.sha256);
    if (is_updated()) {
        if (has_new_motion_only()) {
            for (const auto& [number, frame] : result_.frames)
                fs::remove(references_.new_folder() / picture_name(number));
            references_.keep_others();
        } else {
            change.accepted.clear();
            if (result_.picture && entry_.expected.empty()) change.accepted.push_back(std::move(own));
        }
        if (result_.motion) change.reproducible_until = result_.reproducible_until;
        result_.updated = true;
        return change;
    }
    const bool added = options_.add_digest ? has_new_renderer_ || result_.picture == Verdict::equivalent
                                           : result_.picture == Verdict::new_renderer &&
                                                 options_.rule.new_renderer == NewRenderer::accept;
    if (!added || !entry_.expected.empty()) {
        references_.drop();
        return std::nullopt;
    }
    change.accepted.push_back(std::move(own));
    result_.digest_added = true;
    return change;
}

}  // namespace beamcam::scenes
