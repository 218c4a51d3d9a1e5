#include "scenes/regression/entry_test.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/files/errors.hpp"
#include "output/film/picture_source.hpp"
#include "render/base/error.hpp"
#include "scenes/motions/identity.hpp"

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

// An update of the entry replaces its references.
bool is_replaced(const Baseline& entry, const RegressionOptions& options) {
    return !options.update.empty() && (entry.expected.empty() || entry.has_motion());
}

// Where pictures and motions of the test are written, if anything needs them.
TestedFiles tested_files(const Baseline& entry, const RegressionOptions& options, const std::string& renderer,
                         ReferenceUpdate& update, output::Manifest& report) {
    const bool replaced = is_replaced(entry, options);
    if (options.report) return {options.report, &report, entry.name, replaced};
    if (!replaced && !(options.adds() && entry.expected.empty() && is_new_renderer(entry, renderer)))
        return {{}, nullptr, entry.name, false};
    update.begin();
    return {update.tested(), nullptr, entry.name, replaced};
}

}  // namespace

EntryTest::EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
                     const Fingerprint& renderer, ReferenceUpdate& update, output::Manifest& report_files,
                     EntryResult& result)
    : baselines_(baselines),
      options_(options),
      renderer_(renderer),
      test_{entry,
            result,
            renderer.id(),
            entry.tolerances.overridden_by({options.tolerance, {}}).of(renderer.id()),
            {baselines.references / entry.name, is_replaced(entry, options)},
            tested_files(entry, options, renderer.id(), update, report_files)},
      pictures_(test_),
      motion_(test_) {
    if (is_updated()) update.require_replaceable(entry.name);
    if (entry.has_pictures()) test_.result.picture = Verdict::identical;
    if (entry.has_motion()) test_.result.motion = Verdict::identical;
}

// ---- an entry with a motion ------------------------------------------------------------------------

void EntryTest::prepare() {
    const Scene& scene = test_.entry.scene;
    plan_ = plan(scene);
    resolve_event_times(plan_, scene, [](const sim::Problem& problem, const sim::Request& events) {
        return sim::simulate(problem, events, until_interrupted);
    });
    // A picture that compares other motions than the scene's own needs no simulation of the scene. A figure of statics
    // needs no motion at all.
    if (!plan_.simulation) {
        double& until = plan_.simulation.emplace(Simulation{scene.problem, motion_key(scene.problem)}).request.end_time;
        for (const Pictures& p : plan_.pictures) until = std::max(until, p.end_time);
        for (const Simulation& other : plan_.others) until = std::max(until, other.request.end_time);
        if (plan_.pictures.empty() && plan_.others.empty() && !plan_.figures.empty()) test_.result.motion.reset();
    }
    until_ = plan_.simulation->request.end_time;
    if (needs_horizon()) plan_.simulation->request.horizon = true;  // some figures request it anyway
    request_record();
    if (needs_motion()) request_compared_records();
    requests_ = requests_of(plan_);
}

// The table of the entry itself is recorded if it is one, else a small one.
void EntryTest::request_record() {
    std::vector<sim::TableRequest>& tables = plan_.simulation->request.tables;
    const auto own = std::ranges::find_if(plan_.data, [](const DataFile& d) { return d.table.has_value(); });
    recorded_ = own != plan_.data.end() ? *own->table : tables.size();
    if (own == plan_.data.end() && needs_motion())
        tables.push_back(motion_behind_picture(test_.entry.scene.problem, until_));
    if (records_all_channels(test_.entry))
        std::erase_if(tables[recorded_].channels,
                      [](const sim::Channel& channel) { return channel.kind == sim::ChannelKind::energy_residual; });
}

void EntryTest::request_compared_records() {
    for (Pictures& p : plan_.pictures)
        for (std::size_t i = 0; i < p.compare.size(); ++i) {
            Study& other = p.shown[i];
            other.request.tables.push_back(motion_.compared_table(i, other.problem, p.end_time));
            if (needs_horizon()) other.request.horizon = true;
        }
}

void EntryTest::judge(std::vector<sim::Result> results, RunOptions options) {
    const sim::Result& run = results.front();
    require_reproducible(run, until_);
    if (needs_motion()) motion_.judge(run.tables[recorded_], run.impacts, until_, run.reproducible_until);
    DrawCallbacks callbacks{
        std::move(results),
        [&](const Pictures&, long frame, const render::Image& image) { pictures_.judge(frame, image); },
        [&](const render::Image& image) { pictures_.judge(0, image); },
        {}};
    if (needs_motion())
        callbacks.compared = [&](std::size_t picture, std::size_t index, const sim::Result& result) {
            const Pictures& shown = plan_.pictures[picture];
            require_reproducible(result, shown.end_time);
            motion_.judge_compared(index, shown.compare[index].label, result.tables.back(), result.impacts,
                                   result.reproducible_until);
        };
    options.no_cache = true;  // the test runs the present program
    scenes::draw(plan_, test_.entry.scene, callbacks, options);
    conclude();
}

