// The parser of scene files: JSON (RFC 8259) with the position of every value, and messages that name mistake and
// remedy. nlohmann-json reports no positions of values; it decodes escapes here and writes JSON in tree.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "output/files/text_safety.hpp"
#include "scenes/format/tree.hpp"

namespace beamcam::scenes {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit_of_json(char c) { return c >= '0' && c <= '9'; }
bool is_word_byte(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit_of_json(c) || c == '_' || c == '-' ||
           c == '+' || c == '.';
}

// One past the closing quote of the string that opens at `i`, or past the end of its line.
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

// Why the file is not JSON text at all.
std::optional<Message> encoding_problem(std::string_view text, std::size_t source) {
    const auto message = [&](std::size_t offset, std::string problem) {
        return Message{{source, offset}, std::move(problem), true};
    };
    if (text.size() > kLargestScene)
        return message(0, fmt::format("the file has {} bytes, but a scene has at most {}; name the scene file",
                                      text.size(), kLargestScene));
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return message(0, "the file is UTF-16; save it as UTF-8");
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos)
        return message(nul, "a NUL byte; the file is not text, or it is damaged: save it as UTF-8 text");
    if (const auto bad = first_bad_utf8(text))
        return message(*bad, fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8",
                                         static_cast<unsigned>(static_cast<unsigned char>(text[*bad]))));
    return std::nullopt;
}

// True for -12.5e-3; false for +1, .5, 01, 1. and 0x10.
bool is_number_of_json(std::string_view word) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t begin = i;
        while (i < word.size() && is_digit_of_json(word[i])) ++i;
        return i - begin;
    };
    const auto accept = [&](std::string_view any) {
        const bool found = i < word.size() && any.find(word[i]) != std::string_view::npos;
        i += found ? 1 : 0;
        return found;
    };
    accept("-");
    const std::size_t first = i, whole = digits();
    if (whole == 0 || (whole > 1 && word[first] == '0')) return false;
    if (accept(".") && digits() == 0) return false;
    if (accept("eE")) {
        accept("+-");
        if (digits() == 0) return false;
    }
    return i == word.size();
}

struct SyntaxError {
    std::size_t offset;
    std::string text;
};

// Recursive descent over a text without comments and trailing commas. Throws SyntaxError.
class Parser {
  public:
    Parser(std::string_view text, std::size_t source, std::vector<Message>& messages)
        : text_(text), source_(source), messages_(messages) {
        if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    }

    Node document() {
        skip_space();
        if (at_ == text_.size()) throw SyntaxError{0, "the file is empty; the smallest scene is {}"};
        Node root = value();
        skip_space();
        if (at_ < text_.size())
            throw SyntaxError{at_, "text after the end of the scene; a file holds one object { … }"};
        return root;
    }

  private:
    enum class Expected { value, key, colon, separator };

    Node value() {
        Node node = begun_value();
        node.end = at_;
        return node;
    }

    Node begun_value() {
        switch (next()) {
            case '{':
                return object();
            case '[':
                return array();
            case '"': {
                Node node = node_here(Node::Kind::string);
                node.text = string();
                return node;
            }
            default:
                return number_or_literal();
        }
    }

    Node object() {
        Node node = open(Node::Kind::object);
        for (bool more = next() != '}'; more; more = separator()) member(node);
        close();
        return node;
    }

    // Of equal keys the first one counts.
    void member(Node& object) {
        if (next() != '"') unexpected(Expected::key);
        const Place place{source_, at_};
        std::string key = string();
        if (next() != ':') unexpected(Expected::colon);
        ++at_;
        if (const Member* first = object.find(key)) {
            report(place.offset, fmt::format("duplicate key {}, first in line {}; remove one of them", in_quotes(key),
                                             line_of(first->key_place.offset)));
            value();
        } else {
            Node read = value();
            object.members.add({std::move(key), place, std::move(read)});
        }
    }

    Node array() {
        Node node = open(Node::Kind::array);
        for (bool more = next() != ']'; more; more = separator()) node.items.push_back(value());
        close();
        return node;
    }

