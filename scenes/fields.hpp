// Reading one object of a scene's tree: each key is asked for by name and kind, what is wrong is
// collected with its place, and keys that nobody asked for are told.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/capabilities.hpp"
#include "scenes/source.hpp"
#include "scenes/suggest.hpp"
#include "scenes/tree.hpp"
#include "scenes/units.hpp"

namespace beamcam::scenes {

template <class Enum>
using Names = std::initializer_list<std::pair<const char*, Enum>>;

// A value as the user wrote it.
std::string shown(const Node& node);

// What went wrong so far, and where.
class Findings {
  public:
    void error(const Place& place, const std::string& path, std::string text) {
        messages_.push_back({place, std::move(text), true});
        failed_.insert(path);
    }
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

// Reads the keys of one object; each is asked for once, and `finish` tells of those nobody asked for.
class Fields {
  public:
    Fields(Findings& findings, const Node* object, std::string path, std::string root = "the scene")
        : findings_(findings), object_(object), path_(std::move(path)), root_(std::move(root)) {
        if (object_ && object_->kind != Node::Kind::object) {
            fail(*object_, "", fmt::format("{} must be an object {{ … }}, not {}", what(), shown(*object_)));
            object_ = nullptr;
        }
    }

    std::string path(std::string_view key) const {
        if (key.empty()) return path_;
        return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
    }
    bool has(std::string_view key) const { return object_ && object_->find(key); }

    const Node* take(const char* key) {
        known_.emplace_back(key);
        const Member* member = object_ ? object_->find(key) : nullptr;
        return member ? &member->value : nullptr;
    }
    const Node* require(const char* key, std::string_view example) {
        const Node* node = take(key);
        if (!node && object_)
            findings_.error(object_->place, path(key),
                            fmt::format("{} needs \"{}\", for example {}", what(), key, example));
        return node;
    }

    void fail(const Node& node, std::string_view key, std::string text) {
        findings_.error(node.place, path(key), std::move(text));
    }

    void text(const char* key, std::string& out) {
        if (const Node* node = take(key)) {
            if (node->kind == Node::Kind::string)
                out = node->text;
            else
                fail(*node, key, fmt::format("{} must be a text in quotes, not {}", path(key), shown(*node)));
        }
    }

    void boolean(const char* key, bool& out) {
        if (const Node* node = take(key)) {
            if (node->kind == Node::Kind::boolean)
                out = node->boolean;
            else
                fail(*node, key, fmt::format("{} must be true or false, not {}", path(key), shown(*node)));
        }
    }

    // A number in SI, or a text with a unit. True when `out` was set.
    template <class Number>
    bool quantity(const char* key, const Dimension& dimension, Number& out) {
        const Node* node = take(key);
        return node && value(*node, key, dimension, out);
    }

    template <class Number>
    bool value(const Node& node, std::string_view key, const Dimension& dimension, Number& out) {
        if (node.kind == Node::Kind::number) {
            out = node.number;
            return true;
        }
        const std::string unit = si_unit(dimension);
        if (node.kind != Node::Kind::string) {
            fail(node, key,
                 fmt::format("{} must be a number{}, not {}", path(key),
                             unit == "1" ? "" : fmt::format(" [{}] or a text with a unit", unit), shown(node)));
            return false;
        }
        const QuantityText read = parse_quantity(node.text);
        if (!read.quantity) {
            fail(node, key,
                 fmt::format("{} is no value for {}: {}{}", in_quotes(node.text), path(key), read.problem,
                             unit == "1" ? "; write a number" : fmt::format("; a value looks like \"1.5 {}\"", unit)));
            return false;
        }
        if (!same(read.quantity->dimension, dimension)) {
            fail(node, key, wrong_dimension(node, key, unit, read.quantity->dimension));
            return false;
        }
        out = read.quantity->value;
        return true;
    }

