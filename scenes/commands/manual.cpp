// `beamcam manual`: the manual page, made from the parser.
#include <fmt/format.h>

#include <string>

#include "scenes/commands/commands.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

struct ManualArguments {
    const Program* program = nullptr;
};

// Text for troff: literal backslashes and hyphens, no line that begins like a request.
std::string escaped_for_roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
            out += fmt::format("\\&{}", c);
        else
            out += c;
    }
    return out;
}

std::string option_entry(const CLI::Option& option, const HelpFormatter& help) {
    const bool positional = option.get_positional();
    std::string head = fmt::format("\\f{}{}\\fR", positional ? 'I' : 'B',
                                   escaped_for_roff(positional ? option.get_name() : option.get_name(false, true)));
    if (!positional && !option.get_type_name().empty())
        head += fmt::format(" \\fI{}\\fR", escaped_for_roff(option.get_type_name()));
    return fmt::format(".TP\n{}\n{}\n", head, escaped_for_roff(help.meaning_of(&option)));
}

std::string command_section(const CLI::App& command, const HelpFormatter& help) {
    std::string text = fmt::format(".SS beamcam {}\n{}\n", escaped_for_roff(command.get_name()),
                                   escaped_for_roff(command.get_description()));
    for (const CLI::Option* option : options_of(command)) text += option_entry(*option, help);
    const std::string footer = command.get_footer();  // examples and notes, then the exit codes
    return fmt::format("{}.PP\n.nf\n{}\n.fi\n", text, escaped_for_roff(footer.substr(0, footer.find("Exit codes:"))));
}

constexpr const char* kEnvironment = R"(.TP
\fBBEAMCAM_GL\fR
OpenGL of lit and solid views: osmesa or egl (default: the first that works)
.TP
\fBBEAMCAM_FONT_DIR\fR, \fBBEAMCAM_MODULE_DIR\fR
Directories that are searched for fonts and modules instead of those of the system
)";

constexpr const char* kExamples = R"(.nf
beamcam init fall
beamcam run fall.json \-o out
beamcam render fall.json \-o still.png \-\-at impact:1
beamcam figure fall.json energy \-o energy.pdf \-\-column aps
beamcam simulate fall.json \-\-trajectory motion.csv \-\-summary \-
.fi
)";

void act(const ManualArguments& args) {
    std::string text = fmt::format(".TH BEAMCAM 1 \"\" \"beamcam {}\" \"User Commands\"\n", kVersion);
    text += ".SH NAME\nbeamcam \\- simulates and films a flexible beam that strikes a turning cam\n";
    text += ".SH SYNOPSIS\n\\fBbeamcam\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n";
    text += fmt::format(".SH DESCRIPTION\n{}\nEvery key of a scene is explained by \\fBbeamcam keys\\fR.\n",
                        escaped_for_roff(args.program->app.get_description()));
    text += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(*args.program)) text += command_section(*command, *args.program->help);
    text += ".SH EXIT STATUS\n";
    for (const auto& [code, meaning] : kExitCodes) text += fmt::format(".TP\n{}\n{}\n", int(code), meaning);
    text += fmt::format(".SH ENVIRONMENT\n{}.SH EXAMPLES\n{}", kEnvironment, kExamples);
    print_data(text);
}

}  // namespace

void add_manual(Program& program) {
    add_command<ManualArguments>(program, "manual", "Print the manual page, for `man -l -`", act).arguments.program =
        &program;
}

}  // namespace beamcam::scenes