void EntryTest::require_reproducible(const sim::Result& motion, double until) {
    const std::vector<sim::Interval>& lost = motion.not_reproducible;
    if (!test_.result.picture || !test_.entry.expected.empty() || lost.empty() || lost.front().from >= until) return;
    test_.result.not_reproducible = fmt::format(
        "not accepted: it shows the motion until {:.6g} s, and {}; end it before that, or guard a trajectory or a "
        "sweep",
        until, motion.reproducibility);
    if (is_updated()) throw render::PictureError(test_.result.not_reproducible);
}

// ---- verdicts --------------------------------------------------------------------------------------

void EntryTest::judge_file() {
    output::PictureSource source(test_.entry.file);
    output::Raster picture;
    std::string name;
    for (long frame = 0; source.next(picture, name); ++frame) {
        stop_if_interrupted();
        pictures_.judge(frame, picture);
    }
    conclude();
}

void EntryTest::conclude() {
    if (test_.result.picture) pictures_.conclude();
}

void EntryTest::fail(const std::string& reason, Verdict verdict, int exit_code) {
    if (test_.result.picture) test_.result.picture = verdict;
    if (test_.result.motion) test_.result.motion = verdict;
    (test_.result.motion ? test_.result.motion_lines : test_.result.picture_lines) = {reason};
    test_.result.exit_code = exit_code;
    test_.result.frames.clear();  // a report of them must not be accepted
    test_.result.motion_files.clear();
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
        fail(error.what(), Verdict::not_run, kBadScene);
    } catch (const output::IoError& error) {  // such as a damaged reference
        fail(error.what(), Verdict::not_run, kInputOutput);
    } catch (const fs::filesystem_error& error) {
        fail(output::io_error(error).what(), Verdict::not_run, kInputOutput);
    }
    return false;
}

void EntryTest::judge_renderer() {
    const auto has_accepted_reference = [](const auto& frame) { return frame.second.reference_accepted; };
    has_new_renderer_ = test_.result.picture == Verdict::different && test_.result.exit_code == 0 &&
                        test_.result.motion.value_or(Verdict::identical) <= Verdict::equivalent &&
                        is_new_renderer(test_.entry, test_.renderer) &&
                        std::ranges::all_of(test_.result.frames, has_accepted_reference) &&
                        test_.entry.accepted.front().sha256.size() == test_.result.frames.size();
    if (!has_new_renderer_) return;
    const auto is_similar = [](const auto& each) {
        const FrameResult& frame = each.second;
        return frame.verdict == Verdict::identical ||
               (frame.compared && frame.comparison.same_size() && frame.comparison.difference.ssim > kSimilar);
    };
    if (std::ranges::all_of(test_.result.frames, is_similar)) test_.result.picture = Verdict::new_renderer;
    if (!options_.add_digest) test_.result.picture_lines.push_back(renderer_message());
}

std::string EntryTest::renderer_message() const {
    std::string text = fmt::format("no picture of this renderer, {} (beamcam doctor), is accepted yet", test_.renderer);
    std::optional<std::pair<std::vector<std::string>, std::string>> nearest;  // different parts, and the id
    for (const Accepted& accepted : test_.entry.accepted)
        if (const auto parts = baselines_.renderers.find(accepted.renderer); parts != baselines_.renderers.end()) {
            auto differing = differences(renderer_.parts, parts->second);
            if (!nearest || differing.size() < nearest->first.size())
                nearest = {std::move(differing), accepted.renderer};
        }
    if (nearest) text += fmt::format("; the nearest is {}, with {}", nearest->second, fmt::join(nearest->first, ", "));
    return text + "; check the picture, then use --add-digest";
}

bool EntryTest::accept() {
    EntryResult& result = test_.result;
    if (result.exit_code != 0) return false;
    result.updated = is_updated();
    if (result.updated || !test_.entry.expected.empty()) return result.updated;
    result.digest_added = options_.add_digest ? has_new_renderer_ || result.picture == Verdict::equivalent
                                              : result.picture == Verdict::new_renderer &&
                                                    options_.rule.new_renderer == NewRenderer::accept;
    return result.digest_added;
}

}  // namespace beamcam::scenes
