#include "render/film/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "render/draw/dirty_tiles.hpp"
#include "render/film/caption_band.hpp"
#include "render/film/clock_line.hpp"
#include "render/film/mechanism_panel.hpp"
#include "render/film/moment_bar.hpp"
#include "render/film/panel.hpp"
#include "render/film/parameter_line.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {

// ---- data prepared once for a film -------------------------------------------------------------

struct Film::Prepared {
    FilmContext context;
    std::vector<std::unique_ptr<FilmPanel>> panels;
    const MechanismPanel* mechanism = nullptr;  // the first mechanism panel
    Image background;                           // everything that never changes
    std::vector<Box> background_texts;          // their ink
    std::optional<ClockLine> clock;
    std::optional<CaptionBand> captions;
    std::vector<std::string> cut_texts;

    explicit Prepared(std::shared_ptr<const FilmSetup> setup) : context(std::move(setup)) {
        for (const PanelSlot& slot : context.places.panels) {
            panels.push_back(type_of(slot.spec.kind).make(context, slot));
            if (slot.spec.kind == PanelKind::mechanism && !mechanism)
                mechanism = static_cast<const MechanismPanel*>(panels.back().get());
        }
        background = Image(context.setup->width, context.setup->height);
        Canvas canvas(background, *context.fonts);
        canvas.record = &background_texts;
        if (draw_background(canvas)) cut_texts.emplace_back("the title");
        clock.emplace(context);
        captions.emplace(context);
        if (std::ranges::any_of(panels, [](const auto& panel) { return panel->cuts_names(); }))
            cut_texts.emplace_back("names");
        if (captions->cuts_texts()) cut_texts.emplace_back("captions");
        context.fonts.reset();
        context.extent = {};  // not needed for drawing
    }

    // True: the title is cut.
    bool draw_background(Canvas& canvas) const;
    void draw_moving(Canvas& canvas, int frame, Style style, std::vector<BodyPicture>& bodies) const;

  private:
    bool draw_header(Canvas& canvas) const;
    bool begins_later(const FilmPanel& panel) const { return panel.begins() > context.clock.at(0); }
};

// What a thread keeps between frames. A frame is the background with the moving parts on top, unclipped; so its pixels
// do not depend on which frame was drawn before.
struct Film::FrameRenderer {
    explicit FrameRenderer(const Prepared& p)
        : fonts(p.context.look.cjk),
          bodies(p.panels.size()),
          picture(p.background.width, p.background.height),
          moved(picture.width, picture.height),
          changed(moved) {
        ++p.context.counts->font_sets;
    }

    Fonts fonts;
    std::vector<BodyPicture> bodies;  // of the panels
    Image picture;
    int frame = -1;      // in the picture; < 0: none
    DirtyTiles moved;    // where the picture may differ from the background
    DirtyTiles changed;  // where the picture may differ from the previous one
};

// ---- the background --------------------------------------------------------------------------

bool Film::Prepared::draw_background(Canvas& canvas) const {
    canvas.halo_of_all = context.look.palette.halo_of_all();
    if (!context.setup->view.transparent) canvas.paint(context.look.palette.paper);
    const bool cut = draw_header(canvas);
    for (const auto& panel : panels)
        if (!begins_later(*panel)) panel->draw_background(canvas);
    draw_moment_bar(canvas, context);
    return cut;
}

bool Film::Prepared::draw_header(Canvas& canvas) const {
    bool cut = false;
    const double u = context.look.unit;
    const FilmSetup& setup = *context.setup;
    const Layout& places = context.places;
    if (const auto& b = places.title; b && !setup.title.empty()) {
        TextStyle style = title_style(context.look.letters, context.look.palette.ink);
        const std::vector<FittedText> lines =
            fitted_lines(canvas, setup.title, style, 0.7 * style.size, context.look.letters.heading, b->w);
        cut = lines.back().cut;
        for (double y = b->y + 0.95 * style.size; const FittedText& line : lines) {
            style.size = line.size;
            canvas.text({b->x, y - (lines.size() > 1 ? 0.9 * line.size : 0)}, line.markup, style);
            y += 1.05 * line.size;
        }
    }
    std::vector<const sim::Problem*> problems;
    for (int m = 0; m < context.members(); ++m) problems.push_back(&context.motion(m).problem);
    const ParameterLine line =
        parameter_line(canvas, places, compared_pieces(problems, context.labels, context.look.lang, setup.units.speed));
    for (const ParameterLine::Piece& piece : line.pieces)
        canvas.text(piece.baseline, piece.markup, {.size = line.size, .color = context.look.palette.muted});
    if (const auto& b = places.warning; b && !setup.warning.empty())
        canvas.text({b->right(), b->y + 19 * u}, text_markup(setup.warning),
                    {.size = context.look.letters.words,
                     .color = context.look.palette.muted,
                     .align = HAlign::right,
                     .max_width = b->w});
    return cut;
}

// ---- the film --------------------------------------------------------------------------------

