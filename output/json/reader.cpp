// Scene files are read by the SAX interface of nlohmann-json, which does not report where a key or a value is. An
// iterator that counts the bytes which the parser takes gives the end of each token, and the next token begins at the
// first byte after it that is no blank, comma, colon or comment.
#include <fmt/format.h>
#include <glib.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "output/json/mistake.hpp"
#include "output/json/tree.hpp"

namespace beamcam {
namespace {

// Iterates over a text, and counts the bytes that were passed.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, std::size_t& count) : at_(at), count_(&count) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        ++at_;
        ++*count_;
        return *this;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

  private:
    const char* at_;
    std::size_t* count_;
};

// Builds the tree from the calls of nlohmann's parser, which stops where one of them returns false.
class TreeBuilder {
  public:
    explicit TreeBuilder(std::string_view text) : text_(text) {
        if (text_.starts_with(kByteOrderMark)) end_ = kByteOrderMark.size();
    }

    Parsed read() {
        const char *const begin = text_.data(), *const end = begin + text_.size();
        if (nlohmann::json::sax_parse(CountingIterator(begin, taken_), CountingIterator(end, taken_), this,
                                      nlohmann::json::input_format_t::json, true, true)) {
            result_.is_json = true;
            return std::move(result_);
        }
        return {Node(), {mistake_ ? *mistake_ : mistake_after_the_last_token()}, false};
    }

    // ---- called by nlohmann ----
    bool null() { return word(Node()); }
    bool boolean(bool value) { return word(Node(value)); }
    // Whole numbers have a sign, but 0 loses it.
    bool number_integer(std::int64_t value) { return number(value == 0 ? -0.0 : static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) { return number(value); }
    bool string(std::string& value) { return token(), put(Node(checked(value))); }
    bool binary(nlohmann::json::binary_t&) { return false; }  // other formats have these
    bool start_object(std::size_t) { return open(object_node()); }
    bool start_array(std::size_t) { return open(array_node()); }
    bool key(std::string& name) {
        token();
        Open& object = open_.back();
        object.key = checked(name);
        object.key_place = {0, begin_};
        const Member* first = object.node.find(object.key);
        object.is_duplicate = first;
        if (first) report_duplicate(object.key, first->key_place.offset);
        last_ = Last::key;
        return true;
    }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
        constexpr int kOverflow = 406;
        const std::size_t at = next_token();
        return error.id != kOverflow
                   ? false
                   : fail(at, fmt::format("number {} is too large for a double; the largest is 1.8e308",
                                          shortened(first_word(text_.substr(at)))));
    }

  private:
    enum class Last { bracket, key, value, word };  // the last token; a word is a number, true, false or null

    // An array or object that is not closed yet.
    struct Open {
        Node node;
        std::string key;  // of the member that is being read
        SourcePosition key_place;
        bool is_duplicate = false;
    };

    std::size_t next_token() const {
        std::size_t at = after_blanks(text_, end_);
        while (at < text_.size() && (text_[at] == ',' || text_[at] == ':')) at = after_blanks(text_, at + 1);
        return at;
    }
    // The parser has just taken a token.
    void token() {
        begin_ = next_token();
        end_ = taken_;
    }

    bool open(Node&& node) {
        token();
        if (static_cast<int>(open_.size()) >= kDeepestScene)
            return fail(begin_, fmt::format("more than {} nested brackets; a scene needs only a few", kDeepestScene));
        node.place = {0, begin_};
        open_.push_back({std::move(node), {}, {}});
        last_ = Last::bracket;
        return true;
    }

    bool close() {
        token();
        Node node = std::move(open_.back().node);
        begin_ = node.place.offset;
        open_.pop_back();
        return put(std::move(node));
    }

    bool word(Node&& node) {
        token();
        put(std::move(node));
        last_ = Last::word;
        return true;
    }

    bool number(double value) {
        token();
        const std::string_view text = first_word(text_.substr(begin_));
        end_ = begin_ + text.size();  // the parser took one byte more to find the end
        Node node(value);
        node.text = text;
        if (value == 0 && text.substr(0, text.find_first_of("eE")).find_first_of("123456789") != std::string_view::npos)
            report(fmt::format("number {} is too small for a double; write 0 if zero is meant", shortened(text)));
        put(std::move(node));
        last_ = Last::word;
        return true;
    }

    bool put(Node&& node) {
        node.place = {0, begin_};
        last_ = Last::value;
        if (open_.empty())
            result_.root = std::move(node);
        else if (Open& outer = open_.back(); outer.node.kind == Node::Kind::array)
            outer.node.items.push_back(std::move(node));
        else if (!outer.is_duplicate)
            outer.node.members.add({std::move(outer.key), outer.key_place, std::move(node)});
        return true;
    }

