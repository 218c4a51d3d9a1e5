#include "scenes/commands/program.hpp"

#include "output/json/tree.hpp"
#include "scenes/scene/exit_code.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {

std::string wrapped(const std::string& text, std::size_t columns) {
    std::string out;
    std::size_t column = 0;
    for (const std::string& word : split(text, ' ')) {
        if (column > 0 && column + 1 + word.size() > columns) {
            out += '\n';
            column = 0;
        }
        if (column > 0) out += ' ';
        out += word;
        column += word.size() + (column > 0 ? 1 : 0);
    }
    return out;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    const auto found = meanings_.find(option);
    const bool own = found == meanings_.end() || !option->get_description().empty();
    return wrapped(own ? option->get_description() : found->second(), kHelpColumns - get_column_width());
}

Program::Program()
    : app("Simulates a flexible beam that strikes a turning cam and films it: JSON scenes in; films, stills, figures "
          "and data out.",
          "beamcam"),
      help(std::make_shared<HelpFormatter>()) {
    app.formatter(help);
    app.set_version_flag("--version", fmt::format("beamcam {}", kVersion), "Print the version");
    app.set_help_flag("-h,--help", "Print this help");
    app.require_subcommand(1);
}

std::vector<const CLI::App*> commands_of(const Program& program) { return program.app.get_subcommands({}); }

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    return app.get_options([&app](const CLI::Option* option) { return option != app.get_help_ptr(); });
}

void add_examples(CLI::App& app, std::initializer_list<const char*> examples) {
    std::string text = "Examples:\n";
    for (const char* example : examples) text += fmt::format("  beamcam {}\n", example);
    app.footer(text);
}

void add_note(CLI::App& app, const std::string& note) {
    std::string text = app.get_footer();
    if (!text.empty()) text += '\n';
    for (const std::string& line : split(note, '\n')) text += wrapped(line, kHelpColumns) + '\n';
    app.footer(text);
}

std::string missing_value(const std::string& word) {
    const bool option =
        word.size() > 1 && word[0] == '-' && (word[1] == '-' || std::isalpha(static_cast<unsigned char>(word[1])));
    return option ? fmt::format("a value is missing before {}", word) : "";
}

CLI::Option* add_list(CLI::App& app, const std::string& names, std::vector<std::string>& values,
                      const std::string& placeholder, const std::string& meaning) {
    const auto store = [&values, names](const std::vector<std::string>& words) {
        for (const std::string& word : words)
            for (std::string& value : split(word, ',')) {
                value = std::string(trimmed(value));
                if (value.empty())
                    throw UsageError(fmt::format("{} {}: a value is empty; remove a \",\"", names, word));
                values.push_back(std::move(value));
            }
    };
    return app.add_option_function<std::vector<std::string>>(names, store, meaning)
        ->type_name(placeholder)
        ->allow_extra_args(false)
        ->check(missing_value, "");
}

CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words) {
    option->check(CLI::IsMember(words).description(""));
    return option->description(fmt::format("{} ({})", option->get_description(), fmt::join(words, ", ")));
}

}  // namespace beamcam::scenes
