// The signs of markup: their LaTeX commands, and characters of UTF-8.
#pragma once

#include <glib.h>

#include <array>
#include <string_view>
#include <utility>

namespace beamcam::render {

using SignPair = std::pair<std::string_view, std::string_view>;

// Greek letters and signs of mathematical text, and their LaTeX commands.
inline constexpr std::array kLatexMath{
    SignPair{"α", "\\alpha"},   SignPair{"β", "\\beta"},   SignPair{"γ", "\\gamma"}, SignPair{"δ", "\\delta"},
    SignPair{"ε", "\\epsilon"}, SignPair{"ζ", "\\zeta"},   SignPair{"η", "\\eta"},   SignPair{"θ", "\\theta"},
    SignPair{"κ", "\\kappa"},   SignPair{"λ", "\\lambda"}, SignPair{"μ", "\\mu"},    SignPair{"ν", "\\nu"},
    SignPair{"ξ", "\\xi"},      SignPair{"π", "\\pi"},     SignPair{"ρ", "\\rho"},   SignPair{"σ", "\\sigma"},
    SignPair{"τ", "\\tau"},     SignPair{"φ", "\\varphi"}, SignPair{"χ", "\\chi"},   SignPair{"ψ", "\\psi"},
    SignPair{"ω", "\\omega"},   SignPair{"Θ", "\\Theta"},  SignPair{"Δ", "\\Delta"}, SignPair{"Σ", "\\Sigma"},
    SignPair{"Ω", "\\Omega"},   SignPair{"×", "\\times"},  SignPair{"·", "\\cdot"},  SignPair{"≥", "\\ge"},
    SignPair{"≤", "\\le"},      SignPair{"≈", "\\approx"}, SignPair{"√", "\\surd"},  SignPair{"∞", "\\infty"},
    SignPair{"±", "\\pm"},      SignPair{"∫", "\\int"},    SignPair{"∑", "\\sum"},   SignPair{"∂", "\\partial"},
    SignPair{"→", "\\to"}};

inline std::string_view next_character(std::string_view text, std::size_t at) {
    return text.substr(at, std::size_t(g_utf8_next_char(&text[at]) - &text[at]));
}

// Calls visit(character, rest of the text) for each character.
template <class Visit>
void each_character(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        const std::string_view c = next_character(text, 0);
        text.remove_prefix(c.size());
        visit(c, text);
    }
}

inline bool is_digit(std::string_view c) { return c[0] >= '0' && c[0] <= '9'; }

// ASCII and Greek letters, which are italic in mathematics.
inline bool is_letter(std::string_view c) {
    if (c.size() == 1) return (c[0] >= 'a' && c[0] <= 'z') || (c[0] >= 'A' && c[0] <= 'Z');
    if (c.size() != 2) return false;
    const unsigned code = (static_cast<unsigned char>(c[0]) & 31u) << 6 | (static_cast<unsigned char>(c[1]) & 63u);
    return code >= 0x391 && code <= 0x3C9;
}

}  // namespace beamcam::render
