#include <fmt/format.h>

#include "output/data/manifest.hpp"
#include "output/film/video.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct ConcatArguments {
    Common common;
    std::vector<std::string> segments;
    std::string file;
};

int act(const ConcatArguments& args) {
    if (args.file == "-") throw UsageError("-o -: films go to files; name one that ends as the segments do");
    const std::string ending = std::filesystem::path(args.file).extension().string();
    need_ending("-o", args.file, {".mp4", ".mov", ".webm", ".mkv"});
    for (const std::string& segment : args.segments) {
        if (std::filesystem::path(segment).extension() != ending)
            throw UsageError(fmt::format("-o {}: {} is another kind of film; segments and film have one ending",
                                         args.file, segment));
        std::error_code unreadable;
        if (std::filesystem::equivalent(segment, args.file, unreadable))
            throw UsageError(fmt::format("-o {}: it is one of the segments; name another file", args.file));
    }
    output::Manifest manifest(args.common.force);
    manifest.require_replaceable(args.file);
    const long frames = output::concatenate({args.segments.begin(), args.segments.end()}, manifest.target(args.file));
    manifest.save();
    say(args.common, fmt::format("wrote {} ({} frames of {} segments)", args.file, frames, args.segments.size()));
    return 0;
}

}  // namespace

void add_concat(Grammar& grammar) {
    auto args = std::make_shared<ConcatArguments>();
    Command& app = grammar.command("concat", "Join segments of a film (--shard, --frames) without re-encoding");
    app.positional("SEGMENT", &args->segments, "Films, in order").required();
    app.option("-o,--output", &args->file, "FILE", "Film to make, with the segments' ending: .mp4, .mov, .webm or .mkv")
        .required();
    app.flag("--force", args->common.force, "Replace a file that beamcam did not make");
    add_quiet(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
