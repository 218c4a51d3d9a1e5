// Vertical lines of a series at instants: impacts, the ends of the intervals in which θ is not reproducible, and notes.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "render/base/error.hpp"
#include "scenes/figures/series.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

using Rules = std::vector<render::figure::Rule>;

constexpr std::size_t kMostRules = 60;  // more lines than these hide the curves

template <class Touch>
Rules starts_of(const std::vector<Touch>& touches, double from, double to) {
    Rules out;
    for (const Touch& touch : touches)
        if (touch.t_start >= from && touch.t_start <= to) out.push_back({.at = touch.t_start, .vertical = true});
    return out;
}

Rules impact_rules(const sim::Result& result, double from, double to) {
    Rules rules = marks_collisions(result, from, to) ? starts_of(result.collisions, from, to)
                                                     : starts_of(result.impacts, from, to);
    return rules.size() > kMostRules ? Rules{} : rules;
}

// The ends of the intervals in which θ is not reproducible.
Rules horizon_rules(const sim::Result& result, double from, double to, Lang lang) {
    Rules rules;
    for (const UnreliableInterval& interval : unreliable_intervals(result, to))
        for (const double t : {interval.from, interval.to})
            if (t > from && t < to)
                rules.push_back({.at = t,
                                 .vertical = true,
                                 .label = rules.empty() ? phrase(lang, "paler: $θ$ not reproducible") : ""});
    return rules;
}

Rules note_rules(const std::vector<SeriesNote>& notes, const sim::Result& result, double from, double to,
                 bool with_text) {
    Rules rules;
    for (const SeriesNote& note : notes) {
        const double t = note.at.kind == Instant::Kind::last ? to : instant_of(note.at, result);
        if (t < from || t > to)
            throw render::PictureError(
                fmt::format("series: the note at {} is outside of {:g} s … {:g} s", name_of(note.at), from, to));
        rules.push_back({.at = t, .vertical = true, .label = with_text ? note.text : ""});
    }
    return rules;
}

}  // namespace

bool marks_collisions(const sim::Result& result, double from, double to) {
    return starts_of(result.impacts, from, to).size() > kMostRules;
}

Rules series_rules(const SeriesPlan& plan, const PlannedPanel& panel, const MotionResults& results) {
    Rules all;
    if (!plan.abscissa.is_time()) return all;
    const SeriesMotion& first = plan.motions[panel.motions.front()];
    const sim::Result& result = *results[first.request];
    const double from = plan.keys.from, to = plan.end;
    if (plan.keys.impacts)
        all = impact_rules(result, from, to);
    else if (panel.motions.size() == 1)
        all = horizon_rules(result, from, to, plan.lang);
    std::ranges::move(note_rules(plan.keys.notes, result, from, to, panel.number == 0), std::back_inserter(all));
    for (render::figure::Rule& rule : all) rule.at *= plan.abscissa.per_second(first.problem);
    return all;
}

}  // namespace beamcam::scenes
