// Output "sweep-film": the growing bifurcation diagram of the scene's sweep, and beside it the motion at the value that
// the diagram has reached.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "output/film/video.hpp"
#include "render/film/film.hpp"
#include "render/plot/labels.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/outputs/sweep_shots.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/files.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::kPositive, sim::required, sim::written_if;

namespace {

constexpr double kGrowthRate = 10;      // pictures of the diagram in a second of the film
constexpr double kDiagramShare = 0.56;  // of a wide picture's width; a tall one is halved
constexpr double kMargin = 18;          // around the diagram, at the design size [px]
constexpr double kDesignWidth = 1920, kDesignHeight = 1080, kSmallestUnit = 0.5;
constexpr double kDiagramResolution = 234;  // at the design size: letters of 8 pt are 26 pixels [1/in]
constexpr double kMillimetresPerInch = 25.4;
constexpr double kNarrowestDiagram = 80, kLowestDiagram = 96;  // smallest that fits axes, numbers and legends [mm]
constexpr int kLongSide = 640, kShortSide = 360;               // of the smallest picture with readable text [px]

// The two halves of a picture.
struct Halves {
    render::Box diagram, beam;
    double unit = 1;
};
Halves halves_of(const Size& size) {
    Halves out;
    const auto w = static_cast<double>(size.width), h = static_cast<double>(size.height);
    out.unit = std::max(kSmallestUnit, std::min(w, h) / std::min(kDesignWidth, kDesignHeight));
    if (w > h) {
        const double left = std::floor(kDiagramShare * w / 2) * 2;
        out.diagram = {0, 0, left, h}, out.beam = {left, 0, w - left, h};
    } else {
        const double upper = std::floor(h / 4) * 2;
        out.beam = {0, 0, w, upper}, out.diagram = {0, upper, w, h - upper};
    }
    out.diagram = out.diagram.inset(std::round(kMargin * out.unit));
    return out;
}

void put(const render::Image& part, const render::Box& box, render::Image& whole) {
    const int rows = std::min(part.height, static_cast<int>(box.h)),
              columns = std::min(part.width, static_cast<int>(box.w));
    for (int row = 0; row < rows; ++row)
        std::copy_n(part.pixels.begin() + std::ptrdiff_t(row) * part.width, columns,
                    whole.pixels.begin() + std::ptrdiff_t(row + int(box.y)) * whole.width + std::ptrdiff_t(box.x));
}

// The parts beside the beam. Letters have the size that they have in a film of the whole picture.
render::Shown beside_diagram(const Size& size) {
    const auto unit = [](double width, double height) {
        return render::layout(static_cast<int>(width), static_cast<int>(height), render::LayoutNode{}, {}).unit;
    };
    const render::Box beam = halves_of(size).beam;
    return {.clock = false, .legend = false, .size = unit(size.width, size.height) / unit(beam.w, beam.h)};
}

// Texts beside the beam that do not fit into a film of this size; empty if all fit.
std::string omitted_texts(const Size& size) {
    const render::Box beam = halves_of(size).beam;
    const render::Layout places =
        render::layout(static_cast<int>(beam.w), static_cast<int>(beam.h), render::LayoutNode{}, beside_diagram(size));
    std::vector<std::string> missing;
    if (!places.title) missing.emplace_back("the value and its class");
    if (!places.parameters) missing.emplace_back("the line of parameters");
    if (!places.note) missing.emplace_back("the speed");
    return fmt::format("{}", fmt::join(missing, ", "));
}

class SweepFilm {
  public:
    SweepFilm(const SweepFilmOutput& how, const Scene& scene, const output::SweepData& data)
        : how_(how),
          scene_(scene),
          data_(data),
          grid_(scene),
          order_(sweep_order(grid_)),
          shots_(sweep_shots(how, grid_, order_)),
          digits_(value_digits({&grid_.scene(), &data}, shown_values(), how.lang)),
          halves_(halves_of(how.size)),
          figure_(figure_output()),
          diagram_({&grid_.scene(), &data}, figure_, order_.place) {}

