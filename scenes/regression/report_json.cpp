// Comparisons and results of regression tests as JSON, and reports read back.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using Kind = Node::Kind;

Node box(const output::PixelBox& b) {
    if (b.empty()) return {};
    return object_node({{"left", b.left}, {"top", b.top}, {"width", b.width()}, {"height", b.height()}});
}

Node picture(const PictureComparison& p) {
    Node out =
        object_node({{"a", p.a}, {"b", p.b}, {"verdict", name(p.verdict)}, {"size_a", p.size_a}, {"size_b", p.size_b}});
    if (!p.same_size()) return out;
    const output::PictureDifference& d = p.difference;
    add(out, "pixels", d.pixels);
    add(out, "changed", d.changed);
    add(out, "share", d.share());
    add(out, "largest", d.largest);
    add(out, "box", box(d.box));
    add(out, "antialiased", d.antialiased);
    add(out, "ssim", d.ssim);
    add(out, "lowest_ssim", d.lowest_ssim);
    return out;
}

Node table(const output::TableDifference& d) {
    Node columns = object_node();
    for (const output::ColumnDifference& c : d.columns)
        add(columns, c.name,
            object_node({{"identical", c.identical},
                         {"largest", c.largest},
                         {"t", c.t},
                         {"range", c.range},
                         {"share", c.share},
                         {"undefined", c.undefined},
                         {"texts", c.texts}}));
    return object_node({{"rows_a", d.rows_a},
                        {"rows_b", d.rows_b},
                        {"rows_compared", d.rows_compared},
                        {"only_in_a", d.only_in_a},
                        {"only_in_b", d.only_in_b},
                        {"columns", std::move(columns)}});
}

Node picture_part(const EntryResult& entry) {
    Node changed = object_node();
    for (const auto& [number, frame] : entry.frames) {
        if (frame.verdict == Verdict::identical) continue;
        Node one = object_node({{"verdict", name(frame.verdict)}, {"sha256", frame.sha256}});
        if (frame.compared) add(one, "difference", picture(frame.comparison));
        add(changed, std::to_string(number), std::move(one));
    }
    return object_node({{"verdict", name(*entry.picture)},
                        {"pictures", entry.frames.size()},
                        {"words", entry.picture_lines},
                        {"changed", std::move(changed)}});
}

Node entry_node(const EntryResult& entry) {
    Node out = object_node({{"verdict", name(entry.verdict())}});
    if (entry.picture) add(out, "picture", picture_part(entry));
    if (entry.motion)
        add(out, "motion",
            object_node(
                {{"verdict", name(*entry.motion)}, {"words", entry.motion_lines}, {"files", entry.motion_files}}));
    if (entry.reproducible_until) add(out, "reproducible_until", *entry.reproducible_until);
    if (!entry.not_reproducible.empty()) add(out, "not_reproducible", entry.not_reproducible);
    if (!entry.renderer.empty()) {
        add(out, "renderer", entry.renderer);
        add(out, "sha256", entry.digests());
    }
    if (entry.updated) add(out, "updated", true);
    if (entry.digest_added) add(out, "digest_added", true);
    return out;
}

// ---- reading ----------------------------------------------------------------------------------------

const Node& required(const Node& object, std::string_view key, Kind kind) {
    const Member* member = object.find(key);
    if (!member || member->value.kind != kind)
        throw std::invalid_argument(fmt::format("\"{}\" is not {}", key, name(kind)));
    return member->value;
}
std::string text_in(const Node& object, std::string_view key) {
    return object.find(key) ? required(object, key, Kind::string).text : std::string();
}
std::map<std::string, std::string> texts_of(const Node& object) {
    std::map<std::string, std::string> texts;
    for (const Member& member : object.members) texts[member.key] = required(object, member.key, Kind::string).text;
    return texts;
}

Verdict verdict_of(const Node& part) {
    const std::string& text = required(part, "verdict", Kind::string).text;
    const auto found = std::ranges::find(kVerdicts, text, &sim::Named<Verdict>::name);
    if (found == std::end(kVerdicts)) throw std::invalid_argument(fmt::format("\"{}\" is not a verdict", text));
    return found->value;
}

std::vector<std::string> words_of(const Node& part) {
    std::vector<std::string> lines;
    for (const Node& line : required(part, "words", Kind::array).items) lines.push_back(line.text);
    return lines;
}

