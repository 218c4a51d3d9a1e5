// Reads one object of a scene's tree. Problems are collected with their positions; a key that was not visited is an
// error.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/json/source.hpp"
#include "output/json/tree.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/format/units.hpp"

namespace beamcam::scenes {

// A value for messages, as the user wrote it.
std::string as_written(const Node& node);

// Errors and warnings so far, and the paths of the keys that could not be read.
class Diagnostics {
  public:
    // An error that is known already, as that of mechanics that several motions share, is not repeated.
    void error(const SourcePosition& place, const std::string& path, std::string text);
    void warning(const SourcePosition& place, std::string text) {
        messages_.push_back({place, std::move(text), false});
    }
    void add(Message message) { messages_.push_back(std::move(message)); }
    // True if this key, or a key inside it, has an error.
    bool failed(const std::string& path) const {
        auto it = failed_.lower_bound(path);
        return it != failed_.end() && (*it == path || it->starts_with(path + "."));
    }
    bool any() const { return !failed_.empty(); }
    bool exceed_report() const { return messages_.size() > kMostDescribed; }  // further ones are only counted
    std::vector<Message> take() { return std::move(messages_); }

  private:
    std::vector<Message> messages_;
    std::set<std::pair<SourcePosition, std::string>> errors_;  // among the messages
    std::set<std::string> failed_;
};

// The mechanics of another scene file, or why it has none.
struct OtherScene {
    std::optional<Node> mechanics;
    std::string problem;
};

// The keys of outputs are checked against this: the scene as far as it has been read, its tree, its file, and the
// files with which it is compared, by path.
struct SceneContext {
    const Scene& scene;
    const Node& root;
    const Source& source;
    std::map<std::string, OtherScene>& others;
    std::optional<std::string> only_output = {};  // an output is read alone; its path in messages
};

// The unit that catalogues use, if a number of this size in SI units is perhaps in that unit; else null.
const char* perhaps_in(const sim::Dimension& dimension, double value);

class ObjectReader final : public SceneVisitor {
  public:
    ObjectReader(Diagnostics& diagnostics, const Node* object, std::string path, std::string root = "the scene",
                 const SceneContext* context = nullptr);

    std::string path(std::string_view key) const;
    std::string object_name() const { return path_.empty() ? root_ : path_; }
    const Node* node() const { return object_; }
    const SceneContext& context() const { return *context_; }
    Diagnostics& diagnostics() { return diagnostics_; }
    bool has(std::string_view key) const { return object_ && object_->find(key); }
    // The value at a path such as "events.0.at", or the nearest value around it.
    const Node& place(std::string_view path) const;
    ObjectReader inside(const Node& node, std::string_view key) const;

    const Node* take(const Key& key);  // reports a missing required key
    void fail(const Node& node, std::string_view key, std::string text);

    // Errors of a key, at its value. `key` is a path inside this object.
    template <class... Values>  // "KEY<why>"
    void reject(std::string_view key, fmt::format_string<Values...> why, Values&&... values) {
        fail(place(key), key, path(key) + fmt::format(why, std::forward<Values>(values)...));
    }
    void reject_if(std::string_view key, const std::string& problem) {  // there is one: "KEY: problem"
        if (!problem.empty()) reject(key, ": {}", problem);
    }
    template <class... Values>  // "KEY = VALUE<why>"
    void reject_value(const Node& value, std::string_view key, fmt::format_string<Values...> why, Values&&... values) {
        fail(value, key,
             fmt::format("{} = {}{}", path(key), as_written(value), fmt::format(why, std::forward<Values>(values)...)));
    }
    template <class... Values>  // "KEY must be <what>, not VALUE"
    void expect(const Node& value, std::string_view key, fmt::format_string<Values...> what, Values&&... values) {
        fail(value, key,
             fmt::format("{} must be {}, not {}", path(key), fmt::format(what, std::forward<Values>(values)...),
                         as_written(value)));
    }
    template <class... Values>  // "OBJECT<why>", at the object
    void reject_object(std::string_view key, fmt::format_string<Values...> why, Values&&... values) {
        fail(*object_, key, object_name() + fmt::format(why, std::forward<Values>(values)...));
    }
    template <class... Values>  // a warning: "KEY<why>"
    void warn(std::string_view key, fmt::format_string<Values...> why, Values&&... values) {
        diagnostics_.warning(place(key).place, path(key) + fmt::format(why, std::forward<Values>(values)...));
    }