    // Returns the number of frames.
    int write(const output::Target& file, Progress& progress) {
        progress.begin("motions", static_cast<double>(shots_.size()), "values");
        for (std::size_t i = 0; i < shots_.size(); ++i) {
            follow(how_, data_.read(shots_[i].point), shots_[i]);
            progress.reach(static_cast<double>(i + 1));
        }
        setup_.survey = std::make_shared<SweepPoses>(shots_);
        factor_ = smallest_factor();
        output::VideoWriter film(file, options());
        render::Image picture(how_.size.width, how_.size.height);
        std::ranges::fill(picture.pixels, 0xffffffffu);
        progress.begin("frames", frames_of(how_), "frames");
        for (const SweepShot& shot : shots_) {
            draw(shot, picture, film);
            progress.reach(shot.end);
        }
        film.finish();
        progress.end();
        return frames_of(how_);
    }

  private:
    FigureOutput figure_output() const {
        FigureOutput figure;
        figure.figure = "bifurcation";
        figure.value = how_.value;
        figure.lang = how_.lang;
        const double fits = std::min(halves_.diagram.w / kNarrowestDiagram, halves_.diagram.h / kLowestDiagram);
        figure.dpi = std::min(kDiagramResolution * halves_.unit, fits * kMillimetresPerInch);
        figure.width = halves_.diagram.w / *figure.dpi * kMillimetresPerInch * 1e-3;
        return figure;
    }
    output::VideoOptions options() const {
        output::VideoOptions options;
        options.width = how_.size.width, options.height = how_.size.height;
        options.fps = how_.fps;
        options.codec = *output::default_codec(ending_of(how_.file));
        options.crf = how_.crf;
        options.metadata = film_metadata(to_json(grid_.scene()), scene_.title);
        return options;
    }

    std::vector<double> shown_values() const {
        std::vector<double> values;
        for (const SweepShot& shot : shots_) values.push_back(data_.place(shot.point)[0]);
        return values;
    }
    render::FilmSetup setup_of(const SweepShot& shot) const {
        render::FilmSetup setup = setup_;
        setup.problem = shot.problem;
        setup.title = point_text({&grid_.scene(), &data_}, shot.point, digits_, how_.lang);
        setup.width = static_cast<int>(halves_.beam.w), setup.height = static_cast<int>(halves_.beam.h);
        setup.fps = how_.fps.value();
        setup.view.style = how_.style;
        setup.view.lang = how_.lang;
        setup.view.paper = 0xffffff;
        setup.view.exaggeration = factor_ ? factor_ : how_.exaggeration;
        setup.view.show = beside_diagram(how_.size);
        setup.layout = render::LayoutNode{};
        setup.units = scene_.units;
        if (data_.axes[0].name == "cam.speed") setup.speed_decimals = digits_.decimals;
        setup.poses = shot.poses;
        setup.impacts = shot.impacts;
        const double speed = how_.turns * cam_period(shot.problem);  // of time
        setup.speeds.assign(shot.poses.size(), speed);
        setup.accuracy_note = notes(shot, speed);
        return setup;
    }
    std::string notes(const SweepShot& shot, double speed) const {
        std::string text = render::speed_text(speed, true);
        if (factor_ && *factor_ > 1 && shot.problem.beam.model != sim::ModelKind::rigid)
            text += fmt::format("{}{} ×{:g}", text.empty() ? "" : " · ", how_.lang == Lang::en ? "deflection" : "挠度",
                                *factor_);
        return text;
    }
    // All shots have the same factor: the smallest that any shot needs.
    std::optional<double> smallest_factor() const {
        std::optional<double> least;
        for (const SweepShot& shot : shots_) {
            if (shot.problem.beam.model == sim::ModelKind::rigid) continue;
            render::FilmSetup setup = setup_of(shot);
            setup.view.style = render::Style::flat;
            const double factor = render::Film(std::move(setup)).exaggeration();
            least = std::min(least.value_or(factor), factor);
        }
        return least;
    }

