#include "scenes/format/tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "output/files/text_safety.hpp"

namespace beamcam::scenes {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

// One past the closing quote of the string that opens at `i`.
std::size_t after_string(std::string_view text, std::size_t i) {
    for (++i; i < text.size() && text[i] != '"' && text[i] != '\n'; ++i)
        if (text[i] == '\\') ++i;
    return std::min(i + 1, text.size());
}

// Offset of the first byte that is not UTF-8.
std::optional<std::size_t> first_bad_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t bytes = output::first_character(text.substr(i)).bytes;
        if (bytes == 0) return i;
        i += bytes;
    }
    return std::nullopt;
}

// What can be told before the text is looked at as JSON.
std::optional<Message> unreadable(std::string_view text, std::size_t source) {
    auto message = [&](std::size_t offset, std::string what) {
        return Message{{source, offset}, std::move(what), true};
    };
    if (text.size() > kLargestScene)
        return message(0,
                       fmt::format("the file has {} bytes, more than the {} that a scene can have; name the scene file",
                                   text.size(), kLargestScene));
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return message(0, "the file is UTF-16; save it as UTF-8");
    if (std::size_t nul = text.find('\0'); nul != std::string_view::npos)
        return message(nul, "a NUL byte; this is not a text file, or it was damaged: save it as UTF-8 text");
    if (auto bad = first_bad_utf8(text))
        return message(*bad, fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8",
                                         static_cast<unsigned>(static_cast<unsigned char>(text[*bad]))));
    return std::nullopt;
}

