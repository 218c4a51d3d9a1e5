// The markup of labels, which can be drawn, or converted to plain text.
//
//   $θ$ / rad          letters between dollars are italic symbols, digits and signs stay upright
//   $x_{c}$, m s^{−1}  sub- and superscripts, in braces or a single character; braces needed outside dollars
//   $\dot{θ}$          a dot above, \ddot two
//   $\frac{a}{b}$      a/b, \sqrt{a} √a; $\omega$ and other LaTeX names of Greek letters and signs
//   \r{…}               upright
//   \color{#0072b2}{…}  in this colour; outside dollars
//   \$ \\ \_ \^        are literal characters.
//
// Invalid markup throws std::invalid_argument.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

struct Run {
    std::string text;
    bool symbol = false;                      // italic
    int script = 0;                           // −1 below, +1 above
    int dots = 0;                             // above the run
    std::optional<std::uint32_t> color = {};  // 0xrrggbb; none: that of the text
    bool operator==(const Run&) const = default;
};

std::string power_of_ten(int exponent);  // as markup: "10^{−8}"

std::vector<Run> parse_markup(std::string_view markup);
std::string to_plain(std::string_view markup);
std::string to_html(std::string_view markup);  // symbols in italics, scripts raised and lowered
std::string escaped(std::string_view plain);   // as markup
std::string xml(std::string_view plain);

}  // namespace beamcam::render
