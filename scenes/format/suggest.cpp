#include "scenes/format/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace beamcam::scenes {
namespace {

std::string folded(std::string_view word) {
    std::string out;
    for (char c : word)
        if (c != '_' && c != '-' && c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

// Optimal string alignment distance in bytes: exchanging two neighbours counts once.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t row = b.size() + 1;
    std::vector<std::size_t> table((a.size() + 1) * row);
    const auto d = [&](std::size_t i, std::size_t j) -> std::size_t& { return table[i * row + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) d(i, 0) = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d(0, j) = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            d(i, j) = std::min({d(i - 1, j) + 1, d(i, j - 1) + 1, d(i - 1, j - 1) + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d(i, j) = std::min(d(i, j), d(i - 2, j - 2) + 1);
        }
    return d(a.size(), b.size());
}

// Whether the word is a part of a name between dots and underscores: "force" of "contact_force".
bool is_part(const std::string& word, std::string name) {
    for (char& c : name)
        if (c == '.') c = '_';
    return word.size() >= 3 && ("_" + name + "_").find("_" + word + "_") != std::string::npos;
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::size_t kLongest = 64;  // a longer word is not a typing error
    constexpr std::size_t kMost = 3;      // equally near words
    if (word.empty() || word.size() > kLongest) return {};
    const std::string target = folded(word);
    std::vector<std::string> best;
    std::pair<std::size_t, std::size_t> least{1 + std::max<std::size_t>(1, target.size() / 3), 0};
    for (const std::string& candidate : known) {
        const std::string form = folded(candidate);
        std::size_t distance = edit_distance(target, form);
        // "young" for "youngs_modulus": a prefix of at least three letters counts as one typing error.
        if (target.size() >= 3 && form.starts_with(target)) distance = std::min<std::size_t>(distance, 1);
        // "Mpa" is one letter from "MPa" and none from "mPa"; the case decides between equals.
        std::pair near{distance, edit_distance(word, candidate)};
        if (distance > 0 && is_part(std::string(word), candidate)) near = {1, 0};
        if (near < least) least = near, best.clear();
        if (near == least && std::ranges::find(best, candidate) == best.end()) best.push_back(candidate);
    }
    if (best.empty()) return {};
    best.resize(std::min(best.size(), kMost));
    return fmt::format("; did you mean \"{}\"?", fmt::join(best, "\" or \""));
}

std::string suggestion_or_list(std::string_view word, const std::vector<std::string>& known) {
    std::string near = suggestion(word, known);
    return !near.empty() ? near : fmt::format("; the choices are {}", fmt::join(known, ", "));
}

}  // namespace beamcam::scenes
