#include "output/image/document_metadata.hpp"

#include <glib.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "output/files/atomic_file.hpp"
#include "output/files/inflate.hpp"

namespace beamcam::output {

namespace {

// ---- SVG -----------------------------------------------------------------------------------------

std::string without_entities(std::string_view xml) {
    static constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&#39;", '\''}, {"&amp;", '&'}};
    std::string text;
    while (!xml.empty()) {
        bool found = false;
        for (const auto& [entity, character] : kEntities)
            if (!found && xml.starts_with(entity)) {
                text.push_back(character);
                xml.remove_prefix(entity.size());
                found = true;
            }
        if (found) continue;
        text.push_back(xml.front());
        xml.remove_prefix(1);
    }
    return text;
}

std::string element(std::string_view xml, const std::string& name) {
    const std::string open = "<" + name + ">", close = "</" + name + ">";
    const std::size_t begin = xml.find(open);
    if (begin == std::string_view::npos) return {};
    const std::size_t end = xml.find(close, begin);
    if (end == std::string_view::npos) return {};
    return without_entities(xml.substr(begin + open.size(), end - begin - open.size()));
}

// ---- PDF (ISO 32000-1, 7.3.4 and 7.5.7) ------------------------------------------------------------

// The bytes of "(…)" or "<…>" at the beginning. `is_open`: the string begins but never ends.
std::optional<std::string> string_object(std::string_view pdf, bool& is_open) {
    while (!pdf.empty() && (pdf.front() == ' ' || pdf.front() == '\n' || pdf.front() == '\r')) pdf.remove_prefix(1);
    is_open = !pdf.empty() && (pdf.front() == '<' || pdf.front() == '(');
    if (!is_open) return std::nullopt;
    std::string bytes;
    if (pdf.front() == '<') {
        int high = -1;
        for (const char c : pdf.substr(1)) {
            if (c == '>') return bytes;
            const int digit = g_ascii_xdigit_value(c);
            if (digit < 0) continue;
            if (high >= 0) bytes.push_back(static_cast<char>(high << 4 | digit));
            high = high >= 0 ? -1 : digit;
        }
        return std::nullopt;
    }
    int depth = 0;
    for (std::size_t i = 0; i < pdf.size(); ++i) {
        const char c = pdf[i];
        if (c == '\\' && i + 1 < pdf.size()) {
            const char next = pdf[++i];
            if (next >= '0' && next <= '7') {
                int value = 0;
                std::size_t digits = 0;
                for (; digits < 3 && i < pdf.size() && pdf[i] >= '0' && pdf[i] <= '7'; ++i, ++digits)
                    value = value * 8 + (pdf[i] - '0');
                --i;
                bytes.push_back(static_cast<char>(value));
            } else if (next != '\n') {
                bytes.push_back(next == 'n' ? '\n' : next == 'r' ? '\r' : next == 't' ? '\t' : next);
            }
            continue;
        }
        if (c == '(' && ++depth == 1) continue;
        if (c == ')' && --depth == 0) return bytes;
        bytes.push_back(c);
    }
    return std::nullopt;
}

std::string from_utf16(std::string_view bytes) {
    std::string text;
    const auto unit = [&](std::size_t i) {
        return std::uint32_t(static_cast<unsigned char>(bytes[i])) << 8 | static_cast<unsigned char>(bytes[i + 1]);
    };
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        std::uint32_t c = unit(i);
        if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size()) {
            c = 0x10000 + ((c - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
            i += 2;
        }
        char utf8[6];
        text.append(utf8, static_cast<std::size_t>(g_unichar_to_utf8(c, utf8)));
    }
    return text;
}

std::string entry(std::string_view pdf, std::string_view key) {
    bool is_open = false;  // then the search would read to the end for every later key
    for (std::size_t at = 0; !is_open && (at = pdf.find(key, at)) != std::string_view::npos; at += key.size())
        if (const auto bytes = string_object(pdf.substr(at + key.size()), is_open))
            return bytes->starts_with("\xFE\xFF") ? from_utf16(*bytes) : *bytes;
    return {};
}

// The content of compressed object streams, where newer writers put the document information.
std::string object_streams(std::string_view pdf) {
    constexpr std::size_t kMost = 256u << 20;  // [bytes]: a scene with a drive table of a million points
    std::string all;
    Inflater inflater(kMost);
    for (std::size_t at = 0; (at = pdf.find("/ObjStm", at)) != std::string_view::npos;) {
        const std::size_t end = pdf.find("endstream", at);
        if (end == std::string_view::npos) break;
        std::size_t begin = std::min(pdf.find("stream", at) + 6, end);
        while (begin < end && (pdf[begin] == '\r' || pdf[begin] == '\n')) ++begin;
        if (const auto plain = inflater.zlib(pdf.substr(begin, end - begin))) all += *plain;
        at = end;
    }
    return all;
}

}  // namespace

DocumentMetadata read_svg_metadata(const std::filesystem::path& file) {
    const std::string xml = read_file(file);
    if (xml.find("<svg") == std::string::npos)
        throw IoError("cannot read " + file.string() + ": it is not an SVG picture");
    const std::string own = element(xml, "metadata").empty() ? std::string() : xml;
    return {element(xml, "title"), element(xml, "desc"), element(own, "creator"), element(own, "scene")};
}

DocumentMetadata read_pdf_metadata(const std::filesystem::path& file) {
    const std::string pdf = read_file(file);
    if (!pdf.starts_with("%PDF")) throw IoError("cannot read " + file.string() + ": it is not a PDF document");
    if (pdf.rfind("%%EOF") == std::string::npos)
        throw IoError("cannot read " + file.string() + ": the document is cut off; make or copy it again");
    std::string place = pdf;
    if (entry(place, "/Keywords").empty()) place = object_streams(pdf);
    return {entry(place, "/Title"), entry(place, "/Subject"), entry(place, "/Creator"), entry(place, "/Keywords")};
}

}  // namespace beamcam::output
