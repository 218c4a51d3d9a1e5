#include "scenes/format/scene_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenes/format/keys.hpp"
#include "scenes/format/reader.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// A comparison of comparisons is as deep as anyone goes; each level takes some kilobytes of the stack.
constexpr std::size_t kLongestChain = 16;
// Five hundred pictures of eight motions.
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
    const bool ring = first != chain_.end();
    if (!ring && chain_.size() < kLongestChain) return {};
    std::string names;
    for (auto link = ring ? first : chain_.begin(); link != chain_.end(); ++link) names += link->name + " → ";
    return ring ? fmt::format(
                      "the comparison is a ring ({}{}); a scene cannot be compared with itself, leave out "
                      "\"scene\" to compare it with changes of its own",
                      names, path)
                : fmt::format("more than {} scenes compare one another in a chain ({}{})", kLongestChain, names, path);
}

const SceneFiles::Mechanics& SceneFiles::mechanics(const std::string& path) {
    const fs::path file = identity_of(path);
    if (const auto found = read_.find(file); found != read_.end()) return found->second;
    Mechanics made;
    made.problem = chain_problem(file, path);
    if (made.problem.empty() && read_.size() >= kMostFiles)
        made.problem = fmt::format("it is the {}th other scene; {} are the most", read_.size() + 1, kMostFiles);
    if (!made.problem.empty()) {
        if (chain_problem_.empty()) chain_problem_ = made.problem;
    } else {
        const std::string elsewhere = std::exchange(chain_problem_, {});
        made = read(path);
        // What ended the chain is the reason for every file in it.
        if (!made.sections && !chain_problem_.empty()) made.problem = chain_problem_;
        if (chain_problem_.empty()) chain_problem_ = elsewhere;
    }
    return read_.insert_or_assign(file, std::move(made)).first->second;
}

SceneFiles::Mechanics SceneFiles::read(const std::string& path) {
    try {
        Reading reading = read_scene(load_named_source(path), {}, *this);
        if (reading.scene) return {mechanics_of(reading.root), {}};
        return {{}, fmt::format("it is not a scene; `beamcam check {}` gives the reasons", path)};
    } catch (const UnreadableFile& unreadable) {
        return {{}, unreadable.what()};
    }
}

}  // namespace beamcam::scenes
