#include "scenes/scene/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "output/files/numbers.hpp"

namespace beamcam::scenes {
namespace {

std::string normal(std::string_view file) { return std::filesystem::path(file).lexically_normal().generic_string(); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The parts of a name such as "fall-####.png" before and after the number.
struct NumberedName {
    explicit NumberedName(std::string_view pattern)
        : before(pattern.substr(0, pattern.find('#'))), after(pattern.substr(pattern.find_last_of('#') + 1)) {}
    std::string before, after;
};

std::string pattern_of(std::string_view file) {
    const NumberedName parts(normal(file));
    return parts.before + '#' + parts.after;
}

// What a claim takes, and what none may have taken before it: a file "a/b", a directory "a/", a pattern "f-#.png", and
// "f-#.png/" for every claimed pattern that includes the file.
struct ClaimKeys {
    std::vector<std::string> takes, excludes;
};

ClaimKeys keys_of(const std::string& file, const std::set<std::string>& patterns) {
    if (is_numbered(file)) {
        const std::string pattern = pattern_of(file);
        return {{pattern}, {pattern, pattern + '/'}};
    }
    const std::string path = normal(file);
    ClaimKeys keys{{path}, {path, path + '/'}};
    std::size_t last = 0;  // begin of the last part
    for (std::size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', last)) {
        keys.takes.push_back(path.substr(0, slash + 1));
        keys.excludes.push_back(path.substr(0, slash));
        last = slash + 1;
    }
    for (std::size_t i = last; !patterns.empty() && i < path.size(); ++i)  // any run of digits may be the number
        for (std::size_t k = i; k < path.size() && is_digit(path[k]); ++k) {
            const std::string pattern = path.substr(0, i) + '#' + path.substr(k + 1);
            if (!patterns.contains(pattern)) continue;
            keys.takes.push_back(pattern + '/');
            keys.excludes.push_back(pattern);
        }
    return keys;
}

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

const char* kind_without_scene(std::string_view ending) {
    static constexpr std::pair<std::string_view, const char*> kKinds[] = {
        {".csv", "table"},   {".npz", "table"},      {".nc", "NetCDF table"}, {".points", "part of a sweep"},
        {".json", "record"}, {".gif", "film"},       {".webp", "film"},       {".pdf", "PDF figure"},
        {".html", "page"},   {".svg", "SVG figure"}, {".txt", "caption"},     {".md", "caption"}};
    const auto found = std::ranges::find(kKinds, ending, &std::pair<std::string_view, const char*>::first);
    return found == std::end(kKinds) ? nullptr : found->second;
}

std::string ending_of(const std::filesystem::path& file) { return file.extension().string(); }

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
    const NumberedName parts(pattern);
    return fmt::format("{}{:0{}}{}", parts.before, number, width, parts.after);
}

std::optional<long> number_of(std::string_view pattern, std::string_view file) {
    const NumberedName parts(pattern);
    const std::size_t others = parts.before.size() + parts.after.size();
    if (file.size() <= others) return std::nullopt;
    const auto number = output::number_in<long>(file.substr(parts.before.size(), file.size() - others));
    return number && *number >= 0 && numbered_file(pattern, *number) == file ? number : std::nullopt;
}

void FileClaims::add(std::string_view file, std::size_t owner) { claims_.push_back({std::string(file), owner}); }

std::vector<FileClaims::Clash> FileClaims::clashes() const {
    std::set<std::string> patterns;
    for (const Claim& claim : claims_)
        if (is_numbered(claim.file)) patterns.insert(pattern_of(claim.file));
    std::map<std::string, const Claim*> taken;  // by the first
    std::vector<Clash> found;
    for (const Claim& claim : claims_) {
        const ClaimKeys keys = keys_of(claim.file, patterns);
        const Claim* earlier = &claim;
        for (const std::string& key : keys.excludes)
            if (const auto other = taken.find(key); other != taken.end() && other->second->owner < earlier->owner)
                earlier = other->second;
        if (earlier != &claim && (found.empty() || found.back().later.owner != claim.owner))
            found.push_back({claim, *earlier});
        for (const std::string& key : keys.takes) taken.try_emplace(key, &claim);
    }
    return found;
}

std::string Shard::text() const { return fmt::format("{}/{}", number, count); }

std::string part_file(const std::string& file, const Shard& shard) {
    const std::filesystem::path path(file);
    return (path.parent_path() / fmt::format("{}.{}of{}.points", path.stem().string(), shard.number, shard.count))
        .string();
}

}  // namespace beamcam::scenes
