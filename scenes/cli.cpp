#include "scenes/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "output/errors.hpp"
#include "output/interrupt.hpp"
#include "output/standard_output.hpp"
#include "render/error.hpp"
#include "scenes/capabilities.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/reader.hpp"
#include "scenes/run.hpp"
#include "scenes/source.hpp"
#include "scenes/suggest.hpp"
#include "scenes/version.hpp"
#include "sim/simulate.hpp"

namespace beamcam::scenes {
namespace {

// A command that does not exist, told before the parser guesses.
void refuse_unknown_command(int argc, const char* const* argv, const CLI::App& app) {
    if (argc < 2 || argv[1][0] == '-') return;
    const std::string word = argv[1];
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        known.push_back(command->get_name());
    if (std::find(known.begin(), known.end(), word) != known.end()) return;
    if (const auto planned = not_available("command", word)) throw UsageError(*planned);
    if (word.ends_with(".json"))
        throw UsageError(fmt::format("no command before the scene; write beamcam run {}", word));
    throw UsageError(fmt::format("unknown command {}{}", in_quotes(word), suggestion_or_list(word, known)));
}

int parse_and_run(int argc, const char* const* argv) {
    CLI::App app("Films a mechanism: JSON scenes of a flexible beam and a turning cam in; films, stills and data out.",
                 "beamcam");
    Grammar grammar{app, {}};
    app.set_version_flag("--version", fmt::format("beamcam {}", kVersion));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done, 1 bug, 2 usage, 3 scene, 4 solver, 5 missing renderer, codec or font,\n"
        "6 input/output, 7 differs, 130 interrupted.");
    for (const auto add : kCommands) add(grammar);
    refuse_unknown_command(argc, argv, app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        app.exit(success, std::cout, std::cerr);
        std::cout.flush();
        return kDone;
    } catch (const CLI::ParseError& error) {
        std::string command;
        for (const auto& [parsed, action] : grammar.commands)
            if (parsed->parsed()) command = " " + parsed->get_name();
        throw UsageError(fmt::format("{} (see beamcam{} --help)", error.what(), command));
    }
    for (const auto& [parsed, action] : grammar.commands)
        if (parsed->parsed()) return action();
    return kDone;
}

int fail(int code, const std::string& text) {
    if (!text.empty()) output::tell("{}{}", text, text.ends_with('\n') ? "" : "\n");
    return code;
}

}  // namespace

int command_line(int argc, const char* const* argv) {
    try {
        output::install_handlers();
        return parse_and_run(argc, argv);
    } catch (const UsageError& e) {
        return fail(kUsage, fmt::format("beamcam: {}", e.what()));
    } catch (const NameClash& e) {
        return fail(kUsage, fmt::format("beamcam: {}", e.what()));
    } catch (const SceneError& e) {
        return fail(kBadScene, e.what());
    } catch (const output::UnsupportedOption& e) {
        return fail(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const render::PictureError& e) {
        return fail(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::SolverError& e) {
        return fail(kSolverFailed, fmt::format("beamcam: {} (reached {:.9g} s)", e.what(), e.last_time));
    } catch (const output::MissingCodec& e) {
        return fail(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const render::MissingPart& e) {
        return fail(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const output::IoError& e) {
        return fail(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const UnreadableFile& e) {
        return fail(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::Interrupted&) {
        return fail(kInterrupted, "beamcam: interrupted; nothing half-written is left");
    } catch (const Stopped&) {
        return fail(kInterrupted, "beamcam: interrupted; nothing half-written is left");
    } catch (const std::exception& e) {
        return fail(kBug, fmt::format("beamcam: internal error: {}; please report it with the scene and the command",
                                      e.what()));
    } catch (...) {
        return fail(kBug, "beamcam: internal error of unknown kind; please report it with the scene and the command");
    }
}

}  // namespace beamcam::scenes
