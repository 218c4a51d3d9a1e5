// Every key of a problem, described once: name, unit, range and meaning. Readers, writers, checks and the reference are
// Visitors of these descriptions; a new key is one line in `visit` of its struct.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sim/problem/dimension.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct Key {
    const char* name;
    const char* example = nullptr;  // of a required key; null: the key is optional
    bool written = true;            // false: writers leave the key out, because it has no meaning here
    bool derived = false;           // the default depends on other keys

    // NOLINTNEXTLINE(google-explicit-constructor): most keys need only a name
    constexpr Key(const char* key) : name(key) {}
    constexpr Key(const char* key, const char* sample, bool write) : name(key), example(sample), written(write) {}
};
constexpr Key required(const char* name, const char* example) { return {name, example, true}; }
constexpr Key written_if(bool condition, const char* name) { return {name, nullptr, condition}; }
constexpr Key derived(const char* name) {
    Key key(name);
    key.derived = true;
    return key;
}

struct Unit {
    Dimension dimension;
    const std::optional<double>* exponent = nullptr;  // n of a stiffness in N/m^n; the value of another key
    bool plain = false;                               // JSON number only, no text with a unit

    // NOLINTNEXTLINE(google-explicit-constructor): most units need only a dimension
    constexpr Unit(const Dimension& of) : dimension(of) {}
    constexpr Unit(const Dimension& of, const std::optional<double>* n, bool number)
        : dimension(of), exponent(n), plain(number) {}
    Dimension resolved() const {
        return exponent ? dimension::contact_stiffness(exponent->value_or(kPointExponent)) : dimension;
    }
    std::string symbol() const { return exponent ? "N/m^n" : si_unit(dimension); }
};
constexpr Unit of_contact_stiffness(const std::optional<double>& exponent) {
    return {dimension::kSpringStiffness, &exponent, false};
}
inline constexpr Unit kPlainNumber{dimension::kNone, nullptr, true};

struct Range {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    double min = -kInfinity, max = kInfinity;
    bool exclusive_min = false, exclusive_max = false;
    const char* message = nullptr;  // follows "KEY = VALUE"; null: "is outside MIN … MAX"
    const char* remedy = "";        // ends the message of sim::validate

    bool contains(double value) const {
        return (exclusive_min ? value > min : value >= min) && (exclusive_max ? value < max : value <= max);
    }
};
constexpr Range between(double min, double max, const char* message = nullptr) {
    return {min, max, false, false, message};
}
inline constexpr Range kAny{};
inline constexpr Range kPositive{0, Range::kInfinity, true, false, "must be positive"};
inline constexpr Range kNotNegative{0, Range::kInfinity, false, false, "must not be negative"};

class Visitor;

// One of the shapes that an object may have. Tags are keys with a fixed value that select the shape.
struct Alternative {
    std::vector<std::pair<const char*, const char*>> tags;
    const char* meaning;
    bool chosen;                           // true: the value has this shape
    std::function<void(Visitor&)> fields;  // visits its keys, and first gives the value this shape
};
template <class Shape, class... Shapes>
Alternative alternative(std::variant<Shapes...>& value, std::vector<std::pair<const char*, const char*>> tags,
                        const char* meaning);

// Length of a list of numbers.
struct Length {
    std::size_t min = 0, max = std::numeric_limits<std::size_t>::max();
    bool or_one_number = false;  // a single number may replace the list
};

// A list of objects.
struct Objects {
    std::size_t size;
    std::function<void(Visitor&, std::size_t index)> item;  // visits an object; adds one if index == size
    std::size_t min_size, max_size;
    const char* of;  // for messages: "segments"
};
template <class Struct>
Objects objects(std::vector<Struct>& values, std::size_t min_size, std::size_t max_size, const char* of);

class Visitor {
  public:
    virtual ~Visitor() = default;

