#include "scenes/commands/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "output/files/crash.hpp"
#include "output/files/errors.hpp"
#include "output/files/interrupt.hpp"
#include "output/files/standard_output.hpp"
#include "output/film/video.hpp"
#include "render/base/error.hpp"
#include "render/base/limits.hpp"
#include "render/gl/lit.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/source.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/scene/version.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {
namespace {

// An unknown command is named before the parser guesses.
void refuse_unknown_command(int argc, const char* const* argv, const Grammar& grammar) {
    if (argc < 2 || argv[1][0] == '-') return;
    const std::string word = argv[1];
    std::vector<std::string> known;
    for (const Command& command : grammar.commands) known.push_back(command.name);
    if (std::find(known.begin(), known.end(), word) != known.end()) return;
    if (word.ends_with(".json"))
        throw UsageError(fmt::format("no command before the scene; write beamcam run {}", word));
    throw UsageError(fmt::format("unknown command {}{}", in_quotes(word), suggestion_or_list(word, known)));
}

std::string exit_code_words() {
    constexpr std::size_t kColumns = 100;
    std::string text = "Exit codes:";
    std::size_t line = 0;  // where it begins
    for (const auto& [code, meaning] : kExitCodes) {
        const std::string word = fmt::format("{} {},", int(code), meaning);
        const bool fits = text.size() - line + 1 + word.size() <= kColumns;
        text += (fits ? " " : "\n") + word;
        if (!fits) line = text.size() - word.size();
    }
    text.back() = '.';
    return text;
}

// A parsed command and its parser.
using ParserOf = std::vector<std::pair<const CLI::App*, const Command*>>;

void add_parameter(CLI::App& app, const Parameter& parameter) {
    CLI::Option* option = std::visit(
        [&](auto* target) {
            if constexpr (std::is_same_v<decltype(target), bool*>)
                return app.add_flag(parameter.names, *target, parameter.meaning);
            else
                return app.add_option(parameter.names, *target, parameter.meaning)->type_name(parameter.value);
        },
        parameter.target);
    option->required(parameter.is_required);
    if (!parameter.choices.empty()) option->check(CLI::IsMember(parameter.choices));
    if (parameter.limits) {
        const auto [low, high] = *parameter.limits;
        const bool whole = std::holds_alternative<int*>(parameter.target);
        option->check(whole ? CLI::Range(static_cast<int>(low), static_cast<int>(high)) : CLI::Range(low, high));
    }
    if (parameter.is_positive) option->check(CLI::PositiveNumber);
    if (parameter.separator != 0) option->delimiter(parameter.separator);
    if (parameter.names.starts_with('-') && !parameter.takes_several) option->allow_extra_args(false);
}

void add_command(CLI::App& parent, const Command& command, ParserOf& parsers) {
    CLI::App* app = parent.add_subcommand(command.name, command.summary);
    if (!command.footer.empty()) app->footer(command.footer);  // else the program's own
    if (!command.subcommands.empty()) app->require_subcommand(1);
    for (const Parameter& parameter : command.parameters) add_parameter(*app, parameter);
    for (const Command& subcommand : command.subcommands) add_command(*app, subcommand, parsers);
    if (command.action) parsers.emplace_back(app, &command);
}

int parse_and_run(int argc, const char* const* argv) {
    Grammar grammar;
    for (const auto add : kCommands) add(grammar);
    refuse_unknown_command(argc, argv, grammar);

    CLI::App app(Grammar::kSummary, "beamcam");
    app.set_version_flag("--version", fmt::format("beamcam {}", kVersion));
    app.require_subcommand(1);
    app.footer(exit_code_words());
    ParserOf parsers;
    for (const Command& command : grammar.commands) add_command(app, command, parsers);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        app.exit(success, std::cout, std::cerr);
        std::cout.flush();
        return kDone;
    } catch (const CLI::ParseError& error) {
        std::string name;
        for (const auto& [parser, command] : parsers)
            if (parser->parsed()) name = " " + command->name;
        throw UsageError(fmt::format("{} (see beamcam{} --help)", error.what(), name));
    }
    for (const auto& [parser, command] : parsers)
        if (parser->parsed()) return command->action();
    return kDone;
}

int fail(int code, const std::string& text) {
    if (!text.empty()) output::print_message("{}{}", text, text.ends_with('\n') ? "" : "\n");
    return code;
}

// Where memory is short, most other causes are its consequences.
int fail_or_blame_memory(int code, const std::string& text) {
    if (!render::memory_is_short()) return fail(code, text);
    return fail(kInputOutput, fmt::format("{}\nbeamcam: {}", text, render::out_of_memory_message()));
}

}  // namespace

int command_line(int argc, const char* const* argv) {
    try {
        output::install_handlers();
        output::install_crash_handlers(kInputOutput);
        render::ignored_gl_settings();  // the environment may be changed while there is one thread
        output::silence_encoder_logs();
        return parse_and_run(argc, argv);
    } catch (const UsageError& e) {
        return fail(kUsage, fmt::format("beamcam: {}", e.what()));
    } catch (const NameClash& e) {
        return fail(kUsage, fmt::format("beamcam: {}", e.what()));
    } catch (const SceneError& e) {
        return fail(kBadScene, e.what());
    } catch (const output::UnsupportedOption& e) {
        return fail_or_blame_memory(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const Incomplete& e) {
        return fail_or_blame_memory(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const render::PictureError& e) {
        return fail_or_blame_memory(kBadScene, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::SolverError& e) {
        return fail_or_blame_memory(kSolverFailed,
                                    fmt::format("beamcam: {} (reached {:.9g} s)", e.what(), e.last_time));
    } catch (const output::MissingCodec& e) {
        return fail_or_blame_memory(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const render::MissingPart& e) {
        return fail_or_blame_memory(kMissingPart, fmt::format("beamcam: {}", e.what()));
    } catch (const render::ThreadError& e) {
        return fail_or_blame_memory(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const output::IoError& e) {
        return fail_or_blame_memory(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const std::filesystem::filesystem_error& e) {
        return fail_or_blame_memory(kInputOutput, fmt::format("beamcam: {}", output::io_error(e).what()));
    } catch (const UnreadableFile& e) {
        return fail(kInputOutput, fmt::format("beamcam: {}", e.what()));
    } catch (const sim::Interrupted&) {
        return fail(kInterrupted, "beamcam: interrupted; nothing half-written is left");
    } catch (const std::bad_alloc&) {
        return fail(kInputOutput, fmt::format("beamcam: {}", render::out_of_memory_message()));
    } catch (const std::exception& e) {
        return fail_or_blame_memory(
            kBug,
            fmt::format("beamcam: internal error: {}; please report it with the scene and the command", e.what()));
    } catch (...) {
        return fail(kBug, "beamcam: internal error of unknown kind; please report it with the scene and the command");
    }
}

}  // namespace beamcam::scenes
