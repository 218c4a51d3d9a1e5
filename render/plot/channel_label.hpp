// Names and symbols of the channels in films and in print.
#pragma once

#include <string>

#include "render/plot/lang.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::render {

struct ChannelLabel {
    const char *words, *chinese;  // "Hub angle"
    const char *symbol, *subscript = "";
    bool rate = false;                              // the symbol's rate by time
    std::string heading(Lang lang) const;           // the words before the symbol, as markup
    std::string below(sim::Channel channel) const;  // the subscript; of a modal coordinate its number
};
const ChannelLabel& label_of(sim::ChannelKind kind);

// Markup of figures (render/draw/markup.hpp): "$\dot{θ}$", "$q_{1}$".
std::string print_symbol(sim::Channel channel);

}  // namespace beamcam::render