    // True: a comma, so that another item follows. False: the closing bracket comes next.
    bool separator() {
        const char c = next();
        if (c == closing_bracket(open_.back())) return false;
        if (c != ',') unexpected(Expected::separator);
        ++at_;
        return true;
    }

    Node open(Node::Kind kind) {
        if (static_cast<int>(open_.size()) >= kDeepestScene)
            throw SyntaxError{at_,
                              fmt::format("more than {} nested brackets; a scene needs only a few", kDeepestScene)};
        open_.push_back(at_);
        Node node = node_here(kind);
        ++at_;
        return node;
    }
    void close() {
        open_.pop_back();
        ++at_;
    }
    char closing_bracket(std::size_t opening) const { return text_[opening] == '{' ? '}' : ']'; }

    Node number_or_literal() {
        const std::string_view word = word_at(at_);
        if (word == "true" || word == "false" || word == "null") {
            Node node = node_here(word == "null" ? Node::Kind::null : Node::Kind::boolean);
            node.boolean = word == "true";
            at_ += word.size();
            return node;
        }
        if (!is_number_of_json(word)) unexpected(Expected::value);
        Node node = node_here(Node::Kind::number);
        node.text = word;
        if (std::from_chars(word.data(), word.data() + word.size(), node.number).ec != std::errc()) {
            node.number = std::strtod(node.text.c_str(), nullptr);  // ±∞, or a value near 0
            if (std::abs(node.number) > 1)
                throw SyntaxError{
                    at_, fmt::format("number {} is too large for a double; the largest is 1.8e308", shortened(word))};
        }
        const std::string_view mantissa = word.substr(0, word.find_first_of("eE"));
        if (node.number == 0 && mantissa.find_first_of("123456789") != std::string_view::npos)
            report(at_, fmt::format("number {} is too small for a double; write 0 if zero is meant", shortened(word)));
        at_ += word.size();
        return node;
    }