    // Values by kind; nullopt: an error was reported. `key` is the path of `node` inside this object, for messages.
    std::optional<double> number_value(const Node& node, std::string_view key, const sim::Dimension& dimension);
    std::optional<double> ranged_value(const Node& node, std::string_view key, const sim::Unit& unit,
                                       const sim::Range& range);
    std::optional<int> integer_value(const Node& node, std::string_view key, int min, int max);
    // The index of the word.
    std::optional<std::size_t> keyword_value(const Node& node, std::string_view key,
                                             const std::vector<std::string>& words);
    std::optional<std::vector<double>> numbers_value(const Node& node, std::string_view key,
                                                     const sim::Dimension& dimension);

    // A column of a file beside the scene.
    std::optional<std::vector<double>> column_value(const Node& node, std::string_view key,
                                                    const std::pair<std::string, std::string>& column,
                                                    const sim::Unit& unit, const sim::Range& range);

    // ---- visited keys ----
    using SceneVisitor::number, SceneVisitor::numbers, SceneVisitor::object, SceneVisitor::integer, SceneVisitor::list;
    void number(const Key& key, std::optional<double>& value, const sim::Unit& unit, const sim::Range& range,
                const char* meaning, const char* word = nullptr) override;
    void numbers(const Key& key, std::vector<double>& values, const sim::Unit& unit, const sim::Range& range,
                 const sim::Length& length, const char* meaning) override;
    void integer(const Key& key, std::optional<int>& value, int min, int max, const char* meaning) override;
    void boolean(const Key& key, bool& value, const char* meaning) override;
    void text(const Key& key, std::string& value, const char* meaning) override;
    void keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen,
                 const char* meaning) override;
    void object(const Key& key, const Fields& fields, const char* meaning, bool* present) override;
    void alternatives(const std::vector<sim::Alternative>& all, bool explicit_tags) override;
    void value(const Key& key, const ValueFormat& format, const char* meaning, const Fields& fields) override;
    void list(const Key& key, const List& list, const char* meaning) override;
    void named(const Key& key, const NamedItems& items, const char* meaning) override;
    void exclusive(const char* one, const char* other) override;
    void problem(sim::Problem& problem) override;  // sim::validate checks the ranges of its numbers
    void check(const std::function<void(ObjectReader&)>& rule) override;

    // Reports every key that was not visited, with the place of a key that stands in the wrong object.
    void finish();

  private:
    void read_number(const Key& key, std::optional<double>& value, const sim::Unit& unit, const sim::Range& range,
                     const char* word);
    std::vector<std::string> keys_of(const sim::Alternative& alternative) const;
    std::pair<long, bool> fit(const sim::Alternative& alternative) const;
    std::string wrong_dimension(const Node& node, std::string_view key, const std::string& unit,
                                const sim::Dimension& given) const;

    Diagnostics& diagnostics_;
    const Node* object_;
    std::string path_, root_;
    const SceneContext* context_;
    bool check_ranges_ = true;
    std::vector<std::string> visited_, required_;
    std::vector<std::function<void()>> deferred_;  // numbers whose unit depends on another key
};

// Reads the keys that `visit` visits in `root`, the object of this name, and appends the messages. False: there are
// errors.
bool read_object(const Node& root, const std::string& name, const std::function<void(ObjectReader& r)>& visit,
                 std::vector<Message>& messages, const SceneContext* context = nullptr);

}  // namespace beamcam::scenes