    // An absent value is not written, or written as `word` if there is one.
    virtual void number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range,
                        const char* meaning, const char* word = nullptr) = 0;
    virtual void numbers(const Key& key, std::vector<double>& values, const Unit& unit, const Range& range,
                         const Length& length, const char* meaning) = 0;
    virtual void integer(const Key& key, std::optional<int>& value, int min, int max, const char* meaning) = 0;
    virtual void boolean(const Key& key, bool& value, const char* meaning) = 0;
    virtual void text(const Key& key, std::string& value, const char* meaning) = 0;
    virtual void keyword(const Key& key, const std::vector<std::string>& words, std::size_t& chosen,
                         const char* meaning) = 0;
    // An object. With `present` the key may be null; `present` is then false.
    virtual void object(const Key& key, const std::function<void(Visitor&)>& fields, const char* meaning,
                        bool* present = nullptr) = 0;
    virtual void list(const Key& key, const Objects& objects, const char* meaning) = 0;
    // The lists of numbers that are visited after this may be columns of one file.
    virtual void file_of_columns() {}
    // The object that is visited has one of these shapes. A tag that is left out follows from the other keys where only
    // one of its words has a shape with all of them; with `explicit_tags` it is required.
    virtual void alternatives(const std::vector<Alternative>& all, bool explicit_tags = false) = 0;
    // At most one of these keys may be given.
    virtual void exclusive(const char*, const char*) {}

    // ---- in terms of those above ----
    void number(const Key& key, double& value, const Unit& unit, const Range& range, const char* meaning) {
        std::optional<double> some = value;
        number(key, some, unit, range, meaning);
        value = some.value_or(value);
    }
    void integer(const Key& key, int& value, int min, int max, const char* meaning) {
        std::optional<int> some = value;
        integer(key, some, min, max, meaning);
        value = some.value_or(value);
    }
    void numbers(const Key& key, Vec2& value, const Unit& unit, const char* meaning) {
        std::vector<double> both{value.x, value.y};
        numbers(key, both, unit, kAny, {2, 2, false}, meaning);
        if (both.size() == 2) value = {both[0], both[1]};
    }
    template <class Enum>
    void choice(const Key& key, Enum& value, std::span<const Named<Enum>> among, const char* meaning) {
        std::vector<std::string> words;
        std::size_t chosen = 0;
        for (const Named<Enum>& each : among) {
            if (each.value == value) chosen = words.size();
            words.emplace_back(each.name);
        }
        keyword(key, words, chosen, meaning);
        value = among[chosen].value;
    }
    template <class Enum>
    void choice(const Key& key, Enum& value, const char* meaning) {
        choice<Enum>(key, value, names(Enum{}), meaning);
    }
    // An absent value is none of the words; writers leave it out.
    template <class Enum>
    void choice(const char* key, std::optional<Enum>& value, const char* meaning) {
        const std::span<const Named<Enum>> among = names(Enum{});
        std::vector<std::string> words;
        std::size_t chosen = among.size();
        for (const Named<Enum>& each : among) {
            if (each.value == value) chosen = words.size();
            words.emplace_back(each.name);
        }
        keyword(written_if(value.has_value(), key), words, chosen, meaning);
        if (chosen < among.size()) value = among[chosen].value;
    }
    template <class Struct>
    void object(const Key& key, Struct& value, const char* meaning) {
        object(
            key, [&value](Visitor& inside) { visit(inside, value); }, meaning, nullptr);
    }
    template <class Struct>
    void object(const Key& key, std::optional<Struct>& value, const char* meaning) {
        Struct some = value.value_or(Struct{});
        bool present = value.has_value();
        object(
            key, [&some](Visitor& inside) { visit(inside, some); }, meaning, &present);
        value = present ? std::optional(some) : std::nullopt;
    }
};

template <class Shape, class... Shapes>
Alternative alternative(std::variant<Shapes...>& value, std::vector<std::pair<const char*, const char*>> tags,
                        const char* meaning) {
    return {std::move(tags), meaning, std::holds_alternative<Shape>(value), [&value](Visitor& v) {
                if (!std::holds_alternative<Shape>(value)) value.template emplace<Shape>();
                visit(v, std::get<Shape>(value));
            }};
}

template <class Struct>
Objects objects(std::vector<Struct>& values, std::size_t min_size, std::size_t max_size, const char* of) {
    const auto item = [&values](Visitor& v, std::size_t index) {
        if (index >= values.size()) values.emplace_back();
        visit(v, values[index]);
    };
    return {values.size(), item, min_size, max_size, of};
}

void visit(Visitor& v, Problem& problem);

// Reports each number of the problem outside the range of its key.
void check_ranges(const Problem& problem, std::vector<Issue>& out);

// Visits the numbers that a value has, in the shapes of its objects; `path` is that of a key.
class NumberVisitor : public Visitor {
  public:
    void boolean(const Key&, bool&, const char*) final {}
    void text(const Key&, std::string&, const char*) final {}
    void keyword(const Key&, const std::vector<std::string>&, std::size_t&, const char*) final {}
    void object(const Key& key, const std::function<void(Visitor&)>& fields, const char*, bool* present) final {
        if (present && !*present) return;
        const std::string outside = path_;
        path_ += std::string(key.name) + ".";
        fields(*this);
        path_ = outside;
    }
    void list(const Key& key, const Objects& objects, const char*) final {
        const std::string outside = path_;
        for (std::size_t i = 0; i < objects.size; ++i) {
            path_ = outside + key.name + "." + std::to_string(i) + ".";
            objects.item(*this, i);
        }
        path_ = outside;
    }
    void alternatives(const std::vector<Alternative>& all, bool) final {
        for (const Alternative& each : all)
            if (each.chosen) each.fields(*this);
    }

  protected:
    std::string path(const Key& key) const { return path_ + key.name; }

  private:
    std::string path_;
};

}  // namespace beamcam::sim
