// Paths, fills and strokes with Cairo: the common base of pictures (Canvas) and pages (figure::PageCanvas). Units are
// those of the drawing, y down.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"

using cairo_t = struct _cairo;                  // NOLINT(bugprone-reserved-identifier): the library's own names
using cairo_surface_t = struct _cairo_surface;  // NOLINT(bugprone-reserved-identifier)

namespace beamcam::render {

enum class Cap { butt, round };
struct Pen {
    Color color;
    double width = 1;
    std::vector<double> dash = {};
    Cap cap = Cap::round;
};
// The dash pattern with each length multiplied by `unit`.
std::vector<double> dashes(const std::vector<double>& pattern, double unit);

// half_width: half the width relative to the length. back: distance of the notch from the tip relative to the length.
struct ArrowHead {
    double length = 0, half_width = 0.42, back = 1;
};

class Fonts;
struct Image;
struct SetLabel;
struct SetRun;
struct TextStyle;

class Painter {
  public:
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void move_to(Vec2 p);
    void line_to(Vec2 p);
    void polyline(std::span<const Vec2> points);  // NaN breaks the line
    void close();
    void arc(Vec2 centre, double radius, double from, double to);  // angles counter-clockwise, Y up [rad]
    void circle(Vec2 centre, double radius);
    void rectangle(const Box& box);
    void arrow(Vec2 from, Vec2 to, const Pen& pen, const ArrowHead& head);
    // Draws a text, which is markup (markup.hpp); returns its box.
    virtual Box text(Vec2 at, std::string_view markup, const TextStyle& style) = 0;
    // Over lines: on a box of the colour of its halo.
    void boxed_text(Vec2 at, std::string_view markup, const TextStyle& style);
    virtual Box measure(std::string_view markup, const TextStyle& style) const = 0;  // at (0, 0), left, not turned
    double cap_height(double size) const;                                            // of capitals and digits
    void fill(Color color);
    void fill_keeping_path(Color color);
    // Fills the area between an outline and one inside of it, whose corners run the same way.
    void fill_between(std::span<const Vec2> outer, std::span<const Vec2> inner, Color color);
    void stroke(const Pen& pen);
    void line(Vec2 from, Vec2 to, const Pen& pen);
    // A line through any number of points; NaN breaks it.
    virtual void curve(std::span<const Vec2> points, const Pen& pen);
    // Clips everything that `draw` draws to the box.
    void clip(const Box& box, const std::function<void()>& draw);
    // Draws on a layer of its own, of which parts can be erased, and blends it.
    void layer(double opacity, const std::function<void()>& draw);
    void erase(const Box& box, double share);
    // Draws the image into the box, each pixel a rectangle.
    void pixels(const Image& image, const Box& into);

    // The colour of a halo of all texts and strokes, for pictures without paper; null: texts have those of their
    // styles.
    std::optional<Color> halo_of_all = {};
    void without_halo(const std::function<void()>& draw);

    // If set, collects the painted tiles (a superset of the changed pixels).
    DirtyTiles* touched = nullptr;

  protected:
    explicit Painter(const Fonts& fonts) : fonts_(&fonts) {}
    virtual ~Painter() noexcept(false) { end(); }
    // Takes over the surface. Throws PictureError if Cairo cannot draw on it; `what` names the picture in the message.
    void begin(cairo_surface_t* surface, const std::string& what);
    // Finishes the drawing and its surface. Throws if Cairo failed.
    void end();
    void set_source(Color color);
    void mark_painted(const Box& box);  // adds its tiles to `touched`, with a pixel of antialiasing
    void mark_path(double around);      // marks what the path reaches, this far beyond its points
    void new_path();
    // Draws the outline of a label's letters, which keeps them readable over drawings.
    static double halo_width(const TextStyle& style);
    void draw_halo(const SetLabel& label, Vec2 at, const TextStyle& style, Color color);
    // Draws a label whose baseline starts at `at`.
    void draw_label(const SetLabel& label, Vec2 at, const TextStyle& style);
    // Draws the letters of a run in the colour that is set.
    virtual void write(const SetRun& run, Vec2 at, const TextStyle& style);
    const Fonts* fonts_;
    cairo_t* cr_ = nullptr;
    Color (*recolor_)(Color) = nullptr;  // if set, maps colours before painting
    const Box* limit_ = nullptr;         // the clip; null: none

  private:
    cairo_surface_t* surface_ = nullptr;
    int exceptions_ = 0;  // number of active exceptions when drawing began
};

}  // namespace beamcam::render