    std::string string() {
        const std::size_t begin = at_;
        at_ = after_string(text_, at_);
        const std::string_view token = text_.substr(begin, at_ - begin);
        if (token.size() < 2 || token.back() != '"' || token.find('\r') != std::string_view::npos)
            throw SyntaxError{
                begin,
                "this text has no closing quote in its line; close it with \" (a line break inside a text is \\n)"};
        if (std::ranges::any_of(token, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
            throw SyntaxError{begin, "this text contains a control character; write it as \\t or \\u0000"};
        std::string out(token.substr(1, token.size() - 2));
        if (out.find('\\') != std::string::npos) {
            const auto decoded = nlohmann::json::parse(token, nullptr, false);
            if (decoded.is_discarded())
                throw SyntaxError{begin,
                                  "this text contains an escape that JSON does not have; write \\\\ for a backslash, "
                                  "and the character itself instead of half a surrogate pair"};
            out = decoded.get<std::string>();
        }
        if (out.find('\0') != std::string::npos)  // most libraries end a text there
            report(begin,
                   fmt::format("{} contains the character U+0000, which no text can have; remove it", in_quotes(out)));
        return out;
    }

    // ---- mistakes ----

    [[noreturn]] void unexpected(Expected expected) {
        const char c = text_[at_];
        const auto fail = [&](std::string text) { throw SyntaxError{at_, std::move(text)}; };
        if (c == '/' || c == '#') fail("a comment that is not closed, or of an unknown kind; write // … or /* … */");
        if (c == '\'') fail("a single quote; put texts and keys in double quotes: \"…\"");
        if (expected == Expected::colon) fail("a colon is missing between a key and its value");
        if (c == ',') fail("a comma where a key or a value is expected; remove it, or write what is missing");
        const std::string_view word = word_at(at_);
        const bool is_value = c == '"' || c == '{' || c == '[' || word == "true" || word == "false" || word == "null" ||
                              is_number_of_json(word);
        if (is_value && expected == Expected::separator) fail("a comma is missing before this");
        if (is_value) fail("a key is expected here, in double quotes: \"key\": value");
        if (!word.empty()) fail(problem_with_word(word));
        if (c == '}' || c == ']') fail(problem_with_bracket(c, expected));
        const std::string_view character = text_.substr(at_, output::first_character(text_.substr(at_)).bytes);
        if (character == "“" || character == "”" || character == "‘" || character == "’")
            fail("a typographic quote; put texts and keys in straight double quotes: \"…\"");
        fail(fmt::format("{} does not belong here; compare with the scene of `beamcam init -`", in_quotes(character)));
        std::abort();
    }

    std::string problem_with_bracket(char c, Expected expected) {
        if (open_.empty()) return fmt::format("an unmatched '{}'; remove it", c);
        const char expected_bracket = closing_bracket(open_.back());
        if (c != expected_bracket)
            return fmt::format("'{}' closes what '{}' in line {} opened; write '{}'", c, text_[open_.back()],
                               line_of(open_.back()), expected_bracket);
        return expected == Expected::separator ? fmt::format("'{}' does not belong here; remove it", c)
                                               : "a value is missing before this; write it, or remove the key";
    }

    static std::string problem_with_word(std::string_view word) {
        if (word == "NaN" || word == "nan" || word.ends_with("Infinity") || word.ends_with("inf"))
            return fmt::format("{} is not a number that a scene can have; write a finite number", shortened(word));
        if (word.size() > 1 && word[0] == '0' && is_digit_of_json(word[1]))
            return fmt::format("number {} begins with 0; JSON writes it without", shortened(word));
        if (word[0] == '+' || word[0] == '.' || word[0] == '-' || is_digit_of_json(word[0]))
            return fmt::format(
                "{} is not a number in JSON; write for example 0.5, -3 or 1e-8, and \"12 mm\" with a unit in quotes",
                in_quotes(word));
        return fmt::format(
            "{} has no quotes; put names and texts in double quotes (only true, false and null have none)",
            in_quotes(word));
    }

    // ---- the text ----

    void skip_space() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }
    // The next byte that is not white space. Throws at the end of the file.
    char next() {
        skip_space();
        if (at_ < text_.size()) return text_[at_];
        if (open_.empty()) throw SyntaxError{at_, "the file ends too early; a scene is one object { … }"};
        throw SyntaxError{open_.back(),
                          fmt::format("this {} is never closed: the file ends before its '{}'",
                                      text_[open_.back()] == '{' ? "object" : "array", closing_bracket(open_.back()))};
    }
    std::string_view word_at(std::size_t begin) const {
        std::size_t end = begin;
        while (end < text_.size() && is_word_byte(text_[end])) ++end;
        return text_.substr(begin, end - begin);
    }
    Node node_here(Node::Kind kind) const {
        Node node;
        node.kind = kind;
        node.place = {source_, at_};
        return node;
    }
    void report(std::size_t offset, std::string text) {
        messages_.push_back({{source_, offset}, std::move(text), true});
    }
    std::size_t line_of(std::size_t offset) {
        if (line_ends_.empty()) {  // once, not for each message
            for (std::size_t i = 0; i < text_.size(); ++i)
                if (text_[i] == '\n') line_ends_.push_back(i);
            line_ends_.push_back(text_.size());
        }
        return 1 + static_cast<std::size_t>(std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin());
    }

    std::string_view text_;
    std::size_t source_;
    std::vector<Message>& messages_;
    std::size_t at_ = 0;
    std::vector<std::size_t> open_;  // offsets of the brackets that are open
    std::vector<std::size_t> line_ends_;
};

}  // namespace

std::string blank_comments(std::string_view text) {
    std::string out(text);
    auto blank = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (out[i] != '\n' && out[i] != '\r') out[i] = ' ';
    };
    constexpr std::size_t kNone = std::string_view::npos;
    char previous = 0;          // the last significant byte
    std::size_t comma = kNone;  // the last comma after a value; perhaps a trailing one
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

Parsed parse(std::string_view text, std::size_t source) {
    Parsed result;
    if (auto message = encoding_problem(text, source)) {
        result.messages.push_back(*message);
        return result;
    }
    const std::string blanked = blank_comments(text);
    try {
        result.root = Parser(blanked, source, result.messages).document();
        result.is_json = true;
    } catch (const SyntaxError& error) {
        result.messages = {{{source, error.offset}, error.text, true}};
    }
    return result;
}

Node node_of(std::string_view json) { return parse(json).root; }

}  // namespace beamcam::scenes
