#include "scenes/format/object_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <regex>

#include "scenes/format/absent.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/file_column.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {

using sim::Alternative, sim::Range, sim::Unit;

void Diagnostics::error(const SourcePosition& place, const std::string& path, std::string text) {
    failed_.insert(path);
    if (errors_.emplace(place, text).second) messages_.push_back({place, std::move(text), true});
}

ObjectReader::ObjectReader(Diagnostics& diagnostics, const Node* object, std::string path, std::string root,
                           const SceneContext* context)
    : diagnostics_(diagnostics), object_(object), path_(std::move(path)), root_(std::move(root)), context_(context) {
    if (object_ && object_->kind != Node::Kind::object) {
        reject_object("", " must be an object {{ … }}, not {}", as_written(*object_));
        object_ = nullptr;
    }
}

std::string ObjectReader::path(std::string_view key) const {
    if (key.empty()) return path_;
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const Node& ObjectReader::place(std::string_view path) const {
    const Node* node = object_;
    for (const std::string& name : split(path)) {
        const Node* inner = child(*node, name);
        if (!inner) break;
        node = inner;
    }
    return *node;
}

ObjectReader ObjectReader::inside(const Node& node, std::string_view key) const {
    ObjectReader reader(diagnostics_, &node, path(key), root_, context_);
    reader.check_ranges_ = check_ranges_;
    return reader;
}

const Node* ObjectReader::take(const Key& key) {
    visited_.emplace_back(key.name);
    if (key.example) required_.emplace_back(key.name);
    const Member* member = object_ ? object_->find(key.name) : nullptr;
    if (!member && object_ && key.example)
        diagnostics_.error(object_->place, path(key.name),
                           fmt::format("{} needs \"{}\", for example {}", object_name(), key.name, key.example));
    return member ? &member->value : nullptr;
}

void ObjectReader::fail(const Node& node, std::string_view key, std::string text) {
    diagnostics_.error(node.place, path(key), std::move(text));
}

// The usual magnitudes in SI units.
struct PlausibleRange {
    sim::Dimension dimension;
    double least, most;
    const char* usual_unit;
};
constexpr PlausibleRange kPlausible[] = {{sim::dimension::kAngle, -6.5, 6.5, "deg"},
                                         {sim::dimension::kLength, -10, 10, "mm"},
                                         {sim::dimension::kArea, 0, 2, "mm^2"},
                                         {sim::dimension::kSecondMoment, 0, 2, "mm^4"},
                                         {sim::dimension::kDensity, 50, Range::kInfinity, "g/cm^3"},
                                         {sim::dimension::kPressure, 1e4, Range::kInfinity, "GPa"}};
constexpr std::size_t kFewDigits = 6;  // numbers with more were computed

const char* perhaps_in(const sim::Dimension& dimension, double value) {
    const auto is_implausible = [&](const PlausibleRange& each) {
        return same(dimension, each.dimension) && !(value >= each.least && value < each.most);
    };
    const auto range = std::ranges::find_if(kPlausible, is_implausible);
    return range == std::end(kPlausible) ? nullptr : range->usual_unit;
}

// ---- visited keys ------------------------------------------------------------------------------

void ObjectReader::read_number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range,
                               const char* word) {
    const Node* node = take(key);
    if (!node) return;
    const bool text = node->kind == Node::Kind::string;
    if (word && text && node->text == word)
        value.reset();
    else if (unit.plain ? node->kind != Node::Kind::number
                        : word && text && node->text.find_first_of("0123456789") == std::string::npos)
        expect(*node, key.name, "{}a number", word ? fmt::format("\"{}\" or ", word) : "");
    else if (const auto read = ranged_value(*node, key.name, unit, range)) {
        value = read;
        if (node->kind == Node::Kind::number && node->text.size() <= kFewDigits)
            if (const char* usual = perhaps_in(unit.dimension, *read))
                warn(key.name, " = {0} is in {1}; write \"{0} {2}\" if that is meant", node->text,
                     si_unit(unit.dimension), usual);
    }
}

void ObjectReader::number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range,
                          const char*, const char* word) {
    if (unit.exponent)
        deferred_.emplace_back([this, key, &value, unit, range, word] { read_number(key, value, unit, range, word); });
    else
        read_number(key, value, unit, range, word);
}