// A name that stays in its folder.
void require_file_name(const std::string& name) {
    if (name.starts_with('.') || name.find('/') != std::string::npos)
        throw std::invalid_argument(fmt::format("{} is not the name of a file", name));
}

void read_picture_part(const Node& part, EntryResult& out) {
    out.picture = verdict_of(part);
    out.picture_lines = words_of(part);
    for (const Member& frame : required(part, "changed", Kind::object).members) {
        const auto number = output::number_in<long>(frame.key);
        if (!number || !out.frames.contains(*number))
            throw std::invalid_argument(fmt::format("\"{}\" is not the number of a picture", frame.key));
        out.frames[*number].verdict = verdict_of(frame.value);
    }
}

void read_motion_part(const Node& part, EntryResult& out) {
    out.motion = verdict_of(part);
    out.motion_lines = words_of(part);
    out.motion_files = texts_of(required(part, "files", Kind::object));
    for (const auto& [file, digest] : out.motion_files) require_file_name(file);
}

EntryResult read_entry(const std::string& name, const Node& entry) {
    EntryResult out;
    out.name = name;
    out.renderer = text_in(entry, "renderer");
    require_file_name("0000-" + out.renderer);
    if (entry.find("sha256"))
        for (const Node& digest : required(entry, "sha256", Kind::array).items)
            out.frames[std::ssize(out.frames)].sha256 = digest.text;
    if (const Member* part = entry.find("picture")) read_picture_part(part->value, out);
    if (const Member* part = entry.find("motion")) read_motion_part(part->value, out);
    if (entry.find("reproducible_until"))
        out.reproducible_until = required(entry, "reproducible_until", Kind::number).number;
    out.not_reproducible = text_in(entry, "not_reproducible");
    return out;
}

}  // namespace

std::string to_json(const Comparison& c) {
    Node out = object_node({{"a", c.a}, {"b", c.b}, {"verdict", name(c.verdict)}});
    if (c.table) {
        add(out, "table", table(*c.table));
        return to_text(out);
    }
    add(out, "pictures_a", c.pictures_a);
    add(out, "pictures_b", c.pictures_b);
    add(out, "identical", std::min(c.pictures_a, c.pictures_b) - c.pictures.size());
    add(out, "pictures", array_node(c.pictures, picture));
    return to_text(out);
}

std::string to_json(const RegressionResult& result) {
    Node entries = object_node();
    for (const EntryResult& entry : result.entries) add(entries, entry.name, entry_node(entry));
    return to_text(object_node({{"baselines", result.baselines},
                                {"entries", std::move(entries)},
                                {"renderers", result.renderers},
                                {"simulations", result.simulations},
                                {"pictures", result.pictures},
                                {"seconds", result.seconds},
                                {"changed", result.changed}}));
}

// CI services may put the report into another folder.
fs::path folder_of_report(const fs::path& given) {
    if (output::path_exists(given / kReportFile)) return given;
    std::vector<fs::path> found;
    if (fs::is_directory(given))
        for (const fs::directory_entry& inner : fs::directory_iterator(given))
            if (output::path_exists(inner.path() / kReportFile)) found.push_back(inner.path());
    if (found.size() == 1) return found.front();
    throw output::IoError(
        fmt::format("{} contains no {}; name the folder that beamcam test --report wrote, unpacked if it is an archive",
                    given.string(), kReportFile));
}

RegressionResult read_report(const fs::path& folder) {
    RegressionResult report;
    const fs::path file = folder / kReportFile;
    try {
        const Parsed parsed = parse(output::read_file(file));
        if (!parsed.messages.empty()) throw std::invalid_argument(parsed.messages.front().text);
        report.baselines = required(parsed.root, "baselines", Kind::string).text;
        for (const Member& renderer : required(parsed.root, "renderers", Kind::object).members)
            report.renderers[renderer.key] = texts_of(renderer.value);
        for (const Member& entry : required(parsed.root, "entries", Kind::object).members)
            report.entries.push_back(read_entry(entry.key, entry.value));
    } catch (const std::exception& error) {
        throw output::IoError(fmt::format("cannot read {}: {}", file.string(), error.what()));
    }
    return report;
}

}  // namespace beamcam::scenes
