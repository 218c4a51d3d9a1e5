// JSON of what the commands around regression tests find.
#include <cmath>
#include <nlohmann/json.hpp>

#include "scenes/comparison.hpp"

namespace beamcam::scenes {
namespace {

using Json = nlohmann::ordered_json;

// File names need not be UTF-8; what is not becomes U+FFFD.
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

}  // namespace beamcam::scenes