void ObjectReader::numbers(const Key& key, std::vector<double>& values, const Unit& unit, const Range& range,
                           const sim::Length& length, const char*) {
    const Node* node = take(key);
    if (!node) return;
    const bool fixed = length.min == length.max;
    if (node->kind == Node::Kind::string && !fixed) {
        auto column = file_column_in(node->text);
        if (!column && columns_ && !columns_->file.empty()) column = std::pair(columns_->file, node->text);
        if (column) {
            if (const auto read = column_value(*node, key.name, *column, unit, range)) values = *read;
            return;
        }
    }
    if (length.or_one_number && node->kind != Node::Kind::array) {
        if (const auto one = ranged_value(*node, key.name, unit, range)) values = {*one};
        return;
    }
    const auto read = numbers_value(*node, key.name, unit.resolved());
    if (!read) return;
    if (fixed && read->size() != length.min)
        return reject(key.name, " must have {} numbers, not {}", length.min, read->size());
    if (read->size() < length.min) return reject(key.name, " has {} of at least {} numbers", read->size(), length.min);
    for (std::size_t i = 0; i < read->size(); ++i)
        if (!range.contains((*read)[i])) ranged_value(node->items[i], fmt::format("{}.{}", key.name, i), unit, range);
    values = *read;
}

void ObjectReader::integer(const Key& key, std::optional<int>& value, int min, int max, const char*) {
    if (const Node* node = take(key))
        if (const auto read = integer_value(*node, key.name, min, max)) value = read;
}

void ObjectReader::boolean(const Key& key, bool& value, const char*) {
    const Node* node = take(key);
    if (!node) return;
    if (node->kind == Node::Kind::boolean)
        value = node->boolean;
    else
        expect(*node, key.name, "true or false");
}

void ObjectReader::text(const Key& key, std::string& value, const char*) {
    const Node* node = take(key);
    if (!node) return;
    if (node->kind == Node::Kind::string)
        value = node->text;
    else
        expect(*node, key.name, "a text in quotes");
}

void ObjectReader::keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen, const char*) {
    if (const Node* node = take(key)) chosen = keyword_value(*node, key.name, words).value_or(chosen);
}

void ObjectReader::object(const Key& key, const Fields& fields, const char*, bool* present) {
    const Node* node = take(key);
    if (!node) return;
    if (present) {
        const bool none = node->kind == Node::Kind::null;
        if (!none && node->kind != Node::Kind::object)
            return expect(*node, key.name, "an object {{ … }}, or null for no {}", key.name);
        *present = !none;
        if (none) return;
    }
    ObjectReader reader = inside(*node, key.name);
    fields(reader);
    reader.finish();
}

std::vector<std::string> ObjectReader::keys_of(const Alternative& alternative) const {
    ObjectReader nothing(diagnostics_, nullptr, path_, root_, context_);
    alternative.fields(nothing);
    return nothing.visited_;
}

// How many keys of the object are of this shape, and whether these are all its keys and all that the shape needs.
std::pair<long, bool> ObjectReader::fit(const Alternative& alternative) const {
    ObjectReader nothing(diagnostics_, nullptr, path_, root_, context_);
    alternative.fields(nothing);
    const auto is_known = [&](const Member& member) {
        for (const auto& [tag, word] : alternative.tags)
            if (member.key == tag) return member.value.text == word;
        return member.key.starts_with("x-") || std::ranges::find(visited_, member.key) != visited_.end() ||
               std::ranges::find(nothing.visited_, member.key) != nothing.visited_.end();
    };
    const long known = std::ranges::count_if(object_->members, is_known);
    return {known, known == std::ssize(object_->members) &&
                       std::ranges::all_of(nothing.required_, [&](const std::string& key) { return has(key); })};
}

void ObjectReader::alternatives(const std::vector<Alternative>& all, bool explicit_tags) {
    if (!object_) return;
    std::vector<const Alternative*> left;
    for (const Alternative& each : all) left.push_back(&each);
    for (std::size_t depth = 0; left.front()->tags.size() > depth; ++depth) {
        const char* tag = left.front()->tags[depth].first;
        const auto words_of = [&](auto&& is_possible) {
            std::vector<std::string> words;
            for (const Alternative* each : left)
                if (is_possible(*each) && std::ranges::find(words, each->tags[depth].second) == words.end())
                    words.emplace_back(each->tags[depth].second);
            return words;
        };
        std::vector<std::string> words = words_of([](const Alternative&) { return true; });
        std::optional<std::string> word;
        if (const Node* node = take(tag)) {
            if (const auto chosen = keyword_value(*node, tag, words)) word = words[*chosen];
        } else {
            std::pair<long, bool> best;
            for (const Alternative* each : left) best = std::max(best, fit(*each));
            if (!explicit_tags) words = words_of([&](const Alternative& each) { return fit(each) == best; });
            if (!explicit_tags && words.size() == 1)
                word = words.front();
            else
                fail(*object_, tag,
                     fmt::format("{} needs \"{}\", one of {}", object_name(), tag, fmt::join(words, ", ")));
        }
        if (!word) {
            for (const Alternative* each : left)
                for (std::string& key : keys_of(*each)) visited_.push_back(std::move(key));
            return;
        }
        std::erase_if(left, [&](const Alternative* each) { return each->tags[depth].second != *word; });
    }
    // Shapes with the same tags differ by their keys: that with the most of them, or else the first.
    (*std::ranges::max_element(left, {}, [&](const Alternative* each) {
        return std::ranges::count_if(keys_of(*each), [&](const std::string& key) { return has(key); });
    }))->fields(*this);
}

