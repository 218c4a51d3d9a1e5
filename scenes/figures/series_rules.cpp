#include "scenes/figures/series_rules.hpp"

#include <fmt/format.h>

#include "render/base/error.hpp"
#include "scenes/figures/reproducible.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::size_t kMostRules = 60;  // more lines than these hide the curves

template <class Touch>
Rules begins(const std::vector<Touch>& touches, double from, double to) {
    Rules out;
    for (const Touch& touch : touches)
        if (touch.t_start >= from && touch.t_start <= to) out.push_back({.at = touch.t_start, .vertical = true});
    return out;
}

}  // namespace

bool marks_collisions(const sim::Result& result, double from, double to) {
    return begins(result.impacts, from, to).size() > kMostRules;
}

Rules impact_rules(const sim::Result& result, double from, double to) {
    Rules rules =
        marks_collisions(result, from, to) ? begins(result.collisions, from, to) : begins(result.impacts, from, to);
    return rules.size() > kMostRules ? Rules{} : rules;
}

Rules horizon_rules(const sim::Result& result, double from, double to) {
    Rules rules;
    for (const Lost& lost : unreliable(result, to))
        for (const double t : {lost.from, lost.to})
            if (t > from && t < to) rules.push_back({.at = t, .vertical = true});
    return rules;
}

Rules note_rules(const std::vector<SeriesNote>& notes, const sim::Result& result, double from, double to,
                 bool with_words) {
    Rules rules;
    for (const SeriesNote& note : notes) {
        const double t = note.at.kind == Instant::Kind::last ? to : instant_of(note.at, result);
        if (t < from || t > to)
            throw render::PictureError(
                fmt::format("series: the note at {} is outside of {:g} s … {:g} s", name_of(note.at), from, to));
        rules.push_back({.at = t, .vertical = true, .label = with_words ? note.text : ""});
    }
    return rules;
}

}  // namespace beamcam::scenes
