// A film: everything that a sequence of frames shares is prepared once, then any frame can be drawn in any order
// with the same pixels. Nothing grows with the number of frames drawn, and nothing is kept from one to the next.
//
// The mechanism is drawn lit through OpenGL (lit.hpp) or flat with Cairo alone; titles, charts and labels are
// Cairo's in both. Drawing never changes what was simulated and never simulates.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/color.hpp"
#include "render/exaggeration.hpp"
#include "render/geometry.hpp"
#include "render/image.hpp"
#include "render/layout.hpp"
#include "sim/channels.hpp"
#include "sim/pose.hpp"
#include "sim/problem.hpp"
#include "sim/simulate.hpp"

namespace beamcam::render {

class Canvas;
struct MechanismShape;

enum class Style { lit, flat };

struct View {
    Style style = Style::lit;
    Theme theme = Theme::light;
    std::optional<double> exaggeration;  // of deflection, >= 1; absent: a round factor that shows it
};

struct FilmSetup {
    sim::Problem problem;
    std::string title;                // plain text; cut with an ellipsis when too long
    int width = 1920, height = 1080;  // [px], 1…16384
    View view;
    std::vector<sim::Pose> poses;  // one a frame, true geometry, times not decreasing, at least one
    sim::Table chart;              // t, theta, contact_force … over the whole film; any number of rows
    sim::Table trace;  // t, contact_x, contact_s, contact_force, finely sampled; rows with force > 0 are dots
    std::vector<sim::Impact> impacts;
    std::string accuracy_note;  // plain text in the corner; may be empty
};

// What a frame shows, for tests and for programs that compose frames.
struct FrameGeometry {
    Layout layout;
    Camera camera;
    double factor = 1;  // of exaggeration
    DrawnBeam beam;
    std::vector<Box> texts;  // ink of every text [px]
};

// One Film a thread; `another` shares all that is prepared. Throws PictureError for an impossible size, factor or an
// empty film; FontError and GlError (exit code 5) when fonts or the lit renderer are missing.
class Film {
  public:
    explicit Film(FilmSetup setup);
    explicit Film(std::shared_ptr<const FilmSetup> setup);
    ~Film();
    Film(Film&&) noexcept;
    Film& operator=(Film&&) noexcept;

    Film another() const;

    int frames() const;
    void draw(int frame, Image& out);   // `out` is resized as needed; 0 <= frame < frames()
    FrameGeometry geometry(int frame);  // of the flat view: loads no OpenGL
    double exaggeration() const;

  private:
    struct Prepared;
    struct Tools;
    explicit Film(std::shared_ptr<const Prepared> prepared);
    void draw_lit(const MechanismShape& shape, Canvas& canvas);
    void paint(int frame, Style style, Image& out, std::vector<Box>* texts);
    std::shared_ptr<const Prepared> prepared_;
    std::unique_ptr<Tools> tools_;
};

}  // namespace beamcam::render
