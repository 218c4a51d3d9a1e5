// Reading one object of a scene's tree: each key is asked for once, what is wrong is collected with its place, and a
// key that nobody asked for is an error.
#pragma once

#include <functional>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/format/keys.hpp"
#include "scenes/format/scene_files.hpp"
#include "scenes/format/source.hpp"
#include "scenes/format/tree.hpp"
#include "scenes/format/units.hpp"

namespace beamcam::scenes {

// A value as the user wrote it.
std::string as_written(const Node& node);

// What went wrong so far, and where.
class Diagnostics {
  public:
    void error(const Place& place, const std::string& path, std::string text) {
        messages_.push_back({place, std::move(text), true});
        failed_.insert(path);
    }
    void add(Message message) { messages_.push_back(std::move(message)); }
    void warning(const Place& place, std::string text) { messages_.push_back({place, std::move(text), false}); }
    // Did this key, or one inside it, fail to be read?
    bool failed(const std::string& path) const {
        auto it = failed_.lower_bound(path);
        return it != failed_.end() && (*it == path || it->starts_with(path + "."));
    }
    bool any() const { return !failed_.empty(); }
    // So many that the last ones are only counted.
    bool many() const { return messages_.size() > kMostDescribed; }
    std::vector<Message> take() { return std::move(messages_); }

  private:
    std::vector<Message> messages_;
    std::set<std::string> failed_;
};

// What the keys of outputs are checked against: the scene as far as it is read, its tree, its file, and the files that
// its comparisons name.
struct SceneContext {
    const Scene& scene;
    const Node& root;
    const Source& source;
    SceneFiles& files;
};

class ObjectReader final : public SceneVisitor {
  public:
    using Elsewhere = std::function<std::string(const std::string& key)>;

    ObjectReader(Diagnostics& diagnostics, const Node* object, std::string path, std::string root = "the scene",
                 const SceneContext* context = nullptr);

    std::string path(std::string_view key) const;
    std::string object_name() const { return path_.empty() ? root_ : path_; }
    const Node* node() const { return object_; }
    const SceneContext& context() const { return *context_; }
    Diagnostics& diagnostics() { return diagnostics_; }
    bool has(std::string_view key) const { return object_ && object_->find(key); }
    // The value of a key, or of one inside it, "events.0.at"; where there is none, the object nearest to it.
    const Node& place(std::string_view key) const;
    ObjectReader inside(const Node& node, std::string_view key) const;

    const Node* take(const Key& key);  // reports where a required key is missing
    void fail(const Node& node, std::string_view key, std::string text);

    // The kinds of values. `key` is where the node stands, for messages; true: `out` was set.
    bool number_value(const Node& node, std::string_view key, const sim::Dimension& dimension, double& out);
    bool ranged_value(const Node& node, std::string_view key, const sim::Unit& unit, const sim::Range& range,
                      double& out);
    bool integer_value(const Node& node, std::string_view key, int least, int most, int& out);
    bool keyword_value(const Node& node, std::string_view key, const std::vector<std::string>& words,
                       std::size_t& chosen);

    // ---- visited keys ----
    using SceneVisitor::numbers, SceneVisitor::object, SceneVisitor::integer;
    void number(const Key& key, double& value, const sim::Unit& unit, const sim::Range& range,
                const char* meaning) override;
    void number(const Key& key, std::optional<double>& value, const sim::Unit& unit, const sim::Range& range,
                const char* meaning, const char* word = nullptr) override;
    void numbers(const Key& key, std::vector<double>& values, const sim::Unit& unit, const sim::Range& range,
                 const sim::Length& length, const char* meaning) override;
    void integer(const Key& key, std::optional<int>& value, int least, int most, const char* meaning) override;
    void boolean(const Key& key, bool& value, const char* meaning) override;
    void text(const Key& key, std::string& value, const char* meaning) override;
    void keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen,
                 const char* meaning) override;
    void object(const Key& key, const Fields& fields, const char* meaning, bool* present) override;
    void alternatives(const std::vector<sim::Alternative>& all) override;
    void value(const Key& key, const ValueFormat& form, const char* meaning) override;
    void value_or_object(const Key& key, const ValueFormat& form, const Fields& fields, const char* meaning) override;
    void list(const Key& key, const List& list, const char* meaning) override;
    void exclusive(const char* one, const char* other) override;
    void problem(sim::Problem& problem) override;  // its ranges are judged by sim::validate
    void check(const std::function<void(ObjectReader&)>& judge) override;

    // Reports every key that was not asked for. `elsewhere` may say where such a key belongs.
    void finish(const Elsewhere& elsewhere = {});

  private:
    bool numbers_value(const Node& node, std::string_view key, const sim::Dimension& dimension,
                       std::vector<double>& out);
    void read_number(const Key& key, std::optional<double>& value, const sim::Unit& unit, const sim::Range& range,
                     const char* word);
    std::vector<std::string> keys_of(const sim::Alternative& alternative) const;
    std::string wrong_dimension(const Node& node, std::string_view key, const std::string& unit,
                                const sim::Dimension& got) const;

    Diagnostics& diagnostics_;
    const Node* object_;
    std::string path_, root_;
    const SceneContext* context_;
    bool ranges_ = true;  // whether to judge the ranges of numbers
    std::vector<std::string> known_;
    std::vector<std::function<void()>> later_;  // numbers whose unit another key decides
    bool unclear_ = false;                      // what keys belong here is not known: a tag could not be read
};

}  // namespace beamcam::scenes
