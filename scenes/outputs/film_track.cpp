#include "scenes/outputs/film_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/json/tree.hpp"
#include "render/plot/ticks.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kTogether = 0.4, kDense = 0.1, kFilmShown = 2.5;  // [s] of the film

struct Group {
    std::size_t first = 0, last = 0;  // impacts, from 0
    double from = 0, until = 0;       // first and last impact [s of the film]
    double force = 0;                 // [N]; 0: unknown
};

// Impacts within kTogether of the first one, and denser ones for as long as they go on.
std::vector<Group> groups_of(const render::FilmSetup& film) {
    std::vector<Group> out;
    const std::size_t frames = film.frames();
    std::size_t k = 0;
    for (std::size_t i = 0; i < film.impacts.size(); ++i) {
        const sim::Impact& impact = film.impacts[i];
        if (impact.t_start < film.time(0)) continue;
        while (k < frames && film.time(k) < impact.t_start) ++k;
        if (k == frames) break;
        const double at = static_cast<double>(k) / film.fps;
        const bool together = !out.empty() && (at - out.back().from < kTogether || at - out.back().until <= kDense);
        if (!together) out.push_back({.first = i, .from = at, .until = at});
        Group& group = out.back();
        group.last = i, group.until = at;
        group.force = std::max(group.force, impact.force_peak.value_or(0));
    }
    return out;
}

std::string name_of(const Group& g, Lang lang) {
    if (g.first == g.last) return phrase(lang, "Impact {}", g.first + 1);
    return phrase(lang, "Impacts {}–{}", g.first + 1, g.last + 1);
}

std::string text_of(const Group& g, const render::FilmSetup& film, Lang lang) {
    std::string text = fmt::format("{} · t = {:.4f}", name_of(g, lang), film.impacts[g.first].t_start);
    text += g.last > g.first ? fmt::format(" … {:.4f} s", film.impacts[g.last].t_start) : " s";
    if (g.force > 0) text += phrase(lang, " · up to {}", render::quantity(g.force, "N"));
    return text;
}

// "00:00:01.250", or with a comma.
std::string stamp(double seconds, char point) {
    const long ms = std::lround(seconds * 1000);
    return fmt::format("{:02}:{:02}:{:02}{}{:03}", ms / 3'600'000, ms / 60'000 % 60, ms / 1000 % 60, point, ms % 1000);
}

}  // namespace

FilmTrack film_track(const render::FilmSetup& film, Lang lang) {
    FilmTrack out;
    const std::vector<Group> groups = groups_of(film);
    const double end = static_cast<double>(film.frames()) / film.fps;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const double next = i + 1 < groups.size() ? groups[i + 1].from : end;
        out.subtitles.push_back({groups[i].from, std::min(next, std::max(groups[i].until, groups[i].from + kFilmShown)),
                                 text_of(groups[i], film, lang)});
        if (out.chapters.empty() && groups[i].from > 0)
            out.chapters.push_back({0, groups[i].from, phrase(lang, "Start")});
        out.chapters.push_back({groups[i].from, next, name_of(groups[i], lang)});
    }
    for (const render::Callout& c : film.callouts)
        out.subtitles.push_back(
            {c.first / film.fps, std::min(end, (c.last + 1) / film.fps), render::plain_text(c.text)});
    std::erase_if(out.subtitles, [](const Cue& cue) { return !(cue.to > cue.from); });
    std::ranges::stable_sort(out.subtitles, {}, &Cue::from);
    return out;
}

// The text of a cue: without empty lines, which would end it, and without markup.
static std::string cue_text(std::string text, bool vtt) {
    for (std::size_t at = 0; (at = text.find("\n\n", at)) != std::string::npos;) text.erase(at, 1);
    if (vtt) {
        replace_all(text, "&", "&amp;");
        replace_all(text, "<", "&lt;");
        replace_all(text, ">", "&gt;");
    } else {  // SubRip has no escapes: an invisible character makes a tag plain text
        replace_all(text, "<", "<\u2060");
    }
    return text;
}

std::vector<output::Chapter> subtitle_track(const std::vector<Cue>& cues) {
    std::vector<double> instants;
    for (const Cue& cue : cues) instants.insert(instants.end(), {cue.from, cue.to});
    std::ranges::sort(instants);
    std::vector<output::Chapter> out;
    for (std::size_t i = 0; i + 1 < instants.size(); ++i) {
        output::Chapter now{instants[i], instants[i + 1], {}};
        if (!(now.to - now.from > 1e-3)) continue;
        for (const Cue& cue : cues)
            if (cue.from < now.to && cue.to > now.from)
                now.title += (now.title.empty() ? "" : "\n") + cue_text(cue.text, false);
        const bool lasts = !out.empty() && out.back().to == now.from && out.back().title == now.title;
        if (lasts)
            out.back().to = now.to;
        else if (!now.title.empty())
            out.push_back(now);
    }
    return out;
}

std::string subtitle_file(const std::vector<Cue>& cues, Subtitles format) {
    const bool vtt = format == Subtitles::vtt;
    std::string out = vtt ? "WEBVTT\n\n" : "";
    for (std::size_t i = 0; i < cues.size(); ++i) {
        const std::string text = cue_text(cues[i].text, vtt);
        if (!vtt) out += fmt::format("{}\n", i + 1);
        const char point = vtt ? '.' : ',';
        out += fmt::format("{} --> {}\n{}\n\n", stamp(cues[i].from, point), stamp(cues[i].to, point), text);
    }
    return out;
}

}  // namespace beamcam::scenes