    // A whole number in lowest…highest.
    bool whole(const char* key, int lowest, int highest, int& out) {
        const Node* node = take(key);
        return node && whole_value(*node, key, lowest, highest, out);
    }
    bool whole_value(const Node& node, std::string_view key, int lowest, int highest, int& out) {
        if (node.kind != Node::Kind::number || node.number != std::round(node.number)) {
            fail(node, key, fmt::format("{} must be a whole number, not {}", path(key), shown(node)));
            return false;
        }
        if (node.number < lowest || node.number > highest) {
            fail(node, key, fmt::format("{} = {} is outside {} … {}", path(key), shown(node), lowest, highest));
            return false;
        }
        out = static_cast<int>(node.number);
        return true;
    }

    template <class Enum>
    bool choice(const char* key, const Names<Enum>& names, Enum& out) {
        const Node* node = take(key);
        return node && choice_value(*node, key, names, out);
    }
    template <class Enum>
    bool choice_value(const Node& node, std::string_view key, const Names<Enum>& names, Enum& out) {
        std::vector<std::string> known;
        for (const auto& [name, value] : names) {
            if (node.kind == Node::Kind::string && node.text == name) {
                out = value;
                return true;
            }
            known.emplace_back(name);
        }
        if (node.kind == Node::Kind::string)
            fail(node, key,
                 fmt::format("{} = {} is not known{}", path(key), in_quotes(node.text),
                             suggestion_or_list(node.text, known)));
        else
            fail(node, key,
                 fmt::format("{} must be one of {}, not {}", path(key), fmt::join(known, ", "), shown(node)));
        return false;
    }

    // An array of quantities.
    bool list(const char* key, const Dimension& dimension, std::vector<double>& out) {
        const Node* node = take(key);
        return node && list_value(*node, key, dimension, out);
    }
    bool list_value(const Node& node, std::string_view key, const Dimension& dimension, std::vector<double>& out) {
        if (node.kind != Node::Kind::array) {
            fail(node, key, fmt::format("{} must be an array [ … ], not {}", path(key), shown(node)));
            return false;
        }
        std::vector<double> values(node.items.size());
        bool fine = true;
        for (std::size_t i = 0; i < values.size(); ++i)
            fine = value(node.items[i], fmt::format("{}.{}", key, i), dimension, values[i]) && fine;
        if (fine) out = std::move(values);
        return fine;
    }

    // Tells of every key that was not asked for.
    // `elsewhere` may tell where such a key belongs.
    void finish(std::string_view planned_as = {},
                const std::function<std::string(const std::string& key)>& elsewhere = {}) {
        if (!object_) return;
        for (const Member& member : object_->members) {
            if (member.key.starts_with("x-") || std::find(known_.begin(), known_.end(), member.key) != known_.end())
                continue;
            const auto planned = not_available(planned_as, member.key);
            if (const std::string where = elsewhere ? elsewhere(member.key) : ""; !where.empty()) {
                findings_.error(
                    member.key_place, path(member.key),
                    fmt::format("unknown key {} in {}; it belongs {}", in_quotes(member.key), what(), where));
                continue;
            }
            findings_.error(member.key_place, path(member.key),
                            planned ? fmt::format("{}: {}", what(), *planned)
                                    : fmt::format("unknown key {} in {}{}", in_quotes(member.key), what(),
                                                  findings_.many() ? "" : suggestion_or_list(member.key, known_)));
        }
    }
    const Node* node() const { return object_; }
    std::string what() const { return path_.empty() ? root_ : path_; }

  private:
    std::string wrong_dimension(const Node& node, std::string_view key, const std::string& unit,
                                const Dimension& got) const {
        if (same(got, dimension::kNone)) {
            return unit == "1"
                       ? fmt::format("{} = {} must be a plain number", path(key), in_quotes(node.text))
                       : fmt::format("{} = {} has no unit; write it without quotes if it is in {}, or with its unit",
                                     path(key), in_quotes(node.text), unit);
        }
        if (unit == "1")
            return fmt::format("{} = {} has a unit, but it is a plain number", path(key), in_quotes(node.text));
        const bool cycles = unit == "rad/s" && same(got, dimension::kFrequency);
        return fmt::format("{} = {} has the wrong dimension ({}); it is measured in {}{}", path(key),
                           in_quotes(node.text), si_unit(got), unit, cycles ? ": write rpm, rad/s or deg/s" : "");
    }

    Findings& findings_;
    const Node* object_;
    std::string path_, root_;
    std::vector<std::string> known_;
};

}  // namespace beamcam::scenes
