#include "scenes/regression/entry_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "output/files/atomic_file.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

fs::path report_picture(const std::string& entry, long frame, const char* kind) {
    return fs::path(entry) / fmt::format("{:04}-{}.png", frame, kind);
}

EntryPictures::EntryPictures(EntryContext& test)
    : test_(test), digests_(test.entry.has_pictures() ? test.references.digests() : Digests()) {}

void EntryPictures::judge(long frame, const render::Image& image) {
    thread_local output::Raster raster;
    output::to_raster(image, raster);
    FrameResult result = compare(frame, raster);
    report_pictures(frame, raster, result);
    const std::lock_guard lock(mutex_);
    test_.update.keep(picture_name(frame));
    if (test_.references.is_updated() && !result.has_same_pixels())
        test_.update.put(picture_name(frame), output::encode_png(image));
    test_.result.frames[frame] = std::move(result);
}

FrameResult EntryPictures::compare(long frame, const output::Raster& actual) const {
    FrameResult result;
    result.sha256 = output::digest(actual);
    result.verdict = Verdict::missing;
    const fs::path reference = test_.references.file(picture_name(frame));
    if (!output::path_exists(reference)) return result;
    result.expected = reference;
    try {
        result.comparison = scenes::compare(output::read_png(reference), actual, test_.tolerance.channel.value_or(0));
    } catch (const output::IoError&) {  // an update replaces a damaged picture
        if (!test_.references.is_updated()) refuse_reference(reference, "it is not a readable PNG file");
        return result;
    }
    result.compared = true;
    result.verdict = result.has_same_pixels()                  ? Verdict::identical
                     : !is_within_tolerance(result.comparison) ? Verdict::different
                     : is_recorded(frame, result.sha256)       ? Verdict::identical
                                                               : Verdict::equivalent;
    return result;
}

bool EntryPictures::is_within_tolerance(const PictureComparison& comparison) const {
    const output::PictureDifference& difference = comparison.difference;
    return comparison.same_size() && (difference.share() <= test_.tolerance.share.value_or(0) ||
                                      (test_.tolerance.ssim && difference.ssim >= *test_.tolerance.ssim));
}

bool EntryPictures::is_recorded(long frame, const std::string& digest) const {
    const auto own = digests_.find(test_.renderer);
    const auto at = static_cast<std::size_t>(frame);
    return own != digests_.end() && at < own->second.size() && own->second[at] == digest;
}

void EntryPictures::report_pictures(long frame, const output::Raster& actual, FrameResult& result) const {
    if (!test_.report || result.verdict == Verdict::identical) return;
    result.actual = write(frame, "actual", actual);
    if (!result.compared) return;
    const output::Raster expected = output::read_png(result.expected);
    write(frame, "expected", expected);
    if (!result.comparison.same_size()) return;
    const int threshold = result.comparison.difference.changed > 0 ? test_.tolerance.channel.value_or(0) : 0;
    result.difference = write(frame, "difference", output::difference_picture(expected, actual, threshold));
}

fs::path EntryPictures::write(long frame, const char* kind, const output::Raster& picture) const {
    fs::path path = *test_.report / report_picture(test_.entry.name, frame, kind);
    output::require_within(path, *test_.report);
    output::ensure_directory(path.parent_path());
    output::FileTarget target = test_.report_files.target(path);
    target.within = *test_.report;
    output::write_file(target, output::encode_png(output::to_image(picture)), output::Durability::buffered);
    return path;
}

void EntryPictures::conclude() {
    EntryResult& result = test_.result;
    const ChangedFrames changed = result.changed_frames();
    const std::size_t expected = test_.references.pictures();
    result.picture = Verdict::identical;
    for (const auto& [number, frame] : changed) result.picture = std::max(*result.picture, frame->verdict);
    if (expected == 0) {
        result.picture_lines = {
            test_.references.is_updated()
                ? "no picture was accepted before"
                : fmt::format("no picture is accepted yet; use --update {}, then check the picture", test_.entry.name)};
    } else if (expected != result.frames.size()) {
        result.picture_lines = {
            fmt::format("{} drawn, {} expected", counted(result.frames.size(), "picture"), expected)};
        result.picture = Verdict::different;
    } else if (!changed.empty()) {
        result.picture_lines = {message(changed)};
    }
    if (test_.references.is_updated()) collect_update();
}

bool EntryPictures::adds_digests() const {
    return test_.result.picture && *test_.result.picture <= Verdict::equivalent && !digests_.contains(test_.renderer);
}

void EntryPictures::collect_update() {
    const bool identical = *test_.result.picture == Verdict::identical, keeps_pictures = identical || adds_digests();
    if (keeps_pictures)
        for (const auto& [number, frame] : test_.result.frames) test_.update.withdraw(picture_name(number));
    if (identical && digests_.contains(test_.renderer)) return test_.update.keep(kDigestsFile);
    Digests digests = keeps_pictures ? digests_ : Digests();
    digests[test_.renderer] = test_.result.digests();
    test_.update.put_digests(digests);
}

// Names the picture that changed most.
std::string EntryPictures::message(const ChangedFrames& changed) const {
    const auto& [number, worst] = changed.front();
    const std::size_t all = test_.result.frames.size();
    std::string text =
        all > 1 ? fmt::format("{} of {} pictures changed, number {} most: ", changed.size(), all, number) : "";
    text += worst->compared
                ? to_text(worst->comparison)
                : fmt::format("the reference {} does not exist", test_.references.file(picture_name(number)).string());
    if (!digests_.contains(test_.renderer))
        text += fmt::format("; drawn by libraries or fonts of which no digest is recorded, {} (beamcam doctor)",
                            test_.renderer);
    return text;
}

}  // namespace beamcam::scenes
