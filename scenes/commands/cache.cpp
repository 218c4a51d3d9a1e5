// `beamcam cache`: the stored trajectories.
#include "scenes/motions/cache.hpp"

#include <fmt/format.h>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct CacheArguments {
    Common common;
};

Cache open_cache() {
    const auto directory = cache_directory();
    if (!directory)
        throw UsageError("there is no cache directory: HOME is not set; set BEAMCAM_CACHE_DIR or XDG_CACHE_HOME");
    return Cache(*directory, cache_limit());
}

std::string megabytes(std::uintmax_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

int list(const CacheArguments& args) {
    const Cache cache = open_cache();
    std::uintmax_t sum = 0;
    std::string text;
    for (const Cache::Kept& kept : cache.list()) {
        sum += kept.size;
        text += fmt::format("{}  {:>10}  {:>9}  {:>9} steps  {}\n", kept.key.substr(0, 12), megabytes(kept.size),
                            fmt::format("{:g} s", kept.end), kept.steps,
                            kept.about.empty() ? "damaged, or of another version" : kept.about);
    }
    print_text(text);
    inform(args.common,
           fmt::format("{} of {} in {}", megabytes(sum), megabytes(cache.limit()), cache.directory().string()));
    return 0;
}

int clear(const CacheArguments& args) {
    const auto [count, bytes] = open_cache().clear();
    inform(args.common, fmt::format("removed {} trajector{}, {}", count, count == 1 ? "y" : "ies", megabytes(bytes)));
    return 0;
}

}  // namespace

void add_cache(Grammar& grammar) {
    Command& app = grammar.command("cache", "List or remove the trajectories that are stored between runs");
    app.footer =
        "The cache is in $BEAMCAM_CACHE_DIR, or else in $XDG_CACHE_HOME/beamcam, or else in ~/.cache/beamcam. Its "
        "largest\n"
        "size is $BEAMCAM_CACHE_SIZE MiB (1024); the least recently used trajectories are removed first.";
    auto args = std::make_shared<CacheArguments>();
    Command& ls =
        app.subcommand("ls", "List the trajectories, the most recently used first: size, duration, steps, model");
    add_quiet(ls, args->common);
    ls.bind(args, list);
    Command& all = app.subcommand("clear", "Remove all trajectories");
    add_quiet(all, args->common);
    all.bind(args, clear);
}

}  // namespace beamcam::scenes
