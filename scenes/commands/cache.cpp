// `beamcam cache`: the stored trajectories.
#include "scenes/motions/cache.hpp"

#include <fmt/format.h>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

Cache user_cache() {
    const auto directory = cache_directory();
    if (!directory)
        throw UsageError("there is no cache directory: HOME is not set; set BEAMCAM_CACHE_DIR or XDG_CACHE_HOME");
    return Cache(*directory, cache_limit());
}

std::string megabytes(std::uintmax_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

void list(const Common& common) {
    const Cache cache = user_cache();
    std::uintmax_t sum = 0;
    std::string text;
    for (const Cache::Kept& kept : cache.list()) {
        sum += kept.size;
        text += fmt::format("{}  {:>10}  {:>9}  {:>9} steps  {}\n", kept.key.substr(0, 12), megabytes(kept.size),
                            fmt::format("{:g} s", kept.end), kept.steps,
                            kept.about.empty() ? "damaged, or of another version" : kept.about);
    }
    print_text(text);
    inform(common, fmt::format("{} of {} in {}", megabytes(sum), megabytes(cache.limit()), cache.directory().string()));
}

void clear(const Common& common) {
    const auto [count, bytes] = user_cache().clear();
    inform(common, fmt::format("removed {} trajector{}, {}", count, count == 1 ? "y" : "ies", megabytes(bytes)));
}

}  // namespace

void add_cache(Grammar& grammar) {
    Command& app = grammar.command("cache", "List or remove the trajectories that are stored between runs");
    app.footer =
        "The cache is in $BEAMCAM_CACHE_DIR, or else in $XDG_CACHE_HOME/beamcam, or else in ~/.cache/beamcam. Its "
        "largest\n"
        "size is $BEAMCAM_CACHE_SIZE MiB (1024); the least recently used trajectories are removed first. A trajectory "
        "of more\n"
        "than half of that size is not stored.";
    const auto [ls, of_list] =
        app.subcommand("ls", "List the trajectories, the most recently used first: size, duration, steps, model", list);
    add_quiet(ls, of_list);
    const auto [all, of_clear] = app.subcommand("clear", "Remove all trajectories", clear);
    add_quiet(all, of_clear);
}

}  // namespace beamcam::scenes
