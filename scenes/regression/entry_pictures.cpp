#include "scenes/regression/entry_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

std::optional<output::Raster> ExpectedPictures::take(long frame) {
    const std::lock_guard lock(mutex_);
    output::Raster picture;
    std::string name;
    for (; next_ <= frame && source_.next(picture, name); ++next_) ahead_[next_] = picture;
    const auto found = ahead_.find(frame);
    if (found == ahead_.end()) return std::nullopt;
    std::optional<output::Raster> taken = std::move(found->second);
    ahead_.erase(found);
    return taken;
}

bool ExpectedPictures::has_more() {
    const std::lock_guard lock(mutex_);
    output::Raster picture;
    std::string name;
    return !ahead_.empty() || source_.next(picture, name);
}

void EntryPictures::judge(long frame, const render::Image& image) {
    thread_local output::Raster raster;
    output::to_raster(image, raster);
    judge(frame, raster);
}

void EntryPictures::judge(long frame, const output::Raster& picture) {
    FrameResult result;
    result.sha256 = output::digest(picture);
    if (!entry_.expected.empty())
        compare_with_expected(frame, picture, result);
    else
        compare_with_accepted(frame, picture, result);
    const std::lock_guard lock(mutex_);
    result_.frames[frame] = std::move(result);
}

void EntryPictures::compare_with_expected(long frame, const output::Raster& actual, FrameResult& result) {
    {
        const std::lock_guard lock(mutex_);
        if (!expected_) expected_ = std::make_unique<ExpectedPictures>(entry_.expected);
    }
    const std::optional<output::Raster> expected = expected_->take(frame);
    result.expected = entry_.expected;
    if (!expected) {
        result.verdict = Verdict::different;
        return report_actual(frame, actual, result);
    }
    result.compared = true;
    if (output::digest(*expected) == result.sha256) return;
    result.comparison = compare(*expected, actual, tolerance_.channel.value_or(0));
    result.verdict = is_within_tolerance(result.comparison) ? Verdict::equivalent : Verdict::different;
    report_difference(frame, *expected, actual, result);
}

void EntryPictures::compare_with_accepted(long frame, const output::Raster& actual, FrameResult& result) {
    const bool accepted = is_accepted(frame, result.sha256);
    if (!accepted) result.verdict = entry_.accepted.empty() ? Verdict::missing : Verdict::different;
    references_.read([&] {
        if (!accepted) return compare_with_reference(frame, actual, result);
        if (const std::string name = unaccepted_reference(frame); !name.empty()) {
            result.expected = references_.folder / name;
            result.reference_accepted = false;
            result.verdict = Verdict::different;
            report_actual(frame, actual, result);
        }
    });
    write_reference(frame, actual, result);
}

// An update stores all pictures; a new renderer adds those that differ from the pictures of the first renderer.
void EntryPictures::write_reference(long frame, const output::Raster& actual, const FrameResult& result) {
    if (references_.is_replaced()) {
        output::write_png(references_.new_folder() / picture_name(frame), output::to_image(actual));
    } else if (references_.is_extended()) {
        const std::vector<std::string>& first = entry_.accepted.front().sha256;
        const auto at = static_cast<std::size_t>(frame);
        if (at < first.size() && first[at] == result.sha256) return;
        output::write_png(references_.new_folder() / picture_name(frame, renderer_), output::to_image(actual));
    }
}

bool EntryPictures::is_within_tolerance(const PictureComparison& comparison) const {
    const output::PictureDifference& difference = comparison.difference;
    return comparison.same_size() && (difference.share() <= tolerance_.share.value_or(0) ||
                                      (tolerance_.ssim && difference.ssim >= *tolerance_.ssim));
}

bool EntryPictures::is_accepted(long frame, const std::string& digest) const {
    const auto at = static_cast<std::size_t>(frame);
    return std::ranges::any_of(entry_.accepted, [&](const Accepted& accepted) {
        return at < accepted.sha256.size() && accepted.sha256[at] == digest;
    });
}

// The name of a reference picture whose digest is not accepted; empty: there is none.
std::string EntryPictures::unaccepted_reference(long frame) const {
    std::vector<std::string> names{picture_name(frame)};
    for (const Accepted& accepted : entry_.accepted) names.push_back(picture_name(frame, accepted.renderer));
    for (const std::string& name : names) {
        const fs::path picture = references_.folder / name;
        if (!output::path_exists(picture)) continue;
        const ReferenceFile* file = references_.marked(name);
        const bool as_marked = file && output::sha256_of_file(picture) == file->sha256;
        if (!is_accepted(frame, as_marked ? file->pixels : output::digest(output::read_png(picture)))) return name;
    }
    return {};
}

