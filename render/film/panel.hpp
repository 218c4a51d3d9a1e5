// A panel: a box of the frame, drawn in two layers: a background that never changes, and the moving parts on top.
//
// Panels are created once for a film and shared by all drawing threads, which keep nothing between frames but the
// OpenGL picture of each panel.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/film/film.hpp"
#include "render/film/view_extent.hpp"
#include "render/mechanism/trace.hpp"
#include "render/plot/labels.hpp"
#include "render/plot/style.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {

// The time of a film: the instants of its frames, and what its charts show.
struct FilmClock {
    std::vector<double> times;  // of the frames, the same for all motions [s]
    std::vector<int> moved;     // for each frame, the number up to it in which time moved
    Range span;                 // from the first to the last instant of frames and charts [s]
    TimeFormat format;
    double at(int frame) const { return times[static_cast<std::size_t>(frame)]; }  // [s]
};

// The scales that all motions of a film share.
struct FilmScales {
    double exaggeration = 1;   // of deflection
    double largest_force = 0;  // of the film: end of the trace's colours [N]
    Prefix force_unit{"",
                      1};    // of all forces: suits the smallest of the motions' largest ones, if all have four digits
    double arrow_force = 0;  // largest force of all frames, that of the longest arrow [N]
    double moment = 0;       // end of the colour scale; 0: no colouring [N m]
    double period = std::numeric_limits<double>::infinity();  // of the fastest motion's first vibration [s]
    bool turns = false;  // θ is in turns instead of degrees, because it exceeds two
};

// Colours, sizes and language of a film.
struct FilmLook {
    Palette palette;
    Lang lang = Lang::en;
    bool cjk = false;  // some text needs the Chinese font
    double unit = 1;   // [px] of one design pixel
    Letters letters;
    std::string translate(std::string_view english, const auto&... values) const {
        return phrase(lang, english, values...);
    }
};

// Everything that the panels of a film share. Created once, constant while frames are drawn.
struct FilmContext {
    explicit FilmContext(std::shared_ptr<const FilmSetup> setup);
    FilmContext(const FilmContext&) = delete;
    FilmContext& operator=(const FilmContext&) = delete;

    std::shared_ptr<const FilmSetup> setup;
    FilmLook look;
    FilmClock clock;
    FilmScales scales;
    Layout places;
    ViewExtent extent;                              // of all mechanisms
    std::vector<std::vector<TraceSample>> samples;  // for each motion
    std::shared_ptr<DrawingCounts> counts = std::make_shared<DrawingCounts>();
    std::vector<std::string> labels;  // labels of the motions, markup
    std::vector<std::string> data_labels;
    std::unique_ptr<const Fonts> fonts;  // only while the film is being prepared

    int frames() const { return static_cast<int>(setup->frames()); }
    int members() const { return 1 + static_cast<int>(setup->others.size()); }
    const Motion& motion(int member) const {
        return member == 0 ? static_cast<const Motion&>(*setup) : setup->others[static_cast<std::size_t>(member - 1)];
    }
    // Without forces that are rounding, and with that share of the moment.
    sim::Pose pose(int member, int frame) const;
    double moment_share(int frame) const;
    // For a motion without a cam: one that has a cam, whose section position the drawing takes over. Otherwise null.
    const sim::Problem* section_reference(int member) const;
    // Factor from SI to the unit in which a channel is displayed, and that unit.
    double shown_factor(sim::Channel channel) const;
    std::string shown_unit(sim::Channel channel) const;
    // Colour of a motion: the first one has the palette's colour of motion.
    Color member_color(int member) const { return series_color(look.palette, static_cast<std::size_t>(member)); }
    // Dashes distinguish curves for viewers with a colour deficiency [design px].
    static std::vector<double> dash_of(std::size_t curve) {
        return curve % 3 == 1   ? std::vector<double>{9, 4}
               : curve % 3 == 2 ? std::vector<double>{3, 3}
                                : std::vector<double>{};
    }
    bool names_in_panels() const;  // the names of compared motions are beside their mechanisms
    // The colours after those of the motions, as in figures.
    Color data_color(std::size_t k) const {
        return series_color(look.palette, static_cast<std::size_t>(members()) + k);
    }
    // Hub angle in data set k at time t, by linear interpolation; NaN where it has none [rad].
    double measured_angle(std::size_t k, double t) const;

  private:
    void check() const;
    void choose_look();
    void read_clock();
    void choose_scales();
    void place_panels();
};

using sim::kNan;
class BodyPicture;

class FilmPanel {
  public:
    virtual ~FilmPanel() = default;

    virtual void draw_background(Canvas& canvas) const = 0;

    // The panel is empty before this instant [s].
    virtual double begins() const { return -std::numeric_limits<double>::infinity(); }

    virtual bool cuts_names() const { return false; }  // of motions

    // The panel changes between the previous frame and this one even if both show the same instant.
    virtual bool animates_while_paused(int) const { return false; }

    // Draws the moving parts. `style` may be simpler than the view's. `bodies`: the thread's, of this panel.
    virtual void draw(Canvas& canvas, int frame, Style style, BodyPicture& bodies) const = 0;
};

template <class Panel>
std::unique_ptr<FilmPanel> make_panel(const FilmContext& context, const PanelSlot& slot) {
    return std::make_unique<Panel>(context, slot);
}

// ---- helpers that panels share ------------------------------------------------------------------

double first_period(const sim::Problem& problem);  // of the natural vibrations; infinity for a rigid beam [s]

double first_touch(const Motion& motion);        // [s]; infinity: none
double first_touch(const FilmContext& context);  // of all motions
// That touch, from which panels of the contact are shown; they always are in a film without one [s].
double begins_with_touch(const FilmContext& context);
// The column of a channel; null if the table has none.
const std::vector<double>* column(const sim::Table& table, sim::Channel channel);
// Linear interpolation in an increasing column of times; NaN outside and beside undefined rows.
double value_at(const std::vector<double>& times, const std::vector<double>& values, double t);
// Suffix of a panel's heading if the film has several motions: ", " and the motion's label (markup).
std::string motion_suffix(const FilmContext& context, int member);
void draw_heading(Canvas& canvas, const FilmContext& context, const Box& box, const std::string& markup);
// Strokes every bin with a force, strong over weak. `path(i)` adds the path of bin i. `color`: of a share of the scale.
void stroke_places(Canvas& canvas, const FilmContext& context, const std::vector<float>& places, double width,
                   const std::function<void(std::size_t)>& path, const std::function<Color(double)>& color);
inline Vec2 down(double angle) { return {std::cos(angle), -std::sin(angle)}; }  // unit vector in pixels

}  // namespace beamcam::render
