#include "scenes/regression/tolerance.hpp"

#include <fmt/format.h>

#include "output/files/numbers.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
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
    Tolerances tolerances;
    read_object(
        object_node({{"--tolerance", std::move(given)}}), "the options",
        [&tolerances](ObjectReader& r) { r.object("--tolerance", tolerances, ""); }, messages);
    if (!messages.empty()) throw UsageError(messages.front().text);
    return tolerances.common;
}

}  // namespace beamcam::scenes
