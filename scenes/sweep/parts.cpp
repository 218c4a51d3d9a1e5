#include "scenes/sweep/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "output/data/netcdf_library.hpp"
#include "output/files/numbers.hpp"
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

// The variables of an engine: number of the task, first, last, count, step.
struct ArrayTask {
    const char *number, *first, *last, *count, *step;
};
constexpr ArrayTask kArrayTasks[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_COUNT",
     "SLURM_ARRAY_TASK_STEP"},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", nullptr, "SGE_TASK_STEPSIZE"},
    {"PBS_ARRAY_INDEX", nullptr, nullptr, nullptr, nullptr},
    {"PBS_ARRAYID", nullptr, nullptr, nullptr, nullptr},
};

// The file of one part.
struct Part {
    std::filesystem::path file;
    output::SweepData data;
    Shard shard;
};

Part open_part(const std::filesystem::path& file) {
    Part found{file, output::netcdf_library().open(file), {}};
    const std::string *which = found.data.attribute("beamcam_part"), *scene = found.data.attribute("beamcam_scene");
    if (!scene) throw output::IoError(file.string() + ": not a sweep of beamcam");
    if (!which) throw output::IoError(file.string() + ": a complete sweep, not a part");
    found.shard = shard_of(*which, [](const char*) { return nullptr; });
    return found;
}

// Requires each number from 1 to N once, all of the same sweep.
void require_complete(const std::vector<Part>& parts) {
    const Part& first = parts.front();
    std::map<std::uint64_t, const Part*> found;
    for (const Part& part : parts) {
        for (const char* name : {"beamcam_sweep", "beamcam_program"}) {
            const std::string *one = first.data.attribute(name), *other = part.data.attribute(name);
            if (!one || !other || *one != *other)
                throw output::IoError(fmt::format(
                    "{}: part of another {} than {}", part.file.string(),
                    std::string_view(name) == "beamcam_sweep" ? "sweep" : "program version", first.file.string()));
        }
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

// A command as a Python string of a Snakefile, with escaped braces.
std::string in_snakefile(const std::string& command) {
    std::string text;
    for (const char c : command) {
        if (c == '{' || c == '}') text += c;
        if (c == '"' || c == '\\') text += '\\';
        text += c;
    }
    return text;
}

}  // namespace

Shard shard_of(const std::string& text, const std::function<const char*(const char*)>& variable) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const std::string head = text.substr(0, slash), tail = text.substr(std::min(slash + 1, text.size()));
    const auto parts = output::number_in<std::uint64_t>(tail);
    if (head != "auto")
        return checked_shard(output::number_in<std::uint64_t>(head).value_or(0), parts.value_or(0), text);
    const auto value = [&](const char* name) -> std::optional<std::uint64_t> {
        const char* found = name ? variable(name) : nullptr;
        return output::number_in<std::uint64_t>(found ? found : "");
    };
    for (const ArrayTask& task : kArrayTasks) {
        const auto number = value(task.number);
        if (!number) continue;
        const std::uint64_t first = value(task.first).value_or(1),
                            step = std::max<std::uint64_t>(1, value(task.step).value_or(1));
        std::optional<std::uint64_t> count = parts;
        if (!count) count = value(task.count);
        if (!count && value(task.last)) count = (*value(task.last) - first) / step + 1;
        if (!count)
            throw UsageError(
                fmt::format("--shard {}: {} is set, but not the number of tasks; write auto/N", text, task.number));
        return checked_shard(*number < first ? 0 : (*number - first) / step + 1, *count, text);
    }
    throw UsageError(
        fmt::format("--shard {}: this is not an array task, since SLURM_ARRAY_TASK_ID, SGE_TASK_ID and PBS_ARRAY_INDEX "
                    "are not set; write I/N",
                    text));
}

CollectedSweep collect(const std::vector<std::filesystem::path>& files) {
    auto parts = std::make_shared<std::vector<Part>>();
    for (const std::filesystem::path& file : files) parts->push_back(open_part(file));
    require_complete(*parts);
    Reading reading =
        read_scene({"scene of " + files.front().string(), *parts->front().data.attribute("beamcam_scene"), true});
    if (!reading.scene || !reading.scene->sweep)
        throw output::IoError(files.front().string() + ": its scene has no sweep");
    CollectedSweep out{std::move(*reading.scene), parts->front().data};
    std::erase_if(out.data.attributes, [](const auto& each) { return each.first == "beamcam_part"; });
    // The part of each point.
    auto owner = std::make_shared<std::vector<std::uint32_t>>(out.data.points(), 0);
    for (std::uint64_t point = 0; point < owner->size(); ++point) {
        const auto found = std::ranges::find_if(*parts, [&](const Part& part) { return part.data.has(point); });
        if (found == parts->end())
            throw output::IoError(fmt::format("point {} is missing in all parts; one of them is not finished", point));
        (*owner)[point] = static_cast<std::uint32_t>(found - parts->begin());
    }
    out.data.has = [](std::uint64_t) { return true; };
    out.data.rows = [parts, owner](std::uint64_t point) { return (*parts)[(*owner)[point]].data.rows(point); };
    out.data.read = [parts, owner](std::uint64_t point) { return (*parts)[(*owner)[point]].data.read(point); };
    return out;
}

std::string engine_script(const std::string& engine, const std::string& command, const std::string& file, int parts) {
    const std::filesystem::path path = file;
    const std::string stem = (path.parent_path() / path.stem()).string(), ending = path.extension().string();
    const std::string all = fmt::format("{}.*of{}{}", stem, parts, ending);
    if (engine == "slurm")
        return fmt::format(
            "#!/bin/sh\n#SBATCH --job-name=sweep\n#SBATCH --array=1-{0}\n#SBATCH --cpus-per-task=1\n"
            "#SBATCH --output=%x.%A_%a.log\n"
            "# sbatch this file; a killed part continues, a finished part is kept. Then:\n"
            "#   sbatch --dependency=afterok:JOB --wrap 'beamcam collect {1} -o {2}'\n"
            "exec {3} -o {2} --shard auto -j \"${{SLURM_CPUS_PER_TASK:-1}}\" --progress plain\n",
            parts, all, file, command);
    if (engine == "parallel")
        return fmt::format(
            "#!/bin/sh\n# GNU parallel on all cores; several hosts: add --sshlogin HOST,HOST --workdir .\n"
            "# Run it again to compute failed or missing parts; finished parts are kept.\nset -e\n"
            "seq {0} | parallel --joblog {1}.joblog --retries 3 -I _PART_ --quote \\\n"
            "    {2} -o {3} --shard _PART_/{0} -j1 -q\n"
            "beamcam collect {4} -o {3}\n",
            parts, stem, command, file, all);
    return fmt::format(
        "# snakemake --cores all\nrule all:\n    input: \"{3}\"\n\n"
        "rule part:\n    output: \"{1}.{{i}}of{0}{4}\"\n    threads: 1\n"
        "    shell: \"{2} -o {3} --shard {{wildcards.i}}/{0} -j {{threads}} -q\"\n\n"
        "rule collect:\n    input: expand(\"{1}.{{i}}of{0}{4}\", i=range(1, {5}))\n    output: \"{3}\"\n"
        "    shell: \"beamcam collect {{input}} -o {{output}} -q\"\n",
        parts, stem, in_snakefile(command), file, ending, parts + 1);
}

}  // namespace beamcam::scenes
