// The parser of scene files: JSON (RFC 8259) with the position of every value, and messages that name mistake and
// remedy. nlohmann-json reports no positions of values; it decodes escapes here and writes JSON in tree.cpp.
#include <fmt/format.h>
#include <glib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "output/files/text_safety.hpp"
#include "output/json/characters.hpp"
#include "output/json/tree.hpp"

namespace beamcam {
namespace {

struct SyntaxError {
    std::size_t offset;
    std::string text;
};

// Recursive descent. Throws SyntaxError.
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

    // True: a comma, and another item follows. False: the closing bracket comes next, perhaps after a comma.
    bool separator() {
        const char c = next(), closing = closing_bracket(open_.back());
        if (c == closing) return false;
        if (c != ',') unexpected(Expected::separator);
        ++at_;
        return next() != closing;
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
        const std::string_view word = first_word(text_.substr(at_));
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
        for (++at_; at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n'; ++at_)
            if (text_[at_] == '\\') ++at_;
        at_ = std::min(at_ + 1, text_.size());  // past the closing quote, or the end of the line
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
        const std::string_view word = first_word(text_.substr(at_));
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
        if (word.size() > 1 && word[0] == '0' && g_ascii_isdigit(word[1]))
            return fmt::format("number {} begins with 0; JSON writes it without", shortened(word));
        if (word[0] == '+' || word[0] == '.' || word[0] == '-' || g_ascii_isdigit(word[0]))
            return fmt::format(
                "{} is not a number in JSON; write for example 0.5, -3 or 1e-8, and \"12 mm\" with a unit in quotes",
                in_quotes(word));
        return fmt::format(
            "{} has no quotes; put names and texts in double quotes (only true, false and null have none)",
            in_quotes(word));
    }

    // ---- the text ----

    // Skips white space and closed comments.
    void skip_space() {
        for (std::size_t after = at_; after != std::string_view::npos; after = after_comment(at_)) {
            at_ = std::min(text_.find_first_not_of(" \t\n\r", after), text_.size());
        }
    }
    // One past the comment that begins at `i`; npos: there is none.
    std::size_t after_comment(std::size_t i) const {
        const std::string_view begin = text_.substr(i, 2);
        if (begin == "//") return std::min(text_.find('\n', i), text_.size());
        const std::size_t end = begin == "/*" ? text_.find("*/", i + 2) : std::string_view::npos;
        return end == std::string_view::npos ? end : end + 2;
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

Parsed parse(std::string_view text, std::size_t source, std::size_t largest) {
    Parsed result;
    if (auto message = encoding_problem(text, source, largest)) {
        result.messages.push_back(*message);
        return result;
    }
    try {
        result.root = Parser(text, source, result.messages).document();
        result.is_json = true;
    } catch (const SyntaxError& error) {
        result.messages = {{{source, error.offset}, error.text, true}};
    }
    return result;
}

Node node_of(std::string_view json) { return parse(json).root; }

}  // namespace beamcam
