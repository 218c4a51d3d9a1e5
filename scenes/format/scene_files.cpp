#include "scenes/format/scene_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenes/format/keys.hpp"
#include "scenes/format/reader.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Nested comparisons; each level needs some kilobytes of stack.
constexpr std::size_t kLongestChain = 16;
// Enough for five hundred pictures of eight motions.
constexpr std::size_t kMostFiles = 4096;

fs::path identity_of(const std::string& path) {
    std::error_code error;
    fs::path file = fs::weakly_canonical(path, error);
    return error ? fs::path(path) : file;
}

}  // namespace

const std::vector<std::string>& mechanics_sections() {
    static const std::vector<std::string> kSections = [] {
        std::vector<std::string> all;
        for (const Member& section : to_tree(sim::Problem{}).members) all.push_back(section.key);
        return all;
    }();
    return kSections;
}

bool is_mechanics(std::string_view section) {
    return std::ranges::find(mechanics_sections(), section) != mechanics_sections().end();
}

Node mechanics_of(const Node& root) {
    Node out = object_node();
    out.place = root.place;
    for (const Member& member : root.members)
        if (is_mechanics(member.key)) out.members.add(member);
    return out;
}

SceneFiles::BeingRead::BeingRead(SceneFiles& files, const std::string& path) : files_(files) {
    files.chain_.push_back({identity_of(path), path});
}

std::string SceneFiles::chain_problem(const fs::path& file, const std::string& path) const {
    const auto first = std::ranges::find(chain_, file, &Link::file);
    const bool cycle = first != chain_.end();
    if (!cycle && chain_.size() < kLongestChain) return {};
    std::string names;
    for (auto link = cycle ? first : chain_.begin(); link != chain_.end(); ++link) names += link->name + " → ";
    return cycle ? fmt::format(
                       "the comparison is a cycle ({}{}); leave out \"scene\" to compare a scene with a changed copy "
                       "of itself",
                       names, path)
                 : fmt::format("more than {} scenes compare one another in a chain ({}{})", kLongestChain, names, path);
}

const SceneFiles::Mechanics& SceneFiles::mechanics(const std::string& path) {
    const fs::path file = identity_of(path);
    if (const auto found = read_.find(file); found != read_.end()) return found->second;
    Mechanics read_now;
    read_now.problem = chain_problem(file, path);
    if (read_now.problem.empty() && read_.size() >= kMostFiles)
        read_now.problem =
            fmt::format("too many other scenes: {}; a scene compares at most {}", read_.size() + 1, kMostFiles);
    if (!read_now.problem.empty()) {
        if (chain_problem_.empty()) chain_problem_ = read_now.problem;
    } else {
        const std::string elsewhere = std::exchange(chain_problem_, {});
        read_now = read(path);
        // The problem that ended the chain applies to every file in it.
        if (!read_now.sections && !chain_problem_.empty()) read_now.problem = chain_problem_;
        if (chain_problem_.empty()) chain_problem_ = elsewhere;
    }
    return read_.insert_or_assign(file, std::move(read_now)).first->second;
}

SceneFiles::Mechanics SceneFiles::read(const std::string& path) {
    try {
        Reading reading = read_scene(load_named_source(path), {}, *this);
        if (reading.scene) return {mechanics_of(reading.root), {}};
        return {{}, fmt::format("it is not a valid scene; `beamcam check {}` lists its errors", path)};
    } catch (const UnreadableFile& unreadable) {
        return {{}, unreadable.what()};
    }
}

}  // namespace beamcam::scenes
