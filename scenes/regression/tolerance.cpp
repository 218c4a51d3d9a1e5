#include "scenes/regression/tolerance.hpp"

#include <fmt/format.h>

#include "output/files/numbers.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::size_t kDigits = 12;  // of a renderer's id (Fingerprint::id)

bool is_id(const std::string& text) {
    return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void read_pictures(ObjectReader& f, Tolerance& tolerance) {
    f.integer("channel", tolerance.channel, 0, 255, "Difference of a pixel's channel, in levels.");
    f.number("share", tolerance.share, dimension::kNone, sim::between(0, 1),
             "Share of the pixels that may differ by more.");
    f.number("ssim", tolerance.ssim, dimension::kNone, sim::between(0, 1),
             "Pictures with at least this structural similarity are equivalent.");
}

}  // namespace

Tolerance Tolerance::overridden_by(const Tolerance& over) const {
    return {over.channel ? over.channel : channel, over.share ? over.share : share, over.ssim ? over.ssim : ssim,
            over.motion ? over.motion : motion, over.impacts ? over.impacts : impacts};
}

Tolerances Tolerances::overridden_by(const Tolerances& over) const {
    Tolerances all{common.overridden_by(over.common), {}};
    for (const Tolerances* each : {this, &over})
        for (const auto& [id, ignored] : each->by_renderer)
            all.by_renderer[id] =
                of(id)
                    .overridden_by(over.common)
                    .overridden_by(over.by_renderer.contains(id) ? over.by_renderer.at(id) : Tolerance());
    return all;
}

const Tolerance& Tolerances::of(const std::string& renderer) const {
    const auto own = by_renderer.find(renderer);
    return own == by_renderer.end() ? common : own->second;
}

void read_tolerances(Diagnostics& diagnostics, const Node& node, const std::string& path, Tolerances& tolerances) {
    ObjectReader f(diagnostics, &node, path);
    read_pictures(f, tolerances.common);
    f.number("motion", tolerances.common.motion, dimension::kNone, sim::between(0, 1), "Share of a channel's range.");
    f.number("impacts", tolerances.common.impacts, dimension::kNone, sim::between(0, 1),
             "Share of an impact's quantities.");
    if (const Node* renderers = f.take("renderers")) {
        const ObjectReader all(diagnostics, renderers, path + ".renderers");
        for (const Member& member : renderers->members) {
            const std::string own_path = all.path(member.key);
            if (!is_id(member.key))
                diagnostics.error(
                    member.key_place, own_path,
                    fmt::format("{} is not the id of a renderer; `beamcam doctor` prints those of this machine",
                                in_quotes(member.key)));
            ObjectReader own(diagnostics, &member.value, own_path);
            read_pictures(own, tolerances.by_renderer[member.key]);
            own.finish();
        }
    }
    f.finish();
}

Tolerance tolerance_argument(const std::vector<std::string>& texts) {
    Node given = object_node();
    std::vector<Message> messages;
    for (const std::string& text : texts) {
        const std::size_t sign = text.find('=');
        const auto number = sign == std::string::npos ? std::nullopt : output::number_in<double>(text.substr(sign + 1));
        if (!number)
            throw UsageError(fmt::format(
                "--tolerance {}: write channel=2, share=1e-4, ssim=0.98, motion=1e-5 or impacts=1e-4", text));
        Node value(*number);
        value.text = text.substr(sign + 1);  // as it was written, for messages
        set_value(given, text.substr(0, sign), std::move(value), messages);
    }
    Diagnostics diagnostics;
    Tolerances tolerances;
    read_tolerances(diagnostics, given, "--tolerance", tolerances);
    for (Message& message : diagnostics.take()) messages.push_back(std::move(message));
    if (!messages.empty()) throw UsageError(messages.front().text);
    return tolerances.common;
}

}  // namespace beamcam::scenes
