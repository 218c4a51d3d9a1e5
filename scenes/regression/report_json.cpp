// Comparisons and results of regression tests as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "output/json/tree.hpp"
#include "scenes/regression/comparison.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

Node box(const output::PixelBox& b) {
    if (b.empty()) return {};
    return object_node({{"left", b.left}, {"top", b.top}, {"width", b.width()}, {"height", b.height()}});
}

Node picture_part(const EntryResult& entry) {
    Node changed = object_node();
    for (const auto& [number, frame] : entry.frames) {
        if (frame.verdict == Verdict::identical) continue;
        Node one = object_node({{"verdict", name(frame.verdict)}, {"sha256", frame.sha256}});
        if (frame.compared) add(one, "difference", to_node(frame.comparison));
        add(changed, std::to_string(number), std::move(one));
    }
    return object_node({{"verdict", name(*entry.picture)},
                        {"pictures", entry.frames.size()},
                        {"messages", entry.picture_lines},
                        {"changed", std::move(changed)}});
}

Node entry_node(const EntryResult& entry) {
    Node out = object_node({{"verdict", name(entry.verdict())}});
    if (entry.picture) add(out, "picture", picture_part(entry));
    if (entry.motion)
        add(out, "motion", object_node({{"verdict", name(*entry.motion)}, {"messages", entry.motion_lines}}));
    const auto names = [](const std::vector<std::filesystem::path>& files) {
        return array_node(files, [](const std::filesystem::path& file) { return Node(file.string()); });
    };
    if (!entry.written.empty()) add(out, "written", names(entry.written));
    if (!entry.removed.empty()) add(out, "removed", names(entry.removed));
    return out;
}

}  // namespace

Node to_node(const PictureComparison& p) {
    Node out = object_node({{"size_a", p.size_a}, {"size_b", p.size_b}});
    if (!p.same_size()) return out;
    const output::PictureDifference& d = p.difference;
    add(out, "pixels", d.pixels);
    add(out, "changed", d.changed);
    add(out, "share", d.share());
    add(out, "largest", d.largest);
    add(out, "box", box(d.box));
    add(out, "ssim", d.ssim);
    return out;
}

Node to_node(const output::TableDifference& d) {
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

std::string to_json(const RegressionResult& result) {
    Node entries = object_node();
    for (const EntryResult& entry : result.entries) add(entries, entry.name, entry_node(entry));
    return to_text(object_node({{"baselines", result.baselines},
                                {"entries", std::move(entries)},
                                {"simulations", result.simulations},
                                {"pictures", result.pictures},
                                {"seconds", result.seconds}}));
}

}  // namespace beamcam::scenes