fs::path EntryPictures::reference_of(long frame) const {
    const fs::path own = references_.folder / picture_name(frame, renderer_);
    return output::path_exists(own) ? own : references_.folder / picture_name(frame);
}

void EntryPictures::compare_with_reference(long frame, const output::Raster& actual, FrameResult& result) {
    const fs::path reference = reference_of(frame);
    if (!output::path_exists(reference)) return report_actual(frame, actual, result);
    const output::Raster expected = output::read_png(reference);
    result.expected = reference;
    result.compared = true;
    result.reference_accepted = entry_.accepted.empty() || is_accepted(frame, output::digest(expected));
    result.comparison = compare(expected, actual, tolerance_.channel.value_or(0));
    if (is_within_tolerance(result.comparison) && result.reference_accepted && !entry_.accepted.empty())
        result.verdict = Verdict::equivalent;
    report_difference(frame, expected, actual, result);
}

void EntryPictures::report_actual(long frame, const output::Raster& actual, FrameResult& result) {
    if (report_.folder) result.actual = report(frame, "actual", actual);
}

void EntryPictures::report_difference(long frame, const output::Raster& expected, const output::Raster& actual,
                                      FrameResult& result) {
    if (!report_.folder) return;
    report_actual(frame, actual, result);
    report(frame, "expected", expected);
    if (!result.comparison.same_size()) return;
    const int threshold = result.comparison.difference.changed > 0 ? tolerance_.channel.value_or(0) : 0;
    result.difference = report(frame, "difference", output::difference_picture(expected, actual, threshold));
}

fs::path EntryPictures::report(long frame, const char* kind, const output::Raster& picture) {
    const output::Target target = report_.file(report_picture(entry_.name, frame, kind).filename().string());
    output::write_file(target, output::encode_png(output::to_image(picture)), output::Durability::buffered);
    return target.path;
}

std::map<std::string, std::string> EntryPictures::new_pictures(bool all) const {
    std::map<std::string, std::string> digests;
    for (const auto& [number, frame] : result_.frames)
        digests[all ? picture_name(number) : picture_name(number, renderer_)] = frame.sha256;
    return digests;
}

void EntryPictures::conclude() {
    Verdict verdict = Verdict::identical;
    for (const auto& [number, frame] : result_.frames) verdict = worse(verdict, frame.verdict);
    if (!entry_.expected.empty()) {
        if (const auto* worst = result_.worst()) result_.picture_lines = {message(*worst)};
        if (expected_ && expected_->has_more()) {
            result_.picture_lines = {
                fmt::format("{} pictures were drawn; {} has more", result_.frames.size(), entry_.expected)};
            verdict = Verdict::different;
        }
    } else if (entry_.accepted.empty()) {
        result_.picture_lines = {
            fmt::format("no picture is accepted yet; use --update {}, then check the picture", entry_.name)};
        verdict = Verdict::missing;
    } else if (const std::size_t count = entry_.accepted.front().sha256.size(); count != result_.frames.size()) {
        result_.picture_lines = {fmt::format("{} pictures were expected, {} were drawn", count, result_.frames.size())};
        verdict = Verdict::different;
    } else if (const auto* worst = result_.worst()) {
        result_.picture_lines = {message(*worst)};
    }
    result_.picture = verdict;
    const auto changed =
        std::ranges::find_if(result_.frames, [](const auto& f) { return f.second.verdict != Verdict::identical; });
    if (changed == result_.frames.end()) return;
    result_.new_digest = changed->second.sha256;
    const auto own = std::ranges::find(entry_.accepted, renderer_, &Accepted::renderer);
    const auto expected = own == entry_.accepted.end() ? entry_.accepted.begin() : own;
    const auto at = static_cast<std::size_t>(changed->first);
    if (expected != entry_.accepted.end() && at < expected->sha256.size()) result_.old_digest = expected->sha256[at];
}

std::string EntryPictures::message(const std::pair<const long, FrameResult>& worst) const {
    const std::size_t changed = result_.frames.size() - result_.frames_with(Verdict::identical);
    if (!worst.second.reference_accepted)
        return fmt::format("{} is not the picture that was accepted: its digest is not in the entry",
                           worst.second.expected.string());
    const std::string which =
        result_.frames.size() > 1
            ? fmt::format("{} of {} pictures changed, number {} most: ", changed, result_.frames.size(), worst.first)
            : "";
    if (!worst.second.compared && !entry_.expected.empty())
        return which + fmt::format("{} has no picture {}", entry_.expected, worst.first);
    if (!worst.second.compared)
        return which + fmt::format("the reference {} does not exist",
                                   (references_.folder / picture_name(worst.first)).string());
    return which + to_text(worst.second.comparison);
}

}  // namespace beamcam::scenes
