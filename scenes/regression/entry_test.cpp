#include "scenes/regression/entry_test.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "scenes/outputs/run_context.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// SSIM of pictures of one scene: other versions of the same fonts and libraries leave it above 0.9.
constexpr double kAlike = 0.8;

// What another renderer has for what this one has: "freetype 2.12.1 for 2.13.3".
std::vector<std::string> differences(const RendererParts& mine, const RendererParts& other) {
    std::vector<std::string> words;
    for (const auto& [part, version] : mine) {
        const auto its = other.find(part);
        if (its == other.end() || its->second != version)
            words.push_back(fmt::format("{} {} for {}", part, its == other.end() ? "none" : its->second, version));
    }
    for (const auto& [part, version] : other)
        if (!mine.contains(part)) words.push_back(fmt::format("{} {} for none", part, version));
    return words;
}

}  // namespace

EntryTest::EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
                     const Fingerprint& renderer, const UpdateAccess& update, output::Manifest& report_files,
                     EntryResult& result)
    : baselines_(baselines),
      entry_(entry),
      options_(options),
      update_(update),
      result_(result),
      renderer_(renderer),
      renderer_id_(renderer.id()),
      tolerance_(entry.tolerances.overridden_by({options.tolerance, {}}).on_renderer(renderer_id_)),
      references_(baselines.references / entry.name),
      report_{options.report, report_files, entry.name},
      pictures_(entry, tolerance_, renderer_id_, references_, report_, result),
      motion_(entry, tolerance_, references_, report_, result) {
    if (entry.has_pictures()) result_.picture = Verdict::identical;
    if (entry.has_motion()) result_.motion = Verdict::identical;
    // Pictures that are held to a file of the user's are never replaced.
    if (update.replace && (entry.expected.empty() || entry.has_motion()))
        references_.fresh = update.replace(entry.name);
    else if (update.extend && entry.expected.empty() && is_new_renderer())
        references_.further = [this] { return update_.extend(entry_.name); };
}

bool EntryTest::is_new_renderer() const {
    return !entry_.accepted.empty() &&
           std::ranges::none_of(entry_.accepted, [&](const Accepted& a) { return a.renderer == renderer_id_; });
}

void EntryTest::require_reproducible(const sim::Result& motion, double until) {
    const std::vector<sim::Interval>& lost = motion.not_reproducible;
    if (!result_.picture || !entry_.expected.empty() || lost.empty() || lost.front().from >= until) return;
    result_.not_reproducible = fmt::format(
        "not accepted: it shows the motion until {:.6g} s, and {}; look no further than that, or guard a "
        "trajectory or a sweep",
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

void EntryTest::drop() {
    if ((references_.fresh || references_.further) && update_.drop) update_.drop(entry_.name);
    references_.fresh.reset();
    references_.further = nullptr;
}

void EntryTest::make_impossible(const std::string& why, Verdict verdict, int exit_code) {
    if (result_.picture) result_.picture = verdict;
    if (result_.motion) result_.motion = verdict;
    (result_.motion ? result_.motion_lines : result_.picture_lines) = {why};
    result_.exit_code = exit_code;
    result_.frames.clear();  // what a report holds of them is not to be accepted
    result_.motion_files.clear();
    drop();
}

bool EntryTest::attempt(const std::function<void()>& work) {
    try {
        work();
        return true;
    } catch (const sim::SolverError& error) {  // such as one of a variant that a figure compares the scene with
        make_impossible(fmt::format("the solver failed at {:.6g} s: {}", error.last_time, error.what()));
    } catch (const render::PictureError& error) {  // such as an impact that there is no more
        make_impossible(error.what());
    } catch (const SceneError& error) {  // such as a value that a sweep cannot give to a key
        make_impossible(error.what(), Verdict::missing, kBadScene);
    } catch (const output::IoError& error) {  // such as a damaged reference
        make_impossible(error.what(), Verdict::missing, kInputOutput);
    } catch (const fs::filesystem_error& error) {
        make_impossible(output::io_error(error).what(), Verdict::missing, kInputOutput);
    }
    return false;
}

void EntryTest::judge_renderer() {
    const auto is_fine = [](const auto& each) { return each.second.reference_accepted; };
    is_of_new_renderer_ = result_.picture == Verdict::different && result_.exit_code == 0 &&
                          result_.motion.value_or(Verdict::identical) <= Verdict::equivalent && is_new_renderer() &&
                          std::ranges::all_of(result_.frames, is_fine) &&
                          entry_.accepted.front().sha256.size() == result_.frames.size();
    if (!is_of_new_renderer_) return;
    const auto is_alike = [](const auto& each) {
        const FrameResult& found = each.second;
        return found.verdict == Verdict::identical ||
               (found.compared && found.comparison.same_size() && found.comparison.difference.ssim > kAlike);
    };
    if (std::ranges::all_of(result_.frames, is_alike)) result_.picture = Verdict::new_renderer;
    if (!options_.add_digest) result_.picture_lines.push_back(about_renderer());
}

std::string EntryTest::about_renderer() const {
    std::string words = fmt::format("nothing is accepted yet of this renderer, {} (beamcam doctor)", renderer_id_);
    std::optional<std::pair<std::vector<std::string>, std::string>> nearest;  // what differs, and the id
    for (const Accepted& accepted : entry_.accepted)
        if (const auto parts = baselines_.renderers.find(accepted.renderer); parts != baselines_.renderers.end()) {
            auto differing = differences(renderer_.parts, parts->second);
            if (!nearest || differing.size() < nearest->first.size())
                nearest = {std::move(differing), accepted.renderer};
        }
    if (nearest) words += fmt::format("; the nearest is {}, with {}", nearest->second, fmt::join(nearest->first, ", "));
    return words + "; look at the picture, and --add-digest";
}

// Then the pictures of other renderers still are of this entry.
bool EntryTest::is_motion_alone_new() const {
    return result_.picture == Verdict::identical && result_.motion && !result_.frames.empty() &&
           !entry_.accepted.empty() && entry_.expected.empty();
}

std::optional<BaselineEdit> EntryTest::edit() {
    BaselineEdit change{entry_.name, entry_.accepted, entry_.reproducible_until};
    Accepted own{renderer_id_, {}};
    for (const auto& [frame, found] : result_.frames) own.sha256.push_back(found.sha256);
    if (references_.fresh) {
        if (is_motion_alone_new()) {
            for (const auto& [frame, found] : result_.frames) fs::remove(*references_.fresh / picture_name(frame));
            update_.keep(entry_.name);
        } else {
            change.accepted.clear();
            if (result_.picture && entry_.expected.empty()) change.accepted.push_back(std::move(own));
        }
        if (result_.motion) change.reproducible_until = result_.reproducible_until;
        result_.updated = true;
        return change;
    }
    const bool added = options_.add_digest ? is_of_new_renderer_ || result_.picture == Verdict::equivalent
                                           : result_.picture == Verdict::new_renderer &&
                                                 options_.rule.new_renderer == NewRenderer::accept;
    if (!added || !entry_.expected.empty()) {
        drop();
        return std::nullopt;
    }
    change.accepted.push_back(std::move(own));
    result_.digest_added = true;
    return change;
}

}  // namespace beamcam::scenes
