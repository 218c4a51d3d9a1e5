#include "scenes/regression/entry_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "output/film/picture_source.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

// The pictures of a file of expected pictures, taken approximately in the order of their numbers, from any thread.
class ExpectedPictures {
  public:
    // Throws IoError, MissingCodec.
    explicit ExpectedPictures(const std::string& file) : source_(file) {}

    std::optional<output::Raster> take(long frame) {
        const std::lock_guard lock(mutex_);
        output::Raster picture;
        std::string name;
        for (; next_ <= frame && source_.next(picture, name); ++next_) ahead_[next_] = picture;
        auto found = ahead_.extract(frame);
        return found ? std::optional(std::move(found.mapped())) : std::nullopt;
    }

    // Whether some were not taken.
    bool has_more() {
        const std::lock_guard lock(mutex_);
        output::Raster picture;
        std::string name;
        return !ahead_.empty() || source_.next(picture, name);
    }

  private:
    output::PictureSource source_;
    std::map<long, output::Raster> ahead_;  // read but not taken yet
    long next_ = 0;
    std::mutex mutex_;
};

EntryPictures::EntryPictures(const EntryContext& test) : test_(test) {}
EntryPictures::~EntryPictures() = default;

void EntryPictures::judge(long frame, const render::Image& image) {
    thread_local output::Raster raster;
    output::to_raster(image, raster);
    judge(frame, raster);
}

void EntryPictures::judge(long frame, const output::Raster& picture) {
    FrameResult result;
    result.sha256 = output::digest(picture);
    if (!test_.entry.expected.empty())
        compare_with_expected(frame, picture, result);
    else
        compare_with_accepted(frame, picture, result);
    write_actual(frame, picture, result);
    const std::lock_guard lock(mutex_);
    test_.result.frames[frame] = std::move(result);
}

void EntryPictures::compare_with_expected(long frame, const output::Raster& actual, FrameResult& result) {
    {
        const std::lock_guard lock(mutex_);
        if (!expected_) expected_ = std::make_unique<ExpectedPictures>(test_.entry.expected);
    }
    const std::optional<output::Raster> expected = expected_->take(frame);
    result.expected = test_.entry.expected;
    if (!expected) {
        result.verdict = Verdict::different;
        return;
    }
    result.compared = true;
    if (output::digest(*expected) == result.sha256) return;
    result.comparison = compare(*expected, actual, test_.tolerance.channel.value_or(0));
    result.verdict = is_within_tolerance(result.comparison) ? Verdict::equivalent : Verdict::different;
    report_difference(frame, *expected, actual, result);
}

void EntryPictures::compare_with_accepted(long frame, const output::Raster& actual, FrameResult& result) {
    const bool accepted = is_accepted(frame, result.sha256);
    if (!accepted) result.verdict = test_.entry.accepted.empty() ? Verdict::missing : Verdict::different;
    test_.references.read([&] {
        if (!accepted) return compare_with_reference(frame, actual, result);
        if (const std::string name = unaccepted_reference(frame); !name.empty()) {
            result.expected = test_.references.folder / name;
            result.reference_accepted = false;
            result.verdict = Verdict::different;
        }
    });
}

bool EntryPictures::is_within_tolerance(const PictureComparison& comparison) const {
    const output::PictureDifference& difference = comparison.difference;
    return comparison.same_size() && (difference.share() <= test_.tolerance.share.value_or(0) ||
                                      (test_.tolerance.ssim && difference.ssim >= *test_.tolerance.ssim));
}

bool EntryPictures::is_accepted(long frame, const std::string& digest) const {
    const auto at = static_cast<std::size_t>(frame);
    return std::ranges::any_of(test_.entry.accepted, [&](const Accepted& accepted) {
        return at < accepted.sha256.size() && accepted.sha256[at] == digest;
    });
}

// The name of a reference picture whose digest is not accepted; empty: there is none.
std::string EntryPictures::unaccepted_reference(long frame) const {
    std::vector<std::string> names{picture_name(frame)};
    for (const Accepted& accepted : test_.entry.accepted) names.push_back(picture_name(frame, accepted.renderer));
    for (const std::string& name : names) {
        const fs::path picture = test_.references.folder / name;
        if (!output::path_exists(picture)) continue;
        const ReferenceFile* file = test_.references.marked(name);
        const bool as_marked = file && output::sha256_of_file(picture) == file->sha256;
        if (!is_accepted(frame, as_marked ? file->pixels : output::digest(output::read_png(picture)))) return name;
    }
    return {};
}

