// The labels of the channels (sim/observe/channels.hpp) in films and in print.
#pragma once

#include <string>

#include "render/plot/lang.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::render {

// The words before the symbol of a channel, as markup: "Hub angle ".
std::string heading(sim::ChannelKind kind, Lang lang);
// The subscript of the symbol; of a modal coordinate its number.
std::string subscript(sim::Channel channel);
// Markup of figures (render/draw/markup.hpp): "$\dot{θ}$", "$q_{1}$".
std::string print_symbol(sim::Channel channel);

}  // namespace beamcam::render