Film::Film(FilmSetup setup) : Film(std::make_shared<const FilmSetup>(std::move(setup))) {}
Film::Film(std::shared_ptr<const FilmSetup> setup) : Film(std::make_shared<const Prepared>(std::move(setup))) {}
Film::Film(std::shared_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
Film::~Film() = default;
Film::Film(Film&&) noexcept = default;

Film Film::for_thread() const { return Film(prepared_); }
int Film::frames() const { return prepared_->context.frames(); }
double Film::exaggeration() const { return prepared_->context.scales.exaggeration; }
bool Film::exaggeration_reduced() const {
    const FilmContext& context = prepared_->context;
    bool flexible = false;
    for (int m = 0; m < context.members(); ++m)
        flexible = flexible || context.motion(m).problem.beam.model != sim::ModelKind::rigid;
    return flexible && context.scales.exaggeration < context.setup->view.exaggeration.value_or(1);
}
bool Film::states_exaggeration() const { return prepared_->clock->states_exaggeration(); }
bool Film::has_mechanism() const { return prepared_->context.places.first(PanelKind::mechanism) != nullptr; }
bool Film::shows_captions() const { return prepared_->context.places.captions.has_value(); }
bool Film::shows_clock_line() const { return prepared_->clock->has_room(); }
const std::vector<std::string>& Film::cut_texts() const { return prepared_->cut_texts; }
int Film::empty_frames() const { return prepared_->mechanism ? prepared_->mechanism->empty_frames() : 0; }
const DrawingCounts& Film::counts() const { return *prepared_->context.counts; }

bool Film::repeats(int frame) const {
    if (frame < 1 || frame >= frames()) return false;
    const FilmSetup& setup = *prepared_->context.setup;
    const auto now = static_cast<std::size_t>(frame), before = now - 1;
    if (!setup.speeds.empty() && setup.speeds[now] != setup.speeds[before]) return false;
    for (const Callout& callout : setup.callouts)
        if (callout.opacity(frame) != callout.opacity(frame - 1)) return false;
    if (std::ranges::any_of(prepared_->panels, [&](const auto& panel) { return panel->animates_while_paused(frame); }))
        return false;
    const auto still = [&](const Motion& motion) { return motion.time(now) == motion.time(before); };
    return still(setup) && std::ranges::all_of(setup.others, still);
}

void Film::Prepared::draw_moving(Canvas& canvas, int frame, Style style, std::vector<BodyPicture>& bodies) const {
    for (std::size_t i = 0; i < panels.size(); ++i) {
        if (panels[i]->begins() > context.clock.at(frame)) continue;
        if (begins_later(*panels[i])) panels[i]->draw_background(canvas);
        panels[i]->draw(canvas, frame, style, bodies[i]);
    }
    captions->draw(canvas, frame);
    clock->draw(canvas, frame);
}

// Created on first use: a film that is only copied never draws.
Film::FrameRenderer& Film::renderer_for(int frame) {
    if (frame < 0 || frame >= frames()) throw std::out_of_range(fmt::format("frame {} of {}", frame, frames()));
    if (!renderer_) renderer_ = std::make_unique<FrameRenderer>(*prepared_);
    return *renderer_;
}

const Image& Film::draw(int frame) {
    FrameRenderer& t = renderer_for(frame);
    t.changed.clear();
    if (t.frame == frame) return t.picture;
    if (std::exchange(t.frame, -1) < 0) t.moved.add_all();  // the first picture, or the last one failed
    t.changed.add(t.moved);
    copy(prepared_->background, t.picture, t.changed);
    t.moved.clear();
    Canvas canvas(t.picture, t.fonts);
    canvas.halo_of_all = prepared_->context.look.palette.halo_of_all();
    canvas.touched = &t.moved;
    prepared_->draw_moving(canvas, frame, prepared_->context.setup->view.style, t.bodies);
    t.changed.add(t.moved);
    t.frame = frame;
    return t.picture;
}

const DirtyTiles& Film::changed() const {
    if (!renderer_) throw std::logic_error("Film::changed: nothing is drawn yet");
    return renderer_->changed;
}

void Film::draw(int frame, Image& out) { out = draw(frame); }

std::string Film::draw(int frame, Medium medium, const Document& document) {
    const Prepared& p = *prepared_;
    FrameRenderer& t = renderer_for(frame);
    const int width = p.background.width, height = p.background.height;
    VectorFile file(medium, width * kPointsPerPixel, height * kPointsPerPixel, document);
    {
        Canvas canvas(file, width, height, t.fonts);
        p.draw_background(canvas);
        p.draw_moving(canvas, frame, p.context.setup->view.style, t.bodies);
    }
    return file.take_bytes();
}

FrameGeometry Film::geometry(int frame) {
    const Prepared& p = *prepared_;
    FrameRenderer& t = renderer_for(frame);
    FrameGeometry out{p.context.places, {}, {}, p.background_texts};
    Image scratch = p.background;
    Canvas canvas(scratch, t.fonts);
    canvas.halo_of_all = p.context.look.palette.halo_of_all();
    canvas.record = &out.texts;
    p.draw_moving(canvas, frame, Style::flat, t.bodies);
    if (p.mechanism) {
        out.camera = p.mechanism->camera(frame);
        out.beam = p.mechanism->beam(frame);
    }
    return out;
}

}  // namespace beamcam::render
