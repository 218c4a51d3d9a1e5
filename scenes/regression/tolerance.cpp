#include "scenes/regression/tolerance.hpp"

#include <fmt/format.h>

#include "output/files/numbers.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::size_t kDigits = 12;  // of a renderer's id (Fingerprint::id)

bool is_id(const std::string& text) {
    return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void read_pictures(ObjectReader& f, Tolerance& tolerance) {
    f.integer("channel", tolerance.channel, 0, 255, "Of a pixel's channel, in levels.");
    f.number("share", tolerance.share, dimension::kNone, sim::between(0, 1), "Of the pixels that may differ by more.");
    f.number("ssim", tolerance.ssim, dimension::kNone, sim::between(0, 1),
             "Pictures at least so similar are equivalent.");
}

}  // namespace

Tolerance Tolerance::overridden_by(const Tolerance& over) const {
    return {over.channel ? over.channel : channel, over.share ? over.share : share, over.ssim ? over.ssim : ssim,
            over.motion ? over.motion : motion, over.impacts ? over.impacts : impacts};
}

Tolerances Tolerances::overridden_by(const Tolerances& over) const {
    Tolerances all{usual.overridden_by(over.usual), {}};
    for (const auto* each : {this, &over})
        for (const auto& [id, ignored] : each->on)
            all.on[id] = on_renderer(id)
                             .overridden_by(over.usual)
                             .overridden_by(over.on.contains(id) ? over.on.at(id) : Tolerance());
    return all;
}

const Tolerance& Tolerances::on_renderer(const std::string& renderer) const {
    const auto own = on.find(renderer);
    return own == on.end() ? usual : own->second;
}

void read_tolerances(Diagnostics& diagnostics, const Node& node, const std::string& path, Tolerances& tolerances) {
    ObjectReader f(diagnostics, &node, path);
    read_pictures(f, tolerances.usual);
    f.number("motion", tolerances.usual.motion, dimension::kNone, sim::between(0, 1), "Of a channel's range.");
    f.number("impacts", tolerances.usual.impacts, dimension::kNone, sim::between(0, 1), "Of an impact's quantities.");
    if (const Node* renderers = f.take("renderers")) {
        const ObjectReader all(diagnostics, renderers, path + ".renderers");
        for (const Member& member : renderers->members) {
            const std::string own_path = all.path(member.key);
            if (!is_id(member.key))
                diagnostics.error(member.key_place, own_path,
                                  fmt::format("{} is no renderer: beamcam doctor prints the ids of this machine",
                                              in_quotes(member.key)));
            ObjectReader own(diagnostics, &member.value, own_path);
            read_pictures(own, tolerances.on[member.key]);
            own.finish();
        }
    }
    f.finish();
}

void apply_tolerance(Tolerance& tolerance, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const auto number = output::number_in<double>(equals == std::string::npos ? "" : text.substr(equals + 1));
    if (!number)
        throw UsageError(
            fmt::format("--tolerance {}: write channel=2, share=1e-4, ssim=0.98, motion=1e-5 or impacts=1e-4", text));
    const double value = *number;
    if (key == "channel") {
        if (!(value >= 0 && value <= 255 && value == static_cast<int>(value)))
            throw UsageError(fmt::format("--tolerance {}: a channel differs by 0 … 255", text));
        tolerance.channel = static_cast<int>(value);
        return;
    }
    if (!(value >= 0 && value <= 1)) throw UsageError(fmt::format("--tolerance {}: must lie in 0 … 1", text));
    if (key == "share")
        tolerance.share = value;
    else if (key == "ssim")
        tolerance.ssim = value;
    else if (key == "motion")
        tolerance.motion = value;
    else if (key == "impacts")
        tolerance.impacts = value;
    else
        throw UsageError(fmt::format("--tolerance {}: unknown tolerance {}{}", text, in_quotes(key),
                                     suggestion_or_list(key, {"channel", "share", "ssim", "motion", "impacts"})));
}

}  // namespace beamcam::scenes