// Builds the tree from SAX events and finds, for each, the byte where it stands.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(std::string_view text, std::size_t source, Parsed& result) : text_(text), source_(source), result_(result) {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    }

    bool null() override { return scalar(Node::Kind::null); }
    bool boolean(bool value) override {
        return scalar(Node::Kind::boolean, [&](Node& n) { n.boolean = value; });
    }
    bool number_integer(std::int64_t value) override { return number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) override { return number(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) override { return number(value); }
    bool string(std::string& value) override {
        return scalar(Node::Kind::string, [&](Node& n) {
            refuse_nul(value, n.place.offset);
            n.text = std::move(value);
        });
    }
    bool binary(nlohmann::json::binary_t&) override { return false; }  // JSON text has none
    bool start_object(std::size_t) override { return open(Node::Kind::object); }
    bool start_array(std::size_t) override { return open(Node::Kind::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(std::string& value) override {
        skip_separators();
        const Place place{source_, at_};
        at_ = after_string(text_, at_);
        Node& object = *open_.back();
        const Member* first = object.find(value);
        is_duplicate_ = first != nullptr;
        if (is_duplicate_)
            say(place.offset, fmt::format("duplicate key {}, first in line {}; remove one of them", in_quotes(value),
                                          line_of(first->key_place.offset)));
        refuse_nul(value, place.offset);
        // The second value is kept beside the first until it is complete, then dropped.
        object.members.add({std::move(value), place, {}});
        return true;
    }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
        const std::string_view what = error.what();
        if (what.find("number overflow") != std::string_view::npos) {
            skip_separators_and_brackets();
            return fail(at_, fmt::format("number {} is too large for a double; the largest is 1.8e308",
                                         shortened(word_at(at_))));
        }
        return syntax_error(position, what);
    }

    bool failed() const { return failed_; }

  private:
    struct Nothing {
        void operator()(Node&) const {}
    };

    void say(std::size_t offset, std::string what) {
        result_.messages.push_back({{source_, offset}, std::move(what), true});
    }

    // Most libraries end a text there.
    void refuse_nul(std::string_view text, std::size_t offset) {
        if (text.find('\0') != std::string_view::npos)
            say(offset,
                fmt::format("{} contains the character U+0000, which no text can have; remove it", in_quotes(text)));
    }

    // Lines are counted once, not for each message.
    std::size_t line_of(std::size_t offset) {
        if (line_ends_.empty()) {
            for (std::size_t i = 0; i < text_.size(); ++i)
                if (text_[i] == '\n') line_ends_.push_back(i);
            line_ends_.push_back(text_.size());  // of the last, which may be the only one
        }
        return 1 + static_cast<std::size_t>(std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin());
    }

    bool fail(std::size_t offset, std::string what) {
        result_.messages.clear();  // a syntax error stands alone
        say(offset, std::move(what));
        failed_ = true;
        return false;
    }

    void skip_separators() {
        while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ',' || text_[at_] == ':')) ++at_;
    }

    // The node that the next value fills: the last member, a new item, or the root.
    Node& next_node() {
        if (open_.empty()) return result_.root;
        Node& parent = *open_.back();
        return parent.kind == Node::Kind::array ? parent.items.emplace_back() : parent.members.back().value;
    }

    template <class Fill = Nothing>
    bool scalar(Node::Kind kind, Fill fill = {}) {
        skip_separators();
        Node& node = next_node();
        node.kind = kind;
        node.place = {source_, at_};
        const std::size_t begin = last_scalar_ = at_;
        if (at_ < text_.size() && text_[at_] == '"')
            at_ = after_string(text_, at_);
        else
            while (at_ < text_.size() && !is_space(text_[at_]) &&
                   std::string_view(",:]}").find(text_[at_]) == std::string_view::npos)
                ++at_;
        if (kind == Node::Kind::number) node.text = std::string(text_.substr(begin, at_ - begin));
        fill(node);
        finish_value();
        return true;
    }

    bool number(double value) {
        return scalar(Node::Kind::number, [&](Node& node) {
            node.number = value;
            const std::string_view mantissa = std::string_view(node.text).substr(0, node.text.find_first_of("eE"));
            if (value == 0 && mantissa.find_first_of("123456789") != std::string_view::npos)
                say(node.place.offset,
                    fmt::format("number {} is too small for a double; write 0 if zero is meant", shortened(node.text)));
        });
    }

    bool open(Node::Kind kind) {
        skip_separators();
        if (static_cast<int>(open_.size()) >= kDeepestScene)
            return fail(
                at_, fmt::format("more than {} levels of brackets; a scene has no more than a handful", kDeepestScene));
        Node& node = next_node();
        node.kind = kind;
        node.place = {source_, at_++};
        duplicates_.push_back(is_duplicate_);
        is_duplicate_ = false;
        open_.push_back(&node);
        return true;
    }

    bool close() {
        while (at_ < text_.size() && text_[at_] != '}' && text_[at_] != ']') ++at_;
        ++at_;
        open_.pop_back();
        is_duplicate_ = duplicates_.back();
        duplicates_.pop_back();
        finish_value();
        return true;
    }

    void finish_value() {
        if (is_duplicate_ && !open_.empty()) open_.back()->members.drop_last();
        is_duplicate_ = false;
    }

    void skip_separators_and_brackets() {
        while (at_ < text_.size() &&
               (is_space(text_[at_]) || std::string_view(",:[]{}").find(text_[at_]) != std::string_view::npos))
            ++at_;
    }

    static bool is_word_or_number(char c) { return is_word(c) || c == '-' || c == '+' || c == '.'; }
    std::string_view word_at(std::size_t begin) const {
        std::size_t end = begin;
        while (end < text_.size() && is_word_or_number(text_[end])) ++end;
        return text_.substr(begin, end - begin);
    }

    // Where the token begins that the library was reading when it had read `position` bytes.
    std::size_t token_start(std::size_t position) const {
        // Behind the last event; but in "09" the library stops inside what was walked over as one number.
        std::size_t begin = position <= at_ ? last_scalar_ : at_;
        while (true) {
            while (begin < text_.size() && is_space(text_[begin])) ++begin;
            std::size_t end = begin + 1;
            if (begin < text_.size() && text_[begin] == '"')
                end = after_string(text_, begin);
            else if (begin < text_.size() && is_word_or_number(text_[begin]))
                end = begin + word_at(begin).size();
            if (end >= position || end > text_.size()) return std::min(begin, text_.size());
            begin = end;
        }
    }

    // The library's refusal in words for the mistakes that people make, else in its own.
    bool syntax_error(std::size_t position, std::string_view what) {
        auto says = [&](std::string_view part) { return what.find(part) != std::string_view::npos; };
        const std::size_t at = token_start(position);
        if (at >= text_.size()) return end_of_file();
        const char c = text_[at];
        if (c == '/' || c == '#')
            return fail(at,
                        "a comment that is not closed, or of a kind that scenes do not have; write // … or /* … */");
        if (c == '\'') return fail(at, "a single quote; texts and keys stand in double quotes: \"…\"");
        if (says("missing closing quote") || says("U+000A") || says("U+000D"))
            return fail(
                at, "this text has no closing quote in its line; close it with \" (a line break inside a text is \\n)");
        if (says("control character"))
            return fail(at, "this text holds a control character; write it as \\t or \\u0000");
        if (says("surrogate")) return fail(at, "half a surrogate pair in this text; write the character itself");
        if (says("invalid string"))
            return fail(at, "an escape that JSON does not have in this text; write \\\\ for a backslash");
        if (says("; expected end of input"))
            return fail(at, "text after the end of the scene; a file holds one object { … }");
        if (is_word_or_number(c)) {
            const std::string_view word = word_at(at);
            if (word.size() > 1 && c == '0' && word[1] >= '0' && word[1] <= '9')
                return fail(at, fmt::format("number {} begins with 0; JSON writes it without", shortened(word)));
            if (says("invalid")) return bad_word(at, word);
        }
        if (says("; expected ':'")) return fail(at, "a colon is missing between a key and its value");
        if (c == ',') return fail(at, "a comma where a key or value should stand; remove it, or write what is missing");
        if (says("; expected string literal"))
            return fail(at, "a key must stand here, in double quotes: \"key\": value");
        const bool after_value = says("; expected '}'") || says("; expected ']'");
        if (after_value && (c == '"' || c == '{' || c == '[' || is_word_or_number(c)))
            return fail(at, "a comma is missing before this");
        if (c == '}' || c == ']') return wrong_bracket(at, after_value);
        return fail(at, fmt::format("{} does not belong here ({}); compare with the scene of `beamcam init -`",
                                    in_quotes(std::string_view(&c, 1)), library_words(what)));
    }

    bool wrong_bracket(std::size_t at, bool after_value) {
        const char c = text_[at];
        if (open_.empty()) return fail(at, fmt::format("a '{}' that closes nothing; remove it", c));
        const Node& last = *open_.back();
        const char expected = last.kind == Node::Kind::object ? '}' : ']';
        if (c != expected)
            return fail(at, fmt::format("'{}' closes what '{}' in line {} opened; write '{}'", c,
                                        expected == '}' ? '{' : '[', locate(text_, last.place.offset).line, expected));
        return fail(at, after_value ? fmt::format("'{}' does not belong here; remove it", c)
                                    : "a value is missing before this; write it, or remove the key");
    }

    bool bad_word(std::size_t at, std::string_view word) {
        if (word == "NaN" || word == "nan" || word.ends_with("Infinity") || word.ends_with("inf"))
            return fail(at,
                        fmt::format("{} is not a number that a scene can have; write a finite one", shortened(word)));
        if (word[0] == '+' || word[0] == '.' || word[0] == '-' || (word[0] >= '0' && word[0] <= '9'))
            return fail(at, fmt::format("{} is not how JSON writes a number; write for example 0.5, -3 or 1e-8, and "
                                        "\"12 mm\" with a unit in quotes",
                                        in_quotes(word)));
        return fail(
            at, fmt::format(
                    "the bare word {}; put names and texts in double quotes (JSON's own words are true, false, null)",
                    in_quotes(word)));
    }

    bool end_of_file() {
        if (text_.find_first_not_of(" \t\r\n", text_.starts_with("\xEF\xBB\xBF") ? 3 : 0) == std::string_view::npos)
            return fail(0, "the file is empty; the smallest scene is {}");
        if (open_.empty()) return fail(text_.size(), "the file ends too early; a scene is one object { … }");
        const Node& last = *open_.back();
        const bool is_object = last.kind == Node::Kind::object;
        return fail(last.place.offset, fmt::format("this {} is never closed: the file ends before its '{}'",
                                                   is_object ? "object" : "array", is_object ? '}' : ']'));
    }

    // The library's sentence without its number, position and echo.
    static std::string library_words(std::string_view what) {
        for (std::string_view cut : {"syntax error while parsing ", ": syntax error ", "] "})
            if (std::size_t i = what.find(cut); i != std::string_view::npos) {
                what.remove_prefix(i + cut.size());
                break;
            }
        if (std::size_t i = what.find("; last read"); i != std::string_view::npos) {
            const std::size_t rest = what.find("'; ", i + 1);
            return std::string(what.substr(0, i)) +
                   (rest == std::string_view::npos ? "" : std::string(what.substr(rest + 1)));
        }
        return std::string(what);
    }

    std::string_view text_;
    std::size_t source_;
    Parsed& result_;
    std::size_t at_ = 0;
    std::size_t last_scalar_ = 0;         // where the last one began
    std::vector<std::size_t> line_ends_;  // filled when first needed
    // Pointers stay valid: a parent's vectors do not grow while a child is open.
    std::vector<Node*> open_;
    std::vector<bool> duplicates_;  // for each open node: is it the second of its key
    bool is_duplicate_ = false;
    bool failed_ = false;
};

}  // namespace