void ObjectReader::value(const Key& key, const ValueFormat& format, const char*, const Fields& fields) {
    const Node* node = take(key);
    if (!node) return;
    if (!fields || node->kind != Node::Kind::object) return format.read(*this, *node, key.name);
    ObjectReader reader = inside(*node, key.name);
    fields(reader);
    reader.finish();
}

void ObjectReader::list(const Key& key, const List& list, const char*) {
    const Node* node = take(key);
    if (!node) return;
    const std::size_t size = node->items.size();
    if (node->kind != Node::Kind::array || size < list.min_size || size > list.max_size)
        return reject(key.name, " must be an array {}, not {}{}",
                      list.min_size > 0      ? fmt::format("of {} to {} {}", list.min_size, list.max_size, list.of)
                      : size > list.max_size ? fmt::format("of at most {} {}", list.max_size, list.of)
                                             : "[ … ]",
                      as_written(*node), list.example ? fmt::format("; for example {}", list.example) : "");
    for (std::size_t i = 0; i < node->items.size(); ++i) {
        const Node& item = node->items[i];
        const std::string at = fmt::format("{}.{}", key.name, i);
        if (list.format && item.kind != Node::Kind::object) {
            list.format->read(*this, item, at);
            continue;
        }
        ObjectReader reader = inside(item, at);
        list.item(reader, i);
        reader.finish();
    }
}

void ObjectReader::named(const Key& key, const NamedItems& items, const char*) {
    const Node* node = take(key);
    if (!node) return;
    const ObjectReader all = inside(*node, key.name);
    if (!all.node()) return;
    if (node->members.size() < items.min_size) reject(key.name, " is empty; add at least one entry");
    const std::regex pattern(items.pattern);
    for (const Member& member : node->members) {
        if (!std::regex_match(member.key, pattern)) {
            diagnostics_.error(member.key_place, all.path(member.key),
                               fmt::format("{} {}", in_quotes(member.key), items.wrong_name));
            continue;
        }
        ObjectReader item = all.inside(member.value, member.key);
        items.visit(item, member.key);
        item.finish();
    }
}

void ObjectReader::exclusive(const char* one, const char* other) {
    for (const char* key : {one, other})
        if (std::ranges::find(visited_, key) == visited_.end()) visited_.emplace_back(key);
    if (has(one) && has(other))
        fail(place(other), other,
             fmt::format("{} has both \"{}\" and \"{}\"; keep one of them", object_name(), one, other));
}

void ObjectReader::problem(sim::Problem& problem) {
    check_ranges_ = false;
    visit(*this, problem);
    check_ranges_ = true;
}

void ObjectReader::check(const std::function<void(ObjectReader&)>& rule) {
    if (object_) rule(*this);
}

void ObjectReader::finish() {
    for (const auto& read_deferred : deferred_) read_deferred();
    if (!object_) return;
    const Member* type = object_->find("type");
    for (const Member& member : object_->members) {
        if (member.key.starts_with("x-") || std::ranges::find(visited_, member.key) != visited_.end()) continue;
        const std::string place = path(member.key);
        std::string in_scene = place, remedy;
        if (context_ && context_->only_output) in_scene = "outputs.0." + place.substr(context_->only_output->size());
        const auto try_remedy = [&](const auto& find) {
            if (remedy.empty() && !diagnostics_.exceed_report()) remedy = find();
        };
        try_remedy([&] { return absent_key(place); });
        if (context_) try_remedy([&] { return place_of_key(in_scene, type ? type->value.text : "", true); });
        try_remedy([&] { return suggestion(member.key, visited_); });
        if (context_) try_remedy([&] { return place_of_key(in_scene, "", false); });
        try_remedy([&] { return suggestion_or_list(member.key, visited_); });
        diagnostics_.error(member.key_place, place,
                           fmt::format("unknown key {} in {}{}", in_quotes(member.key), object_name(), remedy));
    }
}

bool read_object(const Node& root, const std::string& name, const std::function<void(ObjectReader& r)>& visit,
                 std::vector<Message>& messages, const SceneContext* context) {
    Diagnostics diagnostics;
    ObjectReader reader(diagnostics, &root, context ? context->only_output.value_or("") : "", name, context);
    visit(reader);
    reader.finish();
    std::ranges::move(diagnostics.take(), std::back_inserter(messages));
    return !diagnostics.any();
}

}  // namespace beamcam::scenes