    std::string checked(std::string& value) {
        if (value.find('\0') != std::string::npos)  // most libraries end a text there
            report(
                fmt::format("{} contains the character U+0000, which no text can have; remove it", in_quotes(value)));
        return std::move(value);
    }

    void report(std::string text) { result_.messages.push_back({{0, begin_}, std::move(text), true}); }

    void report_duplicate(const std::string& key, std::size_t first) {
        const bool shown = result_.messages.size() < kMostDescribed;  // to find the line of each takes quadratic time
        report(fmt::format("duplicate key {}{}; remove one of them", in_quotes(key),
                           shown ? fmt::format(", first in line {}", locate(text_, first).line) : ""));
    }

    bool fail(std::size_t at, std::string text) {
        mistake_ = {{0, at}, std::move(text), true};
        return false;
    }

    // The parser stopped at a token that does not fit, or inside one that is not whole.
    Message mistake_after_the_last_token() const {
        const auto message = [&](std::size_t offset, std::string text) {
            return Message{{0, offset}, std::move(text), true};
        };
        const std::string_view word = first_word(text_.substr(begin_));
        if (last_ == Last::word && !nlohmann::json::accept(word)) return message(begin_, mistake_in_word(word));
        std::size_t at = after_blanks(text_, end_);
        if (open_.empty() && last_ != Last::bracket)
            return message(at, "text after the end of the scene; a file holds one object { … }");
        if (open_.empty() && at == text_.size()) return message(0, "the file is empty; the smallest scene is {}");

        Expected expected = Expected::value;
        if (!open_.empty() && last_ != Last::key && open_.back().node.kind == Node::Kind::object)
            expected = Expected::key;
        if (last_ != Last::bracket) {
            if (at < text_.size() && text_[at] == (last_ == Last::key ? ':' : ','))
                at = after_blanks(text_, at + 1);
            else
                expected = last_ == Last::key ? Expected::colon : Expected::separator;
        }
        const auto opening = open_.empty() ? std::nullopt : std::optional(open_.back().node.place.offset);
        return message(at == text_.size() ? opening.value_or(at) : at, mistake(text_, at, expected, opening));
    }

    std::string_view text_;
    Parsed result_;
    std::optional<Message> mistake_;
    std::size_t taken_ = 0;            // bytes that the parser took
    std::size_t begin_ = 0, end_ = 0;  // the last token that is no comma or colon
    Last last_ = Last::bracket;
    std::vector<Open> open_;
};

// Why the text is not JSON at all; empty: it may be.
std::optional<Message> encoding_problem(std::string_view text) {
    const auto message = [&](std::size_t offset, std::string problem) {
        return Message{{0, offset}, std::move(problem), true};
    };
    if (text.size() > kLargestScene)
        return message(0, fmt::format("the file has {} bytes, but a scene has at most {}; name the scene file",
                                      text.size(), kLargestScene));
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return message(0, "the file is UTF-16; save it as UTF-8");
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos)
        return message(nul, "a NUL byte; the file is not text, or it is damaged: save it as UTF-8 text");
    const char* bad = nullptr;
    if (g_utf8_validate_len(text.data(), text.size(), &bad)) return std::nullopt;
    return message(static_cast<std::size_t>(bad - text.data()),
                   fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8",
                               static_cast<unsigned>(static_cast<unsigned char>(*bad))));
}

// The text with a blank for each comma between a value and a closing bracket.
std::string without_trailing_commas(std::string_view text) {
    std::string out(text);
    std::size_t comma = std::string::npos;  // if it is the last token
    char last = '[';
    for (std::size_t at = after_blanks(text, 0); at < text.size(); at = after_blanks(text, at)) {
        const char c = text[at];
        if ((c == ']' || c == '}') && comma != std::string::npos) out[comma] = ' ';
        comma = c == ',' && std::string_view("[{,:").find(last) == std::string_view::npos ? at : std::string::npos;
        last = c;
        at = c == '"' ? after_string(text, at) : at + 1;
    }
    return out;
}

}  // namespace

Parsed parse(std::string_view text) {
    if (auto message = encoding_problem(text)) return {Node(), {std::move(*message)}, false};
    Parsed parsed = TreeBuilder(text).read();
    if (parsed.is_json) return parsed;
    const std::string without = without_trailing_commas(text);
    return without == text ? parsed : TreeBuilder(without).read();
}

Node node_of(std::string_view json) { return parse(json).root; }

}  // namespace beamcam