fs::path EntryPictures::reference_of(long frame) const {
    const fs::path own = test_.references.folder / picture_name(frame, test_.renderer);
    return output::path_exists(own) ? own : test_.references.folder / picture_name(frame);
}

void EntryPictures::compare_with_reference(long frame, const output::Raster& actual, FrameResult& result) {
    const fs::path reference = reference_of(frame);
    if (!output::path_exists(reference)) return;
    const output::Raster expected = output::read_png(reference);
    result.expected = reference;
    result.compared = true;
    result.reference_accepted = test_.entry.accepted.empty() || is_accepted(frame, output::digest(expected));
    result.comparison = compare(expected, actual, test_.tolerance.channel.value_or(0));
    if (is_within_tolerance(result.comparison) && result.reference_accepted && !test_.entry.accepted.empty())
        result.verdict = Verdict::equivalent;
    report_difference(frame, expected, actual, result);
}

void EntryPictures::write_actual(long frame, const output::Raster& actual, FrameResult& result) {
    if (!test_.tested.folder || (result.verdict == Verdict::identical && !test_.tested.all)) return;
    const fs::path file = write(frame, "actual", actual);
    if (test_.tested.report) result.actual = file;
}

void EntryPictures::report_difference(long frame, const output::Raster& expected, const output::Raster& actual,
                                      FrameResult& result) {
    if (!test_.tested.report) return;
    write(frame, "expected", expected);
    if (!result.comparison.same_size()) return;
    const int threshold = result.comparison.difference.changed > 0 ? test_.tolerance.channel.value_or(0) : 0;
    result.difference = write(frame, "difference", output::difference_picture(expected, actual, threshold));
}

fs::path EntryPictures::write(long frame, const char* kind, const output::Raster& picture) {
    const output::Target target = test_.tested.file(report_picture(test_.entry.name, frame, kind).filename().string());
    output::write_file(target, output::encode_png(output::to_image(picture)), output::Durability::buffered);
    return target.path;
}

void EntryPictures::conclude() {
    Verdict verdict = Verdict::identical;
    const ChangedFrames changed = test_.result.changed_frames();
    for (const auto& [number, frame] : changed) verdict = std::max(verdict, frame->verdict);
    if (!test_.entry.expected.empty()) {
        if (!changed.empty()) test_.result.picture_lines = {message(changed)};
        if (expected_ && expected_->has_more()) {
            test_.result.picture_lines = {
                fmt::format("{} pictures were drawn; {} has more", test_.result.frames.size(), test_.entry.expected)};
            verdict = Verdict::different;
        }
    } else if (test_.entry.accepted.empty()) {
        test_.result.picture_lines = {
            fmt::format("no picture is accepted yet; use --update {}, then check the picture", test_.entry.name)};
        verdict = Verdict::missing;
    } else if (const std::size_t count = test_.entry.accepted.front().sha256.size();
               count != test_.result.frames.size()) {
        test_.result.picture_lines = {
            fmt::format("{} drawn, {} expected", counted(test_.result.frames.size(), "picture"), count)};
        verdict = Verdict::different;
    } else if (!changed.empty()) {
        test_.result.picture_lines = {message(changed)};
    }
    test_.result.picture = verdict;
    if (changed.empty()) return;
    const auto& [first, frame] = *std::ranges::min_element(changed);
    test_.result.new_digest = frame->sha256;
    const auto own = std::ranges::find(test_.entry.accepted, test_.renderer, &Accepted::renderer);
    const auto expected = own == test_.entry.accepted.end() ? test_.entry.accepted.begin() : own;
    const auto at = static_cast<std::size_t>(first);
    if (expected != test_.entry.accepted.end() && at < expected->sha256.size())
        test_.result.old_digest = expected->sha256[at];
}

// Names the picture that changed most.
std::string EntryPictures::message(const ChangedFrames& changed) const {
    const auto& [number, worst] = changed.front();
    if (!worst->reference_accepted)
        return fmt::format("{} is not the picture that was accepted: its digest is not in the entry",
                           worst->expected.string());
    const std::size_t all = test_.result.frames.size();
    const std::string which =
        all > 1 ? fmt::format("{} of {} pictures changed, number {} most: ", changed.size(), all, number) : "";
    if (worst->compared) return which + to_text(worst->comparison);
    return which + (test_.entry.expected.empty()
                        ? fmt::format("the reference {} does not exist",
                                      (test_.references.folder / picture_name(number)).string())
                        : fmt::format("{} has no picture {}", test_.entry.expected, number));
}

}  // namespace beamcam::scenes
