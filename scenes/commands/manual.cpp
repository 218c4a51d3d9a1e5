// `beamcam manual`: the manual page, made from the grammar.
#include <fmt/format.h>

#include <string>

#include "scenes/commands/commands.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

struct ManualArguments {
    const Grammar* grammar = nullptr;
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

std::string parameter_entry(const Parameter& p) {
    std::string head = fmt::format("\\f{}{}\\fR", p.is_option() ? 'B' : 'I', escaped_for_roff(p.names));
    if (!p.value.empty()) head += fmt::format(" \\fI{}\\fR", escaped_for_roff(p.value));
    return fmt::format(".TP\n{}\n{}\n", head, escaped_for_roff(help_of(p)));
}

std::string command_section(const Command& command) {
    std::string text =
        fmt::format(".SS beamcam {}\n{}\n", escaped_for_roff(command.name), escaped_for_roff(command.summary));
    for (const Parameter& parameter : command.parameters) text += parameter_entry(parameter);
    for (const std::string& example : command.examples)
        text += fmt::format(".PP\n.RS\nbeamcam {}\n.RE\n", escaped_for_roff(example));
    if (!command.footer.empty()) text += fmt::format(".PP\n{}\n", escaped_for_roff(command.footer));
    return text;
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
                        escaped_for_roff(Grammar::kSummary));
    text += ".SH COMMANDS\n";
    for (const Command& command : args.grammar->commands) text += command_section(command);
    text += ".SH EXIT STATUS\n";
    for (const auto& [code, meaning] : kExitCodes) text += fmt::format(".TP\n{}\n{}\n", int(code), meaning);
    text += fmt::format(".SH ENVIRONMENT\n{}.SH EXAMPLES\n{}", kEnvironment, kExamples);
    print_data(text);
}

}  // namespace

void add_manual(Grammar& grammar) {
    grammar.command<ManualArguments>("manual", "Print the manual page, for `man -l -`", act).arguments.grammar =
        &grammar;
}

}  // namespace beamcam::scenes
