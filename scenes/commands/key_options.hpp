// Options that set keys of an output. The reader of scenes reads their values, so that an option accepts what its key
// accepts in a scene; their help texts are the meanings of the keys.
#pragma once

#include <deque>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/json/tree.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {

class KeyOptions {
  public:
    // `type`: an output that has all keys of these options, "video".
    explicit KeyOptions(const char* type) : type_(type) {}

    // The option `name` sets `key`, "view.style". Its help is the key's meaning after `note`.
    CLI::Option* add(CLI::App& app, const char* name, const char* key, const char* placeholder, const char* note = "");
    // An option for a key whose value is a list: values separated by commas.
    CLI::Option* add_list(CLI::App& app, const char* name, const char* key, const char* placeholder,
                          const char* note = "");

    // A flag that gives the key this value.
    void add_flag(CLI::App& app, const char* name, const char* key, const char* value, const char* meaning);

    // The value that was given to an option; null: it was not given.
    const std::string* value(std::string_view name) const;
    const std::vector<std::string>& values(std::string_view name) const;  // of a list
    // The options that were given, and the first part of their keys: {"--low", "panels"}.
    std::vector<std::pair<std::string, std::string>> given() const;
    bool any() const { return !given().empty(); }

  private:
    struct Option {
        std::string name, key;
        std::optional<std::string> value;
        std::vector<std::string> values;  // of a list
        bool given() const { return value || !values.empty(); }
    };
    friend Output read_output(Node, std::initializer_list<const KeyOptions*>, Scene, const std::string&, const Common&);

    CLI::Option* explained(CLI::App& app, CLI::Option* option, const char* key, const char* note) const;

    const char* type_;
    std::deque<Option> options_;  // the parser stores values here: the addresses stay
};

// The output that `output` describes as a scene would, with the values of the options. `scene_file` is the scene's name
// in messages; warnings go to standard error. Throws UsageError.
Output read_output(Node output, std::initializer_list<const KeyOptions*> options, Scene scene,
                   const std::string& scene_file, const Common& common);

}  // namespace beamcam::scenes