namespace {
constexpr std::size_t kFew = 16;  // are found fastest by walking them
}

const Member* Members::find(std::string_view key) const {
    if (all_.size() > kFew) {
        const auto position = index_.find(key);
        return position ? &all_[*position] : nullptr;
    }
    for (const Member& member : all_)
        if (member.key == key) return &member;
    return nullptr;
}

Member* Members::find(std::string_view key) { return const_cast<Member*>(std::as_const(*this).find(key)); }

Member& Members::add(Member member) {
    all_.push_back(std::move(member));
    if (all_.size() > kFew)
        for (std::size_t i = all_.size() == kFew + 1 ? 0 : all_.size() - 1; i < all_.size(); ++i)
            index_.add(all_[i].key, i);
    return all_.back();
}

void Members::drop_last() {
    index_.remove(all_.back().key, all_.size() - 1);
    all_.pop_back();
}

namespace {

Node of_kind(Node::Kind kind) {
    Node node;
    node.kind = kind;
    return node;
}

using Json = nlohmann::ordered_json;

Json json_of(const Node& node) {
    Json out;
    switch (node.kind) {
        case Node::Kind::null:
            break;
        case Node::Kind::boolean:
            return node.boolean;
        case Node::Kind::number:
            return node.text.empty() ? Json(node.number) : Json::parse(node.text);
        case Node::Kind::string:
            return node.text;
        case Node::Kind::array:
            out = Json::array();
            for (const Node& item : node.items) out.push_back(json_of(item));
            break;
        case Node::Kind::object:
            out = Json::object();
            for (const Member& member : node.members) out[member.key] = json_of(member.value);
            break;
    }
    return out;
}

}  // namespace

