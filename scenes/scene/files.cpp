#include "scenes/scene/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace beamcam::scenes {
namespace {

std::string normal(std::string_view file) { return std::filesystem::path(file).lexically_normal().generic_string(); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Pattern {
    std::string before, after;
};
Pattern split_pattern(std::string_view file) {
    const std::size_t begin = file.find('#'), end = file.find_last_of('#') + 1;
    return {std::string(file.substr(0, begin)), std::string(file.substr(end))};
}

bool matches(const Pattern& pattern, std::string_view file) {
    if (file.size() <= pattern.before.size() + pattern.after.size() || !file.starts_with(pattern.before) ||
        !file.ends_with(pattern.after))
        return false;
    const std::string_view digits =
        file.substr(pattern.before.size(), file.size() - pattern.before.size() - pattern.after.size());
    return std::ranges::all_of(digits, is_digit);
}

// Every pattern whose numbered files could include this one: any run of digits in its last part may be the number.
template <typename Visit>
void for_patterns(const std::string& file, Visit visit) {
    const std::size_t slash = file.rfind('/');
    for (std::size_t i = slash == std::string::npos ? 0 : slash + 1; i < file.size(); ++i)
        for (std::size_t k = i; k < file.size() && is_digit(file[k]); ++k)
            visit(file.substr(0, i) + '#' + file.substr(k + 1));
}

template <typename Visit>
void for_directories(const std::string& file, Visit visit) {
    for (std::size_t slash = file.find('/'); slash != std::string::npos; slash = file.find('/', slash + 1))
        visit(file.substr(0, slash));
}

// The claims, indexed by everything that can clash; each entry is the first claim.
class ClaimIndex {
  public:
    using Claim = FileClaims::Claim;

    explicit ClaimIndex(const std::vector<Claim>& claims) {
        for (const Claim& claim : claims)
            if (is_numbered(claim.file)) patterns_.try_emplace(pattern_of(claim), &claim);
        for (const Claim& claim : claims) {
            if (is_numbered(claim.file)) continue;
            const std::string path = normal(claim.file);
            files_.try_emplace(path, &claim);
            for_directories(path, [&](const std::string& directory) { directories_.try_emplace(directory, &claim); });
            if (patterns_.empty()) continue;
            for_patterns(path, [&](const std::string& pattern) {
                if (patterns_.contains(pattern)) numbered_.try_emplace(pattern, &claim);
            });
        }
    }

    // The earliest claim of another owner that this one clashes with, if it came before; else null.
    const Claim* earlier(const Claim& claim) const {
        const Claim* found = nullptr;
        const auto look = [&](const Index& index, const std::string& key) {
            const auto entry = index.find(key);
            if (entry != index.end() && entry->second->owner < (found != nullptr ? found->owner : claim.owner))
                found = entry->second;
        };
        if (is_numbered(claim.file)) {
            look(patterns_, pattern_of(claim));
            look(numbered_, pattern_of(claim));
            return found;
        }
        const std::string path = normal(claim.file);
        look(files_, path);
        look(directories_, path);
        for_directories(path, [&](const std::string& directory) { look(files_, directory); });
        if (!patterns_.empty()) for_patterns(path, [&](const std::string& pattern) { look(patterns_, pattern); });
        return found;
    }

  private:
    using Index = std::map<std::string, const Claim*>;

    static std::string pattern_of(const Claim& claim) {
        const Pattern parts = split_pattern(normal(claim.file));
        return parts.before + '#' + parts.after;
    }

    Index files_, directories_, patterns_;
    Index numbered_;  // files that a pattern of this key includes
};

}  // namespace

std::string problem_with_file(std::string_view file) {
    if (file.empty()) return "the name is empty; write one, or remove the key";
    if (std::ranges::any_of(file, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        return "the name contains a control character; remove it";
    const std::filesystem::path path(file);
    if (path.is_absolute()) return "the path is absolute; write it relative to the output directory, which -o selects";
    for (const auto& part : path)
        if (part == "..")
            return "the path leaves the output directory; remove \"..\", and select the directory with -o";
    if (!path.has_filename() || path.filename() == ".") return "the path is a directory; write the name of a file";
    if (path.stem().empty() || path.filename().string().starts_with("."))
        return "the name is only an ending; write a name before it";
    // ext4, xfs and tmpfs end at 255 bytes; the temporary name beside it needs some of them.
    if (path.filename().string().size() > 200) return "the name is longer than 200 bytes; shorten it";
    return {};
}

bool is_numbered(std::string_view file) { return file.find('#') != std::string_view::npos; }

std::string problem_with_numbering(std::string_view file) {
    if (!is_numbered(file)) return "a sequence needs '#' for the frame number, for example \"fall-####.png\"";
    const std::size_t begin = file.find('#'), end = file.find_last_of('#') + 1;
    if (file.substr(begin, end - begin).find_first_not_of('#') != std::string_view::npos)
        return "'#' occurs in two places; write one run of '#'";
    if (file.find('/', begin) != std::string_view::npos)
        return "'#' is in the name of a directory; write it in the name of the file";
    if (end - begin > 9) return "more than nine '#'; write fewer";
    return {};
}

std::string numbered_file(std::string_view pattern, long number) {
    const auto width = static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '#'));
    const Pattern parts = split_pattern(pattern);
    return fmt::format("{}{:0{}}{}", parts.before, number, width, parts.after);
}

std::optional<long> number_of(std::string_view pattern, std::string_view file) {
    const Pattern parts = split_pattern(pattern);
    if (!matches(parts, file)) return {};
    const std::string_view digits =
        file.substr(parts.before.size(), file.size() - parts.before.size() - parts.after.size());
    if (digits.size() > 9) return {};  // no sequence is that long
    long number = 0;
    for (const char digit : digits) number = 10 * number + (digit - '0');
    return numbered_file(pattern, number) == file ? std::optional(number) : std::nullopt;
}

void FileClaims::add(std::string_view file, std::size_t owner) { claims_.push_back({std::string(file), owner}); }

std::vector<FileClaims::Clash> FileClaims::clashes() const {
    const ClaimIndex index(claims_);
    std::vector<Clash> found;
    for (const Claim& claim : claims_) {
        if (!found.empty() && found.back().later.owner == claim.owner) continue;
        if (const Claim* earlier = index.earlier(claim)) found.push_back({claim, *earlier});
    }
    return found;
}

std::string Shard::text() const { return fmt::format("{}/{}", number, count); }

std::string shard_file(const std::string& file, const Shard& shard) {
    const std::filesystem::path path(file);
    return (path.parent_path() /
            fmt::format("{}.{}of{}{}", path.stem().string(), shard.number, shard.count, path.extension().string()))
        .string();
}

}  // namespace beamcam::scenes