    void draw(const SweepShot& shot, render::Image& picture, output::VideoWriter& film) const {
        render::Film beam(setup_of(shot));
        const int hold = std::max(1, static_cast<int>(std::lround(how_.fps.value() / kGrowthRate)));
        for (int frame = shot.first; frame < shot.end; ++frame) {
            stop_if_interrupted();
            if ((frame - shot.first) % hold == 0) {
                render::figure::Figure grown = diagram_.until(shot.grown(frame, hold), data_.place(shot.point)[0]);
                grown.height = halves_.diagram.h / *figure_.dpi * kMillimetresPerInch;
                put(figure_image(grown, figure_), halves_.diagram, picture);
            }
            put(beam.draw(frame - shot.first), halves_.beam, picture);
            film.write(picture);
        }
    }

    const SweepFilmOutput& how_;
    const Scene& scene_;
    const output::SweepData& data_;
    const SweepGrid grid_;
    const SweepOrder order_;
    std::vector<SweepShot> shots_;
    const ValueDigits digits_;  // of the values in titles and labels
    const Halves halves_;
    const FigureOutput figure_;
    const GrowingDiagram diagram_;
    render::FilmSetup setup_;
    std::optional<double> factor_;  // of the deflection; nullopt before it is computed, or without deflection
};

void judge(ObjectReader& r, SweepFilmOutput& film) {
    const Scene& scene = r.context().scene;
    if (r.diagnostics().any()) return;
    if (!scene.sweep || scene.sweep->over.size() != 1)
        return r.reject_object("type", ": the scene has no key \"sweep\" over one key; add it, or remove this output");
    const output::Codec codec = *output::default_codec(ending_of(film.file));
    r.reject_if("size", output::size_problem(codec, film.size.width, film.size.height));
    if (std::max(film.size.width, film.size.height) < kLongSide ||
        std::min(film.size.width, film.size.height) < kShortSide)
        r.reject("size", ": {}x{} is too small for a diagram beside the beam; use at least {}x{}", film.size.width,
                 film.size.height, kLongSide, kShortSide);
    if (const std::string missing = omitted_texts(film.size); !missing.empty())
        r.diagnostics().warning(r.place("size").place,
                                fmt::format("{} is too small to show {}; increase \"size\"", r.object_name(), missing));
    r.reject_if("value", problem_with_value("bifurcation", film.value, scene));
    r.reject_if("fps", output::rate_problem(codec, film.fps.value()));
    if (film.crf && !output::quality_scale(codec)) r.reject("crf", ": this codec has no crf; remove the key");
}

}  // namespace

void SweepFilmOutput::visit(SceneVisitor& v) {
    visit_file(v, file, kSweepFilmEndings, "-sweep.mp4");
    v.value("size", size_format(size), "Width and height in pixels, even.");
    v.value("fps", frame_rate_format(fps), "Frames per second.");
    v.number("duration", duration, dim::kTime, between(1, 3600, "is outside 1 s … 3600 s"),
             "Duration of the film; each value of the key that it shows takes about a second.");
    v.number("turns", turns, dim::kNone, between(0.01, 20, "is outside 0.01 … 20"),
             "Turns of the cam per second of the film.");
    v.choice("style", style, kStyles, "Style of the mechanism, as in films.");
    visit_exaggeration(v, exaggeration, "Factor of the deflection, as in films.");
    v.choice(written_if(lang != Lang::en, "lang"), lang, kLanguages, "Language of the labels.");
    v.text(written_if(!value.empty(), "value"), value,
           "Column of the samples that the diagram shows; by default v_n_before for impacts, else theta.");
    v.integer(written_if(crf.has_value(), "crf"), crf, 0, 63, "Quality, as in films.");
    v.check([this](ObjectReader& r) { judge(r, *this); });
}

void SweepFilmOutput::plan(Planner& planner, std::size_t output) const {
    if (!planner.selection().shard.whole()) return;  // a part of a sweep has no film
    DataFile film{output, file, kType, {}};
    film.content = counted(frames_of(*this), "frame");
    film.write = [how = *this, scene = planner.scene()](const DataSource& from) {
        return counted(SweepFilm(how, scene, *from.sweep).write(*from.file, from.progress), "frame");
    };
    planner.require_sweep(file);
    planner.add(std::move(film));
}

}  // namespace beamcam::scenes
