// Labels as data: a small markup that is drawn, written as LaTeX and written plainly from one source.
//
//   $θ$ / rad          letters between dollars are italic symbols, digits and signs stay upright
//   $x_{c}$, m s^{−1}  sub- and superscripts, in braces or a single character; braces needed outside dollars
//   $\dot{θ}$          a dot above, \ddot two
//   $\frac{a}{b}$      above each other, \sqrt{a} under a root; $\omega$ and other names of LaTeX for Greek and signs
//   \r{…} \b{…}        upright; bold.   \$ \\ \_ \^ stand for themselves.
//
// Markup that cannot be read throws std::invalid_argument.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

struct Run {
    std::string text;
    bool symbol = false;  // italic
    bool bold = false;
    int script = 0;                          // −1 below, +1 above
    int dots = 0;                            // above the run
    std::vector<Run> over = {}, under = {};  // in place of the text: a fraction; without `under` a root
    bool operator==(const Run&) const = default;
};

std::string power_of_ten(int exponent);  // as markup: "10^{−8}"

std::vector<Run> parse_markup(std::string_view markup);
std::string to_latex(std::string_view markup);
std::string to_plain(std::string_view markup);
std::string escaped(std::string_view plain);  // as markup

}  // namespace beamcam::render
