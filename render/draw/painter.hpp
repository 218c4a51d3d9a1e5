// Paths, fills and strokes with Cairo: what a picture (Canvas) and a sheet of paper (figure::PageCanvas) have in
// common. Units are the drawing's own, y down.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/coverage_cache.hpp"
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
// A pattern of dashes, each multiplied by `unit`.
std::vector<double> dashes(const std::vector<double>& pattern, double unit);

// In parts of its length: half its width, and how far from the tip its back stands on the shaft.
struct ArrowHead {
    double length = 0, half_width = 0.42, back = 1;
};

struct Image;
struct SetLabel;
struct SetRun;

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
    void fill(Color color);
    void fill_keeping_path(Color color);
    void stroke(const Pen& pen);
    void line(Vec2 from, Vec2 to, const Pen& pen);
    // What `draw` draws shows within the box only.
    void clip(const Box& box, const std::function<void()>& draw);
    // The whole image, each pixel a rectangle.
    void pixels(const Image& image, const Box& into);
    // The same smoothly, made smaller or larger.
    void image_fitted(const Image& image, const Box& into);

    // Where ink went, while this is set: never too few tiles.
    DirtyTiles* touched = nullptr;
    // What is drawn where the picture before had it is painted through these, while they and `touched` are set.
    CoverageCache* coverage_cache = nullptr;

  protected:
    Painter() = default;
    ~Painter() noexcept(false) { end(); }
    // Takes the surface over, before anything is drawn. Throws PictureError where Cairo cannot draw `what` on it.
    void begin(cairo_surface_t* surface, const std::string& what);
    // Ends the drawing, what it is drawn on included: while that is there. Throws what Cairo could not draw.
    void end();
    void use(Color color);       // for what is painted next
    void touch(const Box& box);  // ink within it, blurred edges included
    void pass(const Box& box);   // the path is there
    void new_path();
    // What else tells this path from others.
    void note(char what, std::initializer_list<double> numbers, std::string_view words = {});
    // Paints the path, or the stencil called `name` that it made.
    void ink(Color color, const std::string& name, const Box& box, const std::function<void(cairo_t*)>& paint);
    // The rules and dots of a label whose baseline begins here; `write` puts down the letters of each run.
    void set_down(const SetLabel& label, Vec2 at, double size, Color color,
                  const std::function<void(const SetRun&, Vec2 at)>& write);
    bool keeps_coverage() const { return coverage_cache && touched && !limit_; }
    cairo_t* cr_ = nullptr;
    Color (*recolor_)(Color) = nullptr;  // what is painted in place of a colour, while it is set
    const Box* limit_ = nullptr;         // nothing is painted beyond

  private:
    cairo_surface_t* surface_ = nullptr;
    int exceptions_ = 0;  // in flight when drawing began
    void place(const Image& image, const Box& into, bool smooth);
    void pass_line(Vec2 from, Vec2 to);
    void pass_arc(Vec2 centre, double radius, double from, double to);
    void touch_path(double around, bool inside);
    Box path_box() const;
    std::vector<Box> path_;  // boxes that the path keeps to, while `touched` is set
    std::string key_;        // of the path, while coverage is kept
    Vec2 start_, at_;        // of the open part of the path
    bool open_ = false;
};

}  // namespace beamcam::render
