#include "scenes/format/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "output/files/numbers.hpp"
#include "render/draw/fonts.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

// ---- physics -----------------------------------------------------------------------------------

namespace {

// The position of a key path: its value, or the key of its nearest ancestor in the file. `exact`: it is the value.
SourcePosition place_in_scene(const Node& root, std::string_view path, bool& exact) {
    const Node* node = &root;
    SourcePosition place = root.place;
    const std::vector<std::string> names = split(path);
    exact = true;
    for (std::size_t i = 0; i < names.size() && exact; ++i) {
        const Node* inner = child(*node, names[i]);
        exact = inner != nullptr;
        if (!inner) break;
        const Member* member = node->find(names[i]);
        place = member && i + 1 < names.size() ? member->key_place : inner->place;
        node = inner;
    }
    return place;
}

}  // namespace

void check_physics(ObjectReader& r, const sim::Problem& problem) {
    const bool partial = r.diagnostics().any();
    for (const sim::Issue& finding : sim::validate(problem)) {
        bool exact = false;
        const SourcePosition place = place_in_scene(*r.node(), finding.path, exact);
        // Some values could not be read and are defaults now: check only values that the file contains, and entries of
        // lists that could be read.
        const std::string object = finding.path.substr(0, finding.path.rfind('.'));
        const bool in_list = std::isdigit(static_cast<unsigned char>(object.back()));
        if (partial && (!exact || !finding.fatal || r.diagnostics().failed(in_list ? object : finding.path))) continue;
        const bool named = finding.message.starts_with(finding.path);
        r.diagnostics().add(
            {place, named ? finding.message : fmt::format("{}: {}", finding.path, finding.message), finding.fatal});
    }
}

void check_words(ObjectReader& r, const char* key, const std::string& text) {
    if (const std::string problem = render::markup_problem(text); !problem.empty())
        r.warn(key, ": {}; the picture shows it unchanged", problem);
}

// ---- pictures ----------------------------------------------------------------------------------

const Node* written_value(const Node& scene, const std::string& key) {
    const Member *sweep = scene.find("sweep"), *over = sweep ? sweep->value.find("over") : nullptr;
    for (std::size_t i = 0; over && i < over->value.items.size(); ++i) {
        const Node& item = over->value.items[i];
        const Member *name = item.find("key"), *from = item.find("from"), *values = item.find("values");
        if (!name || name->value.text != key) continue;
        if (from) return &from->value;
        if (values && !values->value.items.empty()) return &values->value.items.front();
    }
    const Node* at = &scene;
    for (const std::string& name : split(key)) at = at ? child(*at, name) : nullptr;
    return at;
}

// The objects "set" of the motions that outputs compare.
static std::vector<const Node*> compared_sets(const Node& scene) {
    std::vector<const Node*> out;
    const Member* outputs = scene.find("outputs");
    for (std::size_t i = 0; outputs && i < outputs->value.items.size(); ++i) {
        const Member* compare = outputs->value.items[i].find("compare");
        for (std::size_t k = 0; compare && k < compare->value.items.size(); ++k)
            if (const Member* set = compare->value.items[k].find("set")) out.push_back(&set->value);
    }
    return out;
}

static bool in_degrees(std::string_view text) {
    return text.find("deg") != std::string_view::npos || text.find("°") != std::string_view::npos;
}

static render::SpeedUnit speed_unit(std::string_view text) {
    return text.ends_with("rpm") ? render::SpeedUnit::rpm
           : in_degrees(text)    ? render::SpeedUnit::degrees
           : text.empty()        ? render::SpeedUnit::automatic
                                 : render::SpeedUnit::radians;
}

// The units of the first of these keys that is a text with a unit, in the scene or else in its comparisons.
void infer_units(ObjectReader& r, render::Units& units) {
    if (!r.node()) return;
    const std::vector<const Node*> sets = compared_sets(*r.node());
    const auto first_stated = [&](std::initializer_list<const char*> keys) -> std::string_view {
        const auto states_unit = [](const Node* at) { return at && at->kind == Node::Kind::string; };
        const Node* stated = nullptr;
        for (const char* key : keys)
            if (const Node* at = written_value(*r.node(), key); !stated && states_unit(at)) stated = at;
        for (const Node* set : sets)
            for (const char* key : keys)
                if (const Member* at = set->find(key); !stated && at && states_unit(&at->value)) stated = &at->value;
        return stated ? std::string_view(stated->text) : std::string_view();
    };
    units.degrees = in_degrees(first_stated({"initial.angle", "cam.phase", "cam.profile.lowest"}));
    units.speed = speed_unit(first_stated({"cam.speed", "hub.drive.speed", "initial.angular_velocity"}));
}

void adopt_unit(std::string_view text, const Dimension& dimension, render::Units& units) {
    if (text.find_last_not_of("0123456789.eE+-") == std::string_view::npos) return;
    if (same(dimension, dimension::kAngle)) units.degrees = in_degrees(text);
    if (same(dimension, dimension::kAngularSpeed)) units.speed = speed_unit(text);
}

void check_picture(ObjectReader& r, Picture& picture) {
    if (const auto paper = picture.view.paper;
        paper && render::contrast(render::palette(picture.view.theme).ink, render::rgb(*paper)) < 3)
        r.warn("background", " makes the text hardly readable; choose another \"theme\"");
    if (!r.has("lang") && render::needs_cjk(r.context().scene.title))
        r.warn("lang", ": the title is not English, but the other words are; set \"zh\" or \"en\"");
    if (picture.comparison == render::Comparison::ghosts && !r.has("compare"))
        r.diagnostics().warning(
            r.node()->place,
            fmt::format("{} = \"ghosts\" has no effect without \"compare\", or several scenes for `beamcam render`",
                        r.path("comparison")));
    check_layout(r, picture);
}

// ---- files -------------------------------------------------------------------------------------

namespace {

// Two outputs must not write one file.
void check_distinct_files(ObjectReader& r, const Node& list, const std::vector<Output>& outputs) {
    FileClaims claims;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (file_of(outputs[i]).empty() || r.diagnostics().failed(fmt::format("outputs.{}", i))) continue;
        for (const std::string& file : written_by(outputs[i])) claims.add(file, i);
    }
    for (const auto& [later, earlier] : claims.clashes()) {
        const Node& object = list.items[later.owner];
        const Member* file = object.find("file");
        r.fail(file ? file->value : object, fmt::format("outputs.{}.file", later.owner),
               fmt::format("outputs.{} and outputs.{} would write the same file {}; give one of them another \"file\"",
                           later.owner, earlier.owner, in_quotes(later.file)));
    }
}

}  // namespace

void check_outputs(ObjectReader& r, Scene& scene) {
    const Member* list = r.node()->find("outputs");
    if (!list || list->value.items.size() != scene.outputs.size()) return;
    const Source& source = r.context().source;
    Locator locator(source.text);
    for (const Node& object : list->value.items) {
        std::string& place = scene.output_places.emplace_back(source.name);
        if (object.place.source != 0) continue;
        const LineColumn at = locator.at(object.place.offset);
        place += fmt::format(":{}:{}", at.line, at.column);
    }
    check_distinct_files(r, list->value, scene.outputs);
}

}  // namespace beamcam::scenes
