// Output "figure": a figure for print, made by its recipe.
#include <stdexcept>

#include "render/plot/style.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/forms.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::required;

void FigureOutput::visit(SceneVisitor& v) {
    v.form("file", file_form(file, {".pdf", ".svg", ".png"}),
           "Name of the file; the figure's name with .pdf when left out.");
    v.choice(required("figure", "\"free-fall\""), figure, recipe_names(), "Its name.");
    v.choice("column", column, render::figure::column_names(),
             "The journal's column that it fits: width and size of letters.");
    v.number("dpi", dpi, sim::kPlainNumber, between(50, 2400), "Dots per inch of a .png.");
    v.choice("lang", lang, {{Lang::en, "en"}, {Lang::zh, "zh"}}, "Language of labels and caption.");
    v.number("width", width, dim::kLength,
             between(0.03, 1, "is outside 30 … 1000 mm; a plain number is in metres, \"90 mm\" says its unit"),
             "Another width than the column's.");
    v.check([this](ObjectReader& r) { judge_figure(r, *this); });
}

void FigureOutput::plan(Planner& planner, std::size_t output) const {
    const Recipe* recipe = recipe_named(figure);
    if (!recipe) throw std::logic_error("a figure that the reader does not know: " + figure);
    Studies studies;
    FigureFile planned{output, file, figure, {}, recipe->prepare(planner.scene(), lang, studies), {}};
    planned.studies = studies.take();
    planner.add(std::move(planned));
}

}  // namespace beamcam::scenes
