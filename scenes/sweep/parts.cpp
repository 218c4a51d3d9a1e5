#include "scenes/sweep/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "output/data/point_store.hpp"
#include "output/files/numbers.hpp"
#include "output/json/tree.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::uint64_t kMostParts = 1'000'000;

Shard checked_shard(std::uint64_t number, std::uint64_t parts, const std::string& option) {
    if (parts < 1 || parts > kMostParts || number < 1 || number > parts)
        throw UsageError(fmt::format("--shard {}: write I/N with 1 <= I <= N, for example 2/3, or auto", option));
    return {number, parts};
}

// A part: its file, and the description in its head (see head_of).
struct Part {
    std::filesystem::path file;
    std::unique_ptr<output::PointFile> points;
    std::string program, sweep, scene;
    Shard shard;
};

Part open_part(const std::filesystem::path& file) {
    Part found{file, std::make_unique<output::PointFile>(file), {}, {}, {}, {}};
    const Parsed description = parse(found.points->head().description);
    const auto text = [&](const char* key) {
        const bool object = description.is_json && description.root.kind == Node::Kind::object;
        const Member* member = object ? description.root.find(key) : nullptr;
        if (!member || member->value.kind != Node::Kind::string)
            throw output::IoError(file.string() + ": not a part of a sweep, or it is damaged");
        return member->value.text;
    };
    found.program = text("program");
    found.sweep = text("sweep");
    found.scene = text("scene");
    try {
        found.shard = shard_of(text("part"), [](const char*) { return nullptr; });
    } catch (const UsageError&) {
        throw output::IoError(file.string() + ": not a part of a sweep, or it is damaged");
    }
    return found;
}

// Requires each number from 1 to N once, all of the same sweep.
void require_complete(const std::vector<Part>& parts) {
    const Part& first = parts.front();
    std::map<std::uint64_t, const Part*> found;
    for (const Part& part : parts) {
        if (part.sweep != first.sweep || part.program != first.program)
            throw output::IoError(fmt::format("{}: part of another {} than {}", part.file.string(),
                                              part.sweep != first.sweep ? "sweep" : "program version",
                                              first.file.string()));
        if (part.shard.count != first.shard.count)
            throw output::IoError(fmt::format("{}: one of {} parts, but {} is one of {}", part.file.string(),
                                              part.shard.count, first.file.string(), first.shard.count));
        if (const auto [there, added] = found.emplace(part.shard.number, &part); !added)
            throw output::IoError(
                fmt::format("{}: the same part as {}", part.file.string(), there->second->file.string()));
    }
    std::vector<std::uint64_t> missing;
    for (std::uint64_t number = 1; number <= first.shard.count; ++number)
        if (!found.contains(number)) missing.push_back(number);
    if (!missing.empty())
        throw output::IoError(fmt::format(
            "these of {} parts are missing: {}", first.shard.count,
            fmt::join(missing.begin(),
                      missing.begin() + std::ssize(missing) - std::max<std::ptrdiff_t>(0, std::ssize(missing) - 20),
                      ", ")));
}

}  // namespace

Shard shard_of(const std::string& text, const std::function<const char*(const char*)>& variable) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const std::string head = text.substr(0, slash), tail = text.substr(std::min(slash + 1, text.size()));
    const auto parts = output::number_in<std::uint64_t>(tail);
    if (head != "auto")
        return checked_shard(output::number_in<std::uint64_t>(head).value_or(0), parts.value_or(0), text);
    const auto value = [&](const char* name) {
        const char* found = variable(name);
        return output::number_in<std::uint64_t>(found ? found : "");
    };
    const auto number = value("SLURM_ARRAY_TASK_ID");
    if (!number)
        throw UsageError(fmt::format(
            "--shard {}: this is not an array task of Slurm, since SLURM_ARRAY_TASK_ID is not set; write I/N", text));
    const std::uint64_t first = value("SLURM_ARRAY_TASK_MIN").value_or(1),
                        step = std::max<std::uint64_t>(1, value("SLURM_ARRAY_TASK_STEP").value_or(1));
    const auto count = parts ? parts : value("SLURM_ARRAY_TASK_COUNT");
    if (!count)
        throw UsageError(
            fmt::format("--shard {}: SLURM_ARRAY_TASK_ID is set, but not SLURM_ARRAY_TASK_COUNT; write auto/N", text));
    return checked_shard(*number < first ? 0 : (*number - first) / step + 1, *count, text);
}

CollectedSweep collect(const std::vector<std::filesystem::path>& files) {
    auto parts = std::make_shared<std::vector<Part>>();
    for (const std::filesystem::path& file : files) parts->push_back(open_part(file));
    require_complete(*parts);
    const Part& first = parts->front();
    Reading reading = read_scene({"scene of " + first.file.string(), first.scene, true});
    if (!reading.scene || !reading.scene->sweep)
        throw output::IoError(first.file.string() + ": its scene is no sweep of this version of beamcam");
    const SweepGrid grid(*reading.scene);
    if (grid.digest() != first.sweep) throw output::IoError(first.file.string() + ": its scene is of another sweep");
    for (const Part& part : *parts) part.points->find_points(shape_of(grid));
    CollectedSweep out{std::move(*reading.scene), data_of(grid, Shard())};
    // The part of each point.
    auto owner = std::make_shared<std::vector<std::uint32_t>>(grid.points(), 0);
    for (std::uint64_t point = 0; point < owner->size(); ++point) {
        const auto found = std::ranges::find_if(*parts, [&](const Part& part) { return part.points->has(point); });
        if (found == parts->end())
            throw output::IoError(fmt::format("point {} is missing in all parts; one of them is not finished", point));
        (*owner)[point] = static_cast<std::uint32_t>(found - parts->begin());
    }
    const auto part_of = [parts, owner](std::uint64_t point) -> const output::PointFile& {
        return *(*parts)[(*owner)[point]].points;
    };
    out.data.has = [](std::uint64_t) { return true; };
    out.data.rows = [part_of, width = out.data.columns.size()](std::uint64_t point) {
        return part_of(point).numbers(point) / width;
    };
    out.data.read = [part_of](std::uint64_t point) { return part_of(point).read(point); };
    return out;
}

}  // namespace beamcam::scenes
