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
    Tolerance tolerance;
    read_object(
        object_node({{"--tolerance", std::move(given)}}), "the options",
        [&tolerance](ObjectReader& r) { r.object("--tolerance", tolerance, ""); }, messages);
    if (!messages.empty()) throw UsageError(messages.front().text);
    return tolerance;
}

}  // namespace beamcam::scenes
