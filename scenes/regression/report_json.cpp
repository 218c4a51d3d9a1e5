// Comparisons and results of regression tests as JSON, and reports read back.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/files/atomic_file.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// File names may contain bytes that are not UTF-8; they become U+FFFD.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json box(const output::PixelBox& b) {
    if (b.empty()) return nullptr;
    return {{"left", b.left}, {"top", b.top}, {"width", b.width()}, {"height", b.height()}};
}

Json picture(const PictureComparison& p) {
    Json out = {{"a", p.a}, {"b", p.b}, {"verdict", name(p.verdict)}, {"size_a", p.size_a}, {"size_b", p.size_b}};
    if (!p.same_size()) return out;
    const output::PictureDifference& d = p.difference;
    out["pixels"] = d.pixels;
    out["changed"] = d.changed;
    out["share"] = d.share();
    out["largest"] = d.largest;
    out["box"] = box(d.box);
    out["antialiased"] = d.antialiased;
    out["ssim"] = d.ssim;
    out["lowest_ssim"] = d.lowest_ssim;
    return out;
}

Json table(const output::TableDifference& d) {
    Json columns = Json::object();
    for (const output::ColumnDifference& c : d.columns)
        columns[c.name] = {{"identical", c.identical}, {"largest", c.largest}, {"t", c.t},
                           {"range", c.range},         {"share", c.share},     {"undefined", c.undefined}};
    return {{"rows_a", d.rows_a},       {"rows_b", d.rows_b},       {"rows_compared", d.rows_compared},
            {"only_in_a", d.only_in_a}, {"only_in_b", d.only_in_b}, {"columns", columns}};
}

// ---- reading ----------------------------------------------------------------------------------------

bool verdict_is(const nlohmann::json& part, std::initializer_list<Verdict> verdicts) {
    return std::ranges::any_of(verdicts, [&](Verdict v) { return part.at("verdict") == name(v); });
}

// A name that stays in its folder.
void require_file_name(const std::string& name) {
    if (name.starts_with('.') || name.find('/') != std::string::npos)
        throw std::invalid_argument(fmt::format("{} is not the name of a file", name));
}

ReportedEntry reported_entry(const nlohmann::json& entry) {
    ReportedEntry out;
    out.renderer = entry.value("renderer", "");
    out.sha256 = entry.value("sha256", std::vector<std::string>());
    for (const char* part : {"picture", "motion"})
        if (entry.contains(part) && verdict_is(entry.at(part), {Verdict::different, Verdict::missing})) {
            out.differs = true;
            for (const nlohmann::json& line : entry.at(part).at("words")) out.reason = line.get<std::string>();
        }
    if (entry.contains("motion")) out.motion_files = entry.at("motion").at("files");
    for (const auto& [file, digest] : out.motion_files) require_file_name(file);
    require_file_name("0000-" + out.renderer);
    if (entry.contains("reproducible_until")) out.reproducible_until = entry.at("reproducible_until").get<double>();
    out.not_reproducible = entry.value("not_reproducible", "");
    if (entry.contains("picture"))
        for (const auto& [number, frame] : entry.at("picture").at("changed").items())
            out.changed.push_back(std::stol(number));
    return out;
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

}  // namespace

std::string to_json(const Comparison& c) {
    Json out = {{"a", c.a}, {"b", c.b}, {"verdict", name(c.verdict)}};
    if (c.table) {
        out["table"] = table(*c.table);
        return text_of(out);
    }
    out["pictures_a"] = c.pictures_a;
    out["pictures_b"] = c.pictures_b;
    out["identical"] = std::min(c.pictures_a, c.pictures_b) - c.pictures.size();
    out["pictures"] = Json::array();
    for (const PictureComparison& p : c.pictures) out["pictures"].push_back(picture(p));
    return text_of(out);
}

std::string to_json(const RegressionResult& result) {
    Json entries = Json::object();
    for (const EntryResult& entry : result.entries) {
        Json out = {{"verdict", name(entry.verdict())}};
        if (entry.picture) {
            out["picture"] = {
                {"verdict", name(*entry.picture)}, {"pictures", entry.frames.size()}, {"words", entry.picture_lines}};
            out["picture"]["changed"] = Json::object();
            for (const auto& [number, frame] : entry.frames) {
                if (frame.verdict == Verdict::identical) continue;
                Json one = {{"verdict", name(frame.verdict)}, {"sha256", frame.sha256}};
                if (frame.compared) one["difference"] = picture(frame.comparison);
                out["picture"]["changed"][std::to_string(number)] = std::move(one);
            }
        }
        if (entry.motion)
            out["motion"] = {
                {"verdict", name(*entry.motion)}, {"words", entry.motion_lines}, {"files", entry.motion_files}};
        if (entry.reproducible_until) out["reproducible_until"] = *entry.reproducible_until;
        if (!entry.not_reproducible.empty()) out["not_reproducible"] = entry.not_reproducible;
        if (!entry.renderer.empty()) {
            out["renderer"] = entry.renderer;
            out["sha256"] = Json::array();  // of all its pictures
            for (const auto& [number, frame] : entry.frames) out["sha256"].push_back(frame.sha256);
        }
        if (entry.updated) out["updated"] = true;
        if (entry.digest_added) out["digest_added"] = true;
        entries[entry.name] = std::move(out);
    }
    return text_of({{"baselines", result.baselines},
                    {"entries", std::move(entries)},
                    {"renderers", result.renderers},
                    {"simulations", result.simulations},
                    {"pictures", result.pictures},
                    {"seconds", result.seconds},
                    {"changed", result.changed}});
}

Report read_report(const std::filesystem::path& given) {
    Report report{folder_of_report(given), {}, {}, {}};
    const fs::path file = report.folder / kReportFile;
    try {
        const auto json = nlohmann::json::parse(output::read_file(file));
        report.baselines = json.at("baselines").get<std::string>();
        report.renderers = json.at("renderers").get<std::map<std::string, RendererParts>>();
        for (const auto& [name, entry] : json.at("entries").items())
            if (!verdict_is(entry, {Verdict::identical})) report.entries[name] = reported_entry(entry);
    } catch (const std::exception& error) {
        throw output::IoError(fmt::format("cannot read {}: {}", file.string(), error.what()));
    }
    return report;
}

}  // namespace beamcam::scenes
