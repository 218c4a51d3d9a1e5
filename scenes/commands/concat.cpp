// `beamcam concat`: segments of a film joined without encoding them again.
#include <fmt/format.h>

#include "output/data/file_list.hpp"
#include "output/film/video.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/scene/files.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

struct ConcatArguments {
    Common common;
    std::vector<std::string> segments;
    std::string file;
};

void act(const ConcatArguments& args) {
    require_ending("-o", args.file, {".mp4", ".mov", ".webm", ".mkv"});
    for (const std::string& segment : args.segments) {
        if (ending_of(segment) != ending_of(args.file))
            throw UsageError(
                fmt::format("-o {}: {} is another kind of film; the film and its segments must have the same ending",
                            args.file, segment));
        std::error_code unreadable;
        if (std::filesystem::equivalent(segment, args.file, unreadable))
            throw UsageError(fmt::format("-o {}: it is one of the segments; name another file", args.file));
    }
    output::FileList file_list(args.common.force);
    file_list.require_replaceable(args.file);
    const long frames = output::concatenate({args.segments.begin(), args.segments.end()}, file_list.target(args.file));
    inform(args.common, fmt::format("wrote {} ({} of {})", args.file, counted(frames, "frame"),
                                    counted(args.segments.size(), "segment")));
}

}  // namespace

void add_concat(Grammar& grammar) {
    const auto [app, args] = grammar.command<ConcatArguments>(
        "concat", "Join segments of a film, made with --shard or --frames, without encoding them again", act);
    app.examples = {"concat fall.1of2.mp4 fall.2of2.mp4 -o fall.mp4"};
    app.positional("SEGMENT", &args.segments, "The segments, in order").required();
    app.option("-o,--output", &args.file, "FILE",
               "Film to make, with the ending of the segments: .mp4, .mov, .webm or .mkv")
        .required();
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