Node number_node(double value) {
    Node node = of_kind(Node::Kind::number);
    node.number = value;
    return node;
}
Node integer_node(long value) {
    Node node = number_node(static_cast<double>(value));
    node.text = std::to_string(value);
    return node;
}
Node boolean_node(bool value) {
    Node node = of_kind(Node::Kind::boolean);
    node.boolean = value;
    return node;
}
Node text_node(std::string value) {
    Node node = of_kind(Node::Kind::string);
    node.text = std::move(value);
    return node;
}
Node array_node(std::vector<Node> items) {
    Node node = of_kind(Node::Kind::array);
    node.items = std::move(items);
    return node;
}
Node object_node() { return of_kind(Node::Kind::object); }
void add(Node& object, std::string key, Node value) { object.members.add({std::move(key), {}, std::move(value)}); }

void remove(Node& object, std::string_view key) {
    Members kept;
    for (Member& member : object.members)
        if (member.key != key) kept.add(std::move(member));
    object.members = std::move(kept);
}

std::string to_text(const Node& root) {
    return json_of(root).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

const char* name(Node::Kind kind) {
    switch (kind) {
        case Node::Kind::null:
            return "null";
        case Node::Kind::boolean:
            return "true or false";
        case Node::Kind::number:
            return "a number";
        case Node::Kind::string:
            return "a text";
        case Node::Kind::array:
            return "an array";
        case Node::Kind::object:
            return "an object";
    }
    return "?";
}

std::string blank_comments(std::string_view text) {
    std::string out(text);
    auto blank = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (out[i] != '\n' && out[i] != '\r') out[i] = ' ';
    };
    constexpr std::size_t kNone = std::string_view::npos;
    char previous = 0;          // the last byte that means something
    std::size_t comma = kNone;  // a comma after a value that may turn out to be trailing
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"') {
            i = after_string(text, i);
            comma = kNone;
            previous = '"';
        } else if (text.substr(i, 2) == "//") {
            const std::size_t end = std::min(text.find('\n', i), text.size());
            blank(i, end);
            i = end;
        } else if (text.substr(i, 2) == "/*") {
            const std::size_t end = text.find("*/", i + 2);
            if (end == std::string_view::npos) return out;
            blank(i, end + 2);
            i = end + 2;
        } else if (is_space(c)) {
            ++i;
        } else {
            if ((c == '}' || c == ']') && comma != kNone) out[comma] = ' ';
            comma = kNone;
            const bool after_value = previous != 0 && std::string_view("[{,:").find(previous) == std::string_view::npos;
            if (c == ',' && after_value) comma = i;
            previous = c;
            ++i;
        }
    }
    return out;
}

Node node_of(std::string_view json) { return parse(json).root; }

Parsed parse(std::string_view text, std::size_t source) {
    Parsed result;
    if (auto message = unreadable(text, source)) {
        result.messages.push_back(*message);
        return result;
    }
    const std::string blanked = blank_comments(text);
    Builder builder(blanked, source, result);
    nlohmann::json::sax_parse(blanked, &builder, nlohmann::json::input_format_t::json);
    result.is_json = !builder.failed();
    return result;
}

}  // namespace beamcam::scenes
