#include "scenes/commands/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "output/files/interrupt.hpp"
#include "output/files/standard_output.hpp"
#include "output/json/source.hpp"
#include "output/json/tree.hpp"
#include "render/gl/renderer.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {
namespace {

// Before the parser takes an unknown command for something else.
void reject_unknown_command(std::span<const char* const> words, const Program& program) {
    if (words.empty() || words.front()[0] == '-') return;
    const std::string word = words.front();
    std::vector<std::string> known;
    for (const CLI::App* command : commands_of(program)) known.push_back(command->get_name());
    if (std::ranges::find(known, word) != known.end()) return;
    if (word.ends_with(".json"))
        throw UsageError(fmt::format("there is no command before the scene; write beamcam run {}", word));
    const std::string remedy = absent(word);
    throw UsageError(fmt::format("unknown command {}{}", in_quotes(word),
                                 remedy.empty() ? suggestion_or_list(word, known) : remedy));
}

// The exit codes end every help text.
void add_exit_codes(Program& program) {
    std::string codes = "Exit codes:";
    for (const auto& [code, meaning] : kExitCodes) codes += fmt::format(" {} {},", int(code), meaning);
    codes.back() = '.';
    for (CLI::App* app : program.app.get_subcommands([](const CLI::App*) { return true; })) add_note(*app, codes);
    add_note(program.app, codes);
}

// Names the words that the command does not take; values of unknown options go without saying.
std::string unexpected_words(const std::vector<std::string>& words, const CLI::App& command) {
    std::vector<std::string> known, named;
    for (const CLI::Option* option : options_of(command))
        for (std::string& name : split(option->get_name(false, true), ',')) known.push_back(std::move(name));
    for (const std::string& word : words) {
        if (!word.starts_with('-') || word == "-") continue;
        const std::string name = word.substr(0, word.find('='));  // of "--frames=0:60"
        std::string remedy = absent(name);
        if (remedy.empty() && word.starts_with("--")) remedy = suggestion(name, known);
        named.push_back(fmt::format("unknown option {}{}", word, remedy));
    }
    return named.empty() ? fmt::format("unexpected argument {}", fmt::join(words, " "))
                         : fmt::format("{}", fmt::join(named, "; "));
}

int parse_and_run(int argc, const char* const* argv) {
    Program program;
    for (const auto add : kCommands) add(program);
    add_exit_codes(program);
    reject_unknown_command({argv + std::min(argc, 1), argv + argc}, program);
    CLI::App& app = program.app;
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        std::ostringstream text;
        app.exit(success, text);
        print_data(text.str());
        return kDone;
    } catch (const CLI::ParseError& error) {
        std::string name, what = error.what();
        for (const CLI::App* command : app.get_subcommands()) {
            name += " " + command->get_name();
            if (dynamic_cast<const CLI::ExtrasError*>(&error)) what = unexpected_words(app.remaining(true), *command);
        }
        throw UsageError(fmt::format("{} (see beamcam{} --help)", what, name));
    }
    return program.action();
}

}  // namespace

int command_line(int argc, const char* const* argv) {
    try {
        output::install_handlers();
        output::install_crash_handlers(kInputOutput);
        render::ignored_gl_settings();  // the environment may be changed while there is one thread
        return parse_and_run(argc, argv);
    } catch (const std::exception& e) {
        return report(e);
    } catch (...) {
        output::print_message(
            "beamcam: internal error of unknown kind; please report it with the scene and the command\n");
        return kBug;
    }
}

}  // namespace beamcam::scenes
