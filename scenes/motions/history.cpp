#include "scenes/motions/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "output/files/atomic_file.hpp"

namespace beamcam::scenes {
namespace {

constexpr const char* kFile = "times";
constexpr const char* kHeader = "beamcam times 1";
constexpr std::size_t kMostKept = 2000;       // lines; the oldest are dropped
constexpr std::uintmax_t kLongest = 1 << 20;  // [bytes]; a longer file has another origin

using Lines = std::vector<std::pair<std::string, Cost>>;

// name, tab, seconds, tab, amount
Lines read(const std::filesystem::path& file) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    std::ifstream in(file);
    std::string line;
    if (error || size > kLongest || !std::getline(in, line) || line != kHeader) return {};
    Lines lines;
    while (std::getline(in, line)) {
        const std::size_t tab = line.find('\t');
        if (tab == std::string::npos) continue;
        Cost rate;
        if (std::sscanf(line.c_str() + tab, "\t%lf\t%lf", &rate.seconds, &rate.amount) != 2) continue;
        if (!(rate.seconds >= 0 && rate.amount >= 0 && std::isfinite(rate.seconds + rate.amount))) continue;
        lines.emplace_back(line.substr(0, tab), rate);
    }
    return lines;
}

}  // namespace

History::History(const std::filesystem::path& directory) : file_(directory / kFile) {
    for (const auto& [name, rate] : read(file_)) known_[name] = rate;
}

std::optional<Cost> History::find(const std::vector<std::string>& names, double units) const {
    for (const std::string& name : names)
        if (const auto known = known_.find(name); known != known_.end())
            return Cost{units * known->second.seconds, units * known->second.amount};
    return std::nullopt;
}

void History::note(const std::vector<std::string>& names, double units, double seconds, double amount) {
    if (file_.empty() || !(units > 0)) return;
    for (const std::string& name : names) {
        Cost rate{seconds / units, amount / units};
        if (const auto known = known_.find(name); known != known_.end()) {
            rate.seconds = 0.5 * (rate.seconds + known->second.seconds);
            rate.amount = 0.5 * (rate.amount + known->second.amount);
        }
        known_[name] = rate;
        noted_.emplace_back(name, rate);
    }
}

void History::save() {
    if (noted_.empty()) return;
    try {
        Lines lines = read(file_);
        std::erase_if(lines, [&](const auto& line) {
            return std::ranges::any_of(noted_, [&](const auto& noted) { return noted.first == line.first; });
        });
        lines.insert(lines.end(), noted_.begin(), noted_.end());
        const std::size_t first = lines.size() > kMostKept ? lines.size() - kMostKept : 0;
        std::string text = std::string(kHeader) + "\n";
        for (std::size_t i = first; i < lines.size(); ++i)
            text +=
                fmt::format("{}\t{:.4g}\t{:.4g}\n", lines[i].first, lines[i].second.seconds, lines[i].second.amount);
        output::ensure_directory(file_.parent_path());
        output::write_file(file_, text, output::Durability::buffered);
    } catch (const std::exception&) {  // only estimates are lost
    }
    noted_.clear();
}

// ---- names -----------------------------------------------------------------------------------------

std::vector<std::string> motion_work(const std::string& key, const sim::Problem& problem, bool read_back,
                                     bool horizon) {
    const std::string how = read_back ? "read " : horizon ? "integrate twice " : "integrate ";
    return {how + key.substr(0, 16), fmt::format("{}{}, {} modes, {}", how, name(problem.beam.model),
                                                 problem.beam.model == sim::ModelKind::rigid ? 0 : problem.beam.modes,
                                                 problem.cam ? "cam" : "no cam")};
}

}  // namespace beamcam::scenes
