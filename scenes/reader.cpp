#include "scenes/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <numeric>
#include <set>

#include "output/video.hpp"
#include "scenes/capabilities.hpp"
#include "scenes/files.hpp"
#include "scenes/overrides.hpp"
#include "scenes/suggest.hpp"
#include "scenes/tree.hpp"
#include "scenes/units.hpp"

namespace beamcam::scenes {
namespace {

namespace dim = dimension;

template <class Enum>
using Names = std::initializer_list<std::pair<const char*, Enum>>;

// A value as the user wrote it.
std::string shown(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return "null";
        case Node::Kind::boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::number:
            return node.text;
        case Node::Kind::string:
            return in_quotes(node.text);
        case Node::Kind::array:
            return fmt::format("an array of {}", node.items.size());
        case Node::Kind::object:
            return "an object";
    }
    return "?";
}

// ---- what went wrong, and where ----------------------------------------------------------------

class Findings {
  public:
    void error(const Place& place, const std::string& path, std::string text) {
        messages_.push_back({place, std::move(text), true});
        failed_.insert(path);
    }
    // Did this key, or one inside it, fail to be read?
    bool failed(const std::string& path) const {
        auto it = failed_.lower_bound(path);
        return it != failed_.end() && (*it == path || it->starts_with(path + "."));
    }
    bool any() const { return !failed_.empty(); }
    std::vector<Message> take() { return std::move(messages_); }

  private:
    std::vector<Message> messages_;
    std::set<std::string> failed_;
};

// ---- one object's keys -------------------------------------------------------------------------

// Reads the keys of one object; each is asked for once, and `finish` tells of those nobody asked for.
class Fields {
  public:
    Fields(Findings& findings, const Node* object, std::string path)
        : findings_(findings), object_(object), path_(std::move(path)) {
        if (object_ && object_->kind != Node::Kind::object) {
            fail(*object_, "", fmt::format("{} must be an object {{ … }}, not {}", what(), shown(*object_)));
            object_ = nullptr;
        }
    }

    std::string path(std::string_view key) const {
        if (key.empty()) return path_;
        return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
    }
    bool has(std::string_view key) const { return object_ && object_->find(key); }

    const Node* take(const char* key) {
        known_.emplace_back(key);
        const Member* member = object_ ? object_->find(key) : nullptr;
        return member ? &member->value : nullptr;
    }
    const Node* require(const char* key, std::string_view example) {
        const Node* node = take(key);
        if (!node && object_)
            findings_.error(object_->place, path(key),
                            fmt::format("{} needs \"{}\", for example {}", what(), key, example));
        return node;
    }

    void fail(const Node& node, std::string_view key, std::string text) {
        findings_.error(node.place, path(key), std::move(text));
    }

    void text(const char* key, std::string& out) {
        if (const Node* node = take(key)) {
            if (node->kind == Node::Kind::string)
                out = node->text;
            else
                fail(*node, key, fmt::format("{} must be a text in quotes, not {}", path(key), shown(*node)));
        }
    }

    void boolean(const char* key, bool& out) {
        if (const Node* node = take(key)) {
            if (node->kind == Node::Kind::boolean)
                out = node->boolean;
            else
                fail(*node, key, fmt::format("{} must be true or false, not {}", path(key), shown(*node)));
        }
    }

    // A number in SI, or a text with a unit. True when `out` was set.
    template <class Number>
    bool quantity(const char* key, const Dimension& dimension, Number& out) {
        const Node* node = take(key);
        return node && value(*node, key, dimension, out);
    }

    template <class Number>
    bool value(const Node& node, std::string_view key, const Dimension& dimension, Number& out) {
        if (node.kind == Node::Kind::number) {
            out = node.number;
            return true;
        }
        const std::string unit = si_unit(dimension);
        if (node.kind != Node::Kind::string) {
            fail(node, key,
                 fmt::format("{} must be a number{}, not {}", path(key),
                             unit == "1" ? "" : fmt::format(" [{}] or a text with a unit", unit), shown(node)));
            return false;
        }
        const QuantityText read = parse_quantity(node.text);
        if (!read.quantity) {
            fail(node, key,
                 fmt::format("{} is no value for {}: {}{}", in_quotes(node.text), path(key), read.problem,
                             unit == "1" ? "; write a number" : fmt::format("; a value looks like \"1.5 {}\"", unit)));
            return false;
        }
        if (!same(read.quantity->dimension, dimension)) {
            fail(node, key, wrong_dimension(node, key, unit, read.quantity->dimension));
            return false;
        }
        out = read.quantity->value;
        return true;
    }

    // A whole number in lowest…highest.
    bool whole(const char* key, int lowest, int highest, int& out) {
        const Node* node = take(key);
        return node && whole_value(*node, key, lowest, highest, out);
    }
    bool whole_value(const Node& node, std::string_view key, int lowest, int highest, int& out) {
        if (node.kind != Node::Kind::number || node.number != std::round(node.number)) {
            fail(node, key, fmt::format("{} must be a whole number, not {}", path(key), shown(node)));
            return false;
        }
        if (node.number < lowest || node.number > highest) {
            fail(node, key, fmt::format("{} = {} is outside {} … {}", path(key), node.text, lowest, highest));
            return false;
        }
        out = static_cast<int>(node.number);
        return true;
    }

    template <class Enum>
    bool choice(const char* key, const Names<Enum>& names, Enum& out) {
        const Node* node = take(key);
        return node && choice_value(*node, key, names, out);
    }
    template <class Enum>
    bool choice_value(const Node& node, std::string_view key, const Names<Enum>& names, Enum& out) {
        std::vector<std::string> known;
        for (const auto& [name, value] : names) {
            if (node.kind == Node::Kind::string && node.text == name) {
                out = value;
                return true;
            }
            known.emplace_back(name);
        }
        if (node.kind == Node::Kind::string)
            fail(node, key,
                 fmt::format("{} = {} is not known{}", path(key), in_quotes(node.text),
                             suggestion_or_list(node.text, known)));
        else
            fail(node, key,
                 fmt::format("{} must be one of {}, not {}", path(key), fmt::join(known, ", "), shown(node)));
        return false;
    }

    // An array of quantities.
    bool list(const char* key, const Dimension& dimension, std::vector<double>& out) {
        const Node* node = take(key);
        return node && list_value(*node, key, dimension, out);
    }
    bool list_value(const Node& node, std::string_view key, const Dimension& dimension, std::vector<double>& out) {
        if (node.kind != Node::Kind::array) {
            fail(node, key, fmt::format("{} must be an array [ … ], not {}", path(key), shown(node)));
            return false;
        }
        std::vector<double> values(node.items.size());
        bool fine = true;
        for (std::size_t i = 0; i < values.size(); ++i)
            fine = value(node.items[i], fmt::format("{}.{}", key, i), dimension, values[i]) && fine;
        if (fine) out = std::move(values);
        return fine;
    }

    // Tells of every key that was not asked for.
    void finish(std::string_view planned_as = {}) {
        if (!object_) return;
        for (const Member& member : object_->members) {
            if (member.key.starts_with("x-") || std::find(known_.begin(), known_.end(), member.key) != known_.end())
                continue;
            const auto planned = not_available(planned_as, member.key);
            findings_.error(member.key_place, path(member.key),
                            planned ? fmt::format("{}: {}", what(), *planned)
                                    : fmt::format("unknown key {} in {}{}", in_quotes(member.key), what(),
                                                  suggestion_or_list(member.key, known_)));
        }
    }
    const Node* node() const { return object_; }
    std::string what() const { return path_.empty() ? "the scene" : path_; }

  private:
    std::string wrong_dimension(const Node& node, std::string_view key, const std::string& unit,
                                const Dimension& got) const {
        if (same(got, dim::kNone)) {
            return unit == "1"
                       ? fmt::format("{} = {} must be a plain number", path(key), in_quotes(node.text))
                       : fmt::format("{} = {} has no unit; write it without quotes if it is in {}, or with its unit",
                                     path(key), in_quotes(node.text), unit);
        }
        if (unit == "1")
            return fmt::format("{} = {} has a unit, but it is a plain number", path(key), in_quotes(node.text));
        const bool cycles = unit == "rad/s" && same(got, dim::kFrequency);
        return fmt::format("{} = {} has the wrong dimension ({}); it is measured in {}{}", path(key),
                           in_quotes(node.text), si_unit(got), unit, cycles ? ": write rpm, rad/s or deg/s" : "");
    }

    Findings& findings_;
    const Node* object_;
    std::string path_;
    std::vector<std::string> known_;
};

// ---- physics -----------------------------------------------------------------------------------

void read_torque(Fields& f, sim::Drive& drive) {
    if (f.has("t") || f.has("torque")) {
        sim::TorqueTable table;
        const Node* t = f.require("t", "[0, 1]");
        const Node* torque = f.require("torque", "[0, 0.5]");
        const bool fine =
            t && torque &&
            f.list_value(*t, "t", dim::kTime, table.t) & f.list_value(*torque, "torque", dim::kTorque, table.torque);
        if (fine && table.t.size() != table.torque.size())
            f.fail(*torque, "torque",
                   fmt::format("{} has {} values and {} has {}; a table needs as many of one as of the other",
                               f.path("torque"), table.torque.size(), f.path("t"), table.t.size()));
        if (fine) drive = std::move(table);
    } else if (f.has("amplitude") || f.has("frequency") || f.has("phase")) {
        sim::HarmonicTorque harmonic;
        if (const Node* node = f.require("amplitude", "0.5"))
            f.value(*node, "amplitude", dim::kTorque, harmonic.amplitude);
        if (const Node* node = f.require("frequency", "\"2 Hz\""))
            f.value(*node, "frequency", dim::kFrequency, harmonic.frequency);
        f.quantity("phase", dim::kAngle, harmonic.phase);
        drive = harmonic;
    } else {
        sim::ConstantTorque constant;
        if (const Node* node = f.require("value", "\"0.5 N m\"")) f.value(*node, "value", dim::kTorque, constant.value);
        drive = constant;
    }
}

void read_prescribed(Fields& f, sim::Drive& drive) {
    enum class Law { constant, spin_up, table };
    Law law = Law::constant;
    const Node* name = f.require("law", "\"constant\"");
    if (!name ||
        !f.choice_value<Law>(*name, "law",
                             {{"constant", Law::constant}, {"spin-up", Law::spin_up}, {"table", Law::table}}, law)) {
        for (const char* key : {"speed", "duration", "t", "theta"}) f.take(key);
        return;
    }
    switch (law) {
        case Law::constant: {
            sim::ConstantSpeed constant;
            if (const Node* node = f.require("speed", "\"30 rpm\""))
                f.value(*node, "speed", dim::kAngularSpeed, constant.speed);
            drive = constant;
            break;
        }
        case Law::spin_up: {
            sim::SpinUp spin_up;
            if (const Node* node = f.require("speed", "4")) f.value(*node, "speed", dim::kAngularSpeed, spin_up.speed);
            if (const Node* node = f.require("duration", "15"))
                f.value(*node, "duration", dim::kTime, spin_up.duration);
            drive = spin_up;
            break;
        }
        case Law::table: {
            sim::AngleTable table;
            const Node* t = f.require("t", "[0, 1, 2]");
            const Node* theta = f.require("theta", "[0, 0.5, 0]");
            const bool fine =
                t && theta &&
                f.list_value(*t, "t", dim::kTime, table.t) & f.list_value(*theta, "theta", dim::kAngle, table.theta);
            if (fine && table.t.size() != table.theta.size())
                f.fail(*theta, "theta",
                       fmt::format("{} has {} values and {} has {}; a table needs as many of one as of the other",
                                   f.path("theta"), table.theta.size(), f.path("t"), table.t.size()));
            if (fine) drive = std::move(table);
            break;
        }
    }
}

void read_drive(Findings& findings, const Node* node, const std::string& path, sim::Drive& drive) {
    enum class Type { free, torque, prescribed };
    if (!node) return;
    Fields f(findings, node, path);
    Type type = Type::free;
    if (!f.node()) return;
    const Node* name = f.require("type", "\"free\"");
    if (!name ||
        !f.choice_value<Type>(*name, "type",
                              {{"free", Type::free}, {"torque", Type::torque}, {"prescribed", Type::prescribed}}, type))
        return;  // the other keys depend on it
    switch (type) {
        case Type::free:
            drive = sim::FreeDrive{};
            break;
        case Type::torque:
            read_torque(f, drive);
            break;
        case Type::prescribed:
            read_prescribed(f, drive);
            break;
    }
    f.finish();
}

void read_hub(Findings& findings, const Node* node, sim::Hub& hub) {
    if (!node) return;
    Fields f(findings, node, "hub");
    f.quantity("radius", dim::kLength, hub.radius);
    f.quantity("inertia", dim::kInertia, hub.inertia);
    read_drive(findings, f.take("drive"), "hub.drive", hub.drive);
    f.finish();
}

void read_damping_ratio(Fields& f, std::vector<double>& ratios) {
    const Node* node = f.take("damping_ratio");
    if (!node) return;
    if (node->kind == Node::Kind::array) {
        f.list_value(*node, "damping_ratio", dim::kNone, ratios);
        return;
    }
    double ratio = 0;
    if (f.value(*node, "damping_ratio", dim::kNone, ratio)) ratios = {ratio};
}

void read_beam(Findings& findings, const Node* node, sim::Beam& beam) {
    if (!node) return;
    Fields f(findings, node, "beam");
    f.quantity("length", dim::kLength, beam.length);
    f.quantity("area", dim::kArea, beam.area);
    f.quantity("second_moment", dim::kSecondMoment, beam.second_moment);
    f.quantity("density", dim::kDensity, beam.density);
    f.quantity("youngs_modulus", dim::kPressure, beam.youngs_modulus);
    f.quantity("poisson_ratio", dim::kNone, beam.poisson_ratio);
    f.quantity("depth", dim::kLength, beam.depth);
    using sim::ModelKind;
    f.choice<ModelKind>("model",
                        {{name(ModelKind::rigid), ModelKind::rigid},
                         {name(ModelKind::zeroth_order), ModelKind::zeroth_order},
                         {name(ModelKind::first_order), ModelKind::first_order},
                         {name(ModelKind::paper), ModelKind::paper},
                         {name(ModelKind::second_order), ModelKind::second_order},
                         {name(ModelKind::exact), ModelKind::exact}},
                        beam.model);
    using sim::Basis;
    f.choice<Basis>("basis",
                    {{name(Basis::automatic), Basis::automatic},
                     {name(Basis::cantilever), Basis::cantilever},
                     {name(Basis::hub_beam), Basis::hub_beam}},
                    beam.basis);
    f.whole("modes", 1, 40, beam.modes);
    read_damping_ratio(f, beam.damping_ratio);
    f.quantity("kelvin_voigt", dim::kTime, beam.kelvin_voigt);
    f.finish();
}

void read_cam(Findings& findings, const Node* node, std::optional<sim::Cam>& out) {
    if (!node) return;
    if (node->kind == Node::Kind::null) {
        out.reset();
        return;
    }
    if (node->kind != Node::Kind::object) {
        findings.error(node->place, "cam",
                       fmt::format("cam must be an object {{ … }}, or null for no cam, not {}", shown(*node)));
        return;
    }
    Fields f(findings, node, "cam");
    sim::Cam cam;
    if (const Node* centre = f.take("centre")) {
        std::vector<double> xy;
        if (f.list_value(*centre, "centre", dim::kLength, xy)) {
            if (xy.size() == 2)
                cam.centre = {xy[0], xy[1]};
            else
                f.fail(*centre, "centre", fmt::format("cam.centre must be two lengths [x, y], not {}", xy.size()));
        }
    }
    f.quantity("radius", dim::kLength, cam.radius);
    f.quantity("eccentricity", dim::kLength, cam.eccentricity);
    f.quantity("phase", dim::kAngle, cam.phase);
    f.quantity("speed", dim::kAngularSpeed, cam.speed);
    f.quantity("youngs_modulus", dim::kPressure, cam.youngs_modulus);
    f.quantity("poisson_ratio", dim::kNone, cam.poisson_ratio);
    f.finish();
    out = cam;
}

void read_friction(Findings& findings, const Node* node, sim::Friction& friction) {
    if (!node) return;
    enum class Type { none, coulomb, stick_slip };
    Fields f(findings, node, "contact.friction");
    if (!f.node()) return;
    Type type = Type::none;
    const Node* name = f.require("type", "\"none\"");
    if (!name ||
        !f.choice_value<Type>(
            *name, "type", {{"none", Type::none}, {"coulomb", Type::coulomb}, {"stick-slip", Type::stick_slip}}, type))
        return;
    switch (type) {
        case Type::none:
            friction = sim::NoFriction{};
            break;
        case Type::coulomb: {
            sim::CoulombFriction coulomb;
            f.quantity("coefficient", dim::kNone, coulomb.coefficient);
            f.quantity("slip_speed", dim::kSpeed, coulomb.slip_speed);
            friction = coulomb;
            break;
        }
        case Type::stick_slip: {
            sim::StickSlipFriction bristle;
            f.quantity("coefficient", dim::kNone, bristle.coefficient);
            f.quantity("static_coefficient", dim::kNone, bristle.static_coefficient);
            f.quantity("stiffness", dim::kSpringStiffness, bristle.stiffness);
            f.quantity("damping", dim::kSpringDamping, bristle.damping);
            friction = bristle;
            break;
        }
    }
    f.finish();
}

void read_approach_floor(Findings& findings, const Node* node, sim::ApproachFloor& floor) {
    if (!node) return;
    Fields f(findings, node, "contact.approach_floor");
    using Policy = sim::ApproachFloorPolicy;
    f.choice<Policy>("policy", {{"value", Policy::value}, {"first-touch", Policy::first_touch}}, floor.policy);
    f.quantity("value", dim::kSpeed, floor.value);
    f.finish();
}

void read_contact(Findings& findings, const Node* node, sim::Contact& contact) {
    if (!node) return;
    Fields f(findings, node, "contact");
    using sim::ContactModel;
    f.choice<ContactModel>("model",
                           {{name(ContactModel::compliant), ContactModel::compliant},
                            {name(ContactModel::restitution), ContactModel::restitution}},
                           contact.model);
    f.quantity("exponent", dim::kNone, contact.exponent);
    if (const Node* stiffness = f.take("stiffness")) {
        if (stiffness->kind == Node::Kind::string && stiffness->text == "hertz")
            contact.stiffness.reset();
        else
            f.value(*stiffness, "stiffness", dim::contact_stiffness(contact.exponent), contact.stiffness);
    }
    using sim::DampingLaw;
    f.choice<DampingLaw>("damping",
                         {{name(DampingLaw::none), DampingLaw::none},
                          {name(DampingLaw::hunt_crossley), DampingLaw::hunt_crossley},
                          {name(DampingLaw::lankarani_nikravesh), DampingLaw::lankarani_nikravesh},
                          {name(DampingLaw::herbert_mcwhannell), DampingLaw::herbert_mcwhannell},
                          {name(DampingLaw::lee_wang), DampingLaw::lee_wang},
                          {name(DampingLaw::gonthier), DampingLaw::gonthier},
                          {name(DampingLaw::flores), DampingLaw::flores},
                          {name(DampingLaw::hu_guo), DampingLaw::hu_guo},
                          {name(DampingLaw::zhang_sharf), DampingLaw::zhang_sharf}},
                         contact.damping);
    f.quantity("restitution", dim::kNone, contact.restitution);
    using sim::ImpactLaw;
    f.choice<ImpactLaw>("law",
                        {{name(ImpactLaw::newton), ImpactLaw::newton},
                         {name(ImpactLaw::poisson), ImpactLaw::poisson},
                         {name(ImpactLaw::stronge), ImpactLaw::stronge}},
                        contact.law);
    read_friction(findings, f.take("friction"), contact.friction);
    if (const Node* offset = f.take("offset")) {
        if (offset->kind == Node::Kind::string && offset->text == "half-depth")
            contact.offset.reset();
        else
            f.value(*offset, "offset", dim::kLength, contact.offset);
    }
    read_approach_floor(findings, f.take("approach_floor"), contact.approach_floor);
    f.quantity("collision_gap", dim::kTime, contact.collision_gap);
    f.finish();
}

void read_initial(Findings& findings, const Node* node, sim::Initial& initial) {
    if (!node) return;
    Fields f(findings, node, "initial");
    f.quantity("angle", dim::kAngle, initial.angle);
    f.quantity("angular_velocity", dim::kAngularSpeed, initial.angular_velocity);
    using sim::InitialShape;
    f.choice<InitialShape>("shape",
                           {{name(InitialShape::straight), InitialShape::straight},
                            {name(InitialShape::static_equilibrium), InitialShape::static_equilibrium},
                            {name(InitialShape::resting), InitialShape::resting}},
                           initial.shape);
    f.finish();
}

void read_solver(Findings& findings, const Node* node, sim::Solver& solver) {
    if (!node) return;
    Fields f(findings, node, "solver");
    using sim::Method;
    f.choice<Method>("method",
                     {{name(Method::automatic), Method::automatic},
                      {name(Method::rk8), Method::rk8},
                      {name(Method::cvode_adams), Method::cvode_adams},
                      {name(Method::cvode_bdf), Method::cvode_bdf},
                      {name(Method::arkode_erk), Method::arkode_erk}},
                     solver.method);
    f.quantity("rtol", dim::kNone, solver.rtol);
    f.quantity("atol", dim::kNone, solver.atol);
    f.finish();
}

void read_time(Findings& findings, const Node* node, double& end_time) {
    if (!node) return;
    Fields f(findings, node, "time");
    if (const Node* end = f.take("end"))
        if (f.value(*end, "end", dim::kTime, end_time) && !(end_time > 0))
            f.fail(*end, "end",
                   fmt::format("time.end = {} s must be positive; write how many seconds to simulate", end_time));
    f.finish();
}

// ---- outputs -----------------------------------------------------------------------------------

// Reasons: below 16 px nothing can be drawn, above 16384 px OpenGL's largest viewport ends.
constexpr int kSmallestSide = 16, kLargestSide = 16384;
constexpr double kSlowestFrameRate = 0.1, kFastestFrameRate = 1000;  // [Hz]: players give up long before
constexpr double kMostFrames = 250'000;                              // over an hour at 60 fps; poses are held in memory
constexpr double kMostRows = 20'000'000;                             // 160 MB a channel

// Everything that the outputs' readers share.
struct OutputContext {
    Findings& findings;
    const Scene& scene;  // name, physics and end time are read before
    std::size_t index;
};

void read_file(Fields& f, std::string& file, std::initializer_list<std::string_view> endings, bool numbered) {
    const Node* node = f.take("file");
    if (!node) return;
    if (node->kind != Node::Kind::string)
        return f.fail(*node, "file",
                      fmt::format("{} must be a file name in quotes, not {}", f.path("file"), shown(*node)));
    if (std::string problem = problem_with_file(node->text); !problem.empty())
        return f.fail(*node, "file", fmt::format("{} = {}: {}", f.path("file"), in_quotes(node->text), problem));
    const std::string ending = std::filesystem::path(node->text).extension().string();
    if (std::find(endings.begin(), endings.end(), ending) == endings.end()) {
        const auto planned = not_available("file", ending);
        return f.fail(
            *node, "file",
            fmt::format("{} = {}: {}", f.path("file"), in_quotes(node->text),
                        planned ? *planned : fmt::format("its name must end in {}", fmt::join(endings, " or "))));
    }
    const std::string problem = numbered ? problem_with_numbering(node->text) : std::string();
    if (!problem.empty())
        return f.fail(*node, "file", fmt::format("{} = {}: {}", f.path("file"), in_quotes(node->text), problem));
    if (!numbered && node->text.find('#') != std::string::npos)
        return f.fail(*node, "file",
                      fmt::format("{} = {}: '#' numbers the files of \"frames\"; choose another name", f.path("file"),
                                  in_quotes(node->text)));
    file = node->text;
}

void read_size(Fields& f, Size& size, bool must_be_even) {
    const Node* node = f.take("size");
    if (!node) return;
    if (node->kind != Node::Kind::array || node->items.size() != 2)
        return f.fail(*node, "size",
                      fmt::format("{} must be [width, height] in pixels, not {}", f.path("size"), shown(*node)));
    Size read;
    const bool fine = f.whole_value(node->items[0], "size.0", kSmallestSide, kLargestSide, read.width) &
                      f.whole_value(node->items[1], "size.1", kSmallestSide, kLargestSide, read.height);
    if (!fine) return;
    if (must_be_even && (read.width % 2 || read.height % 2))
        return f.fail(*node, "size",
                      fmt::format("{} = {} × {}: H.264 films (yuv420p) need even sides; write [{}, {}]", f.path("size"),
                                  read.width, read.height, read.width + read.width % 2, read.height + read.height % 2));
    size = read;
}

void read_view(Findings& findings, Fields& f, render::View& view) {
    using render::Style, render::Theme;
    f.choice<Theme>("theme", {{"light", Theme::light}, {"dark", Theme::dark}, {"print", Theme::print}}, view.theme);
    const Node* node = f.take("view");
    if (!node) return;
    Fields v(findings, node, f.path("view"));
    v.choice<Style>("style", {{"lit", Style::lit}, {"flat", Style::flat}}, view.style);
    if (const Node* factor = v.take("exaggeration")) {
        double value = 0;
        if (factor->kind == Node::Kind::string && factor->text == "auto") {
            view.exaggeration.reset();
        } else if (factor->kind != Node::Kind::number) {
            v.fail(*factor, "exaggeration",
                   fmt::format("{} must be \"auto\" or a number, not {}", v.path("exaggeration"), shown(*factor)));
        } else if (v.value(*factor, "exaggeration", dim::kNone, value)) {
            if (value < 1 || value > 1e6)
                v.fail(*factor, "exaggeration",
                       fmt::format("{} = {} is outside 1 (true shape) … 1e6", v.path("exaggeration"), factor->text));
            else
                view.exaggeration = value;
        }
    }
    v.finish();
}

void read_frame_rate(Fields& f, FrameRate& rate) {
    const Node* node = f.take("fps");
    if (!node) return;
    const bool readable = node->kind == Node::Kind::number || node->kind == Node::Kind::string;
    const auto read = readable ? parse_frame_rate(node->text) : std::nullopt;
    if (read)
        rate = *read;
    else
        f.fail(
            *node, "fps",
            fmt::format("{} = {} is no frame rate; write {} … {} frames a second, or a fraction such as \"30000/1001\"",
                        f.path("fps"), shown(*node), kSlowestFrameRate, kFastestFrameRate));
}

// A time >= 0.
bool read_instant(Fields& f, const Node& node, std::string_view key, double& out) {
    double t = 0;
    if (!f.value(node, key, dim::kTime, t)) return false;
    if (t < 0) {
        f.fail(node, key, fmt::format("{} = {} is before the start; times begin at 0", f.path(key), shown(node)));
        return false;
    }
    out = t;
    return true;
}

void read_span(const OutputContext& context, Fields& f, FrameSpan& span) {
    read_frame_rate(f, span.fps);
    bool fine = true;
    if (const Node* from = f.take("from")) fine = read_instant(f, *from, "from", span.from) && fine;
    if (const Node* to = f.take("to")) {
        double t = 0;
        fine = read_instant(f, *to, "to", t) && fine;
        if (fine) span.to = t;
    }
    if (!fine || !f.node() || context.findings.failed("time")) return;
    if (std::string problem = problem_with_span(span, context.scene.end_time); !problem.empty())
        context.findings.error(f.node()->place, f.path("to"), fmt::format("{}: {}", f.what(), problem));
}

void read_encoding(Fields& f, Encoding& encoding) {
    if (const Node* codec = f.take("codec")) {
        const auto planned =
            codec->kind == Node::Kind::string ? not_available("outputs.codec", codec->text) : std::nullopt;
        bool is_h264 = true;
        if (planned)
            f.fail(*codec, "codec", fmt::format("{}: {}", f.path("codec"), *planned));
        else
            f.choice_value<bool>(*codec, "codec", {{"h264", true}}, is_h264);
    }
    f.whole("crf", 0, 51, encoding.crf);
    std::string preset = encoding.preset;
    using Text = const char*;
    Text chosen = nullptr;
    if (f.choice<Text>("preset",
                       {{"ultrafast", "ultrafast"},
                        {"superfast", "superfast"},
                        {"veryfast", "veryfast"},
                        {"faster", "faster"},
                        {"fast", "fast"},
                        {"medium", "medium"},
                        {"slow", "slow"},
                        {"slower", "slower"},
                        {"veryslow", "veryslow"}},
                       chosen))
        encoding.preset = chosen;
}

VideoOutput read_video(const OutputContext& context, Fields& f) {
    VideoOutput video = default_film(context.scene);
    read_file(f, video.file, {".mp4"}, false);
    read_size(f, video.size, true);
    read_view(context.findings, f, video.view);
    read_span(context, f, video.span);
    read_encoding(f, video.encoding);
    return video;
}

FramesOutput read_frames(const OutputContext& context, Fields& f) {
    FramesOutput frames;
    frames.file = context.scene.name + "-####.png";
    read_file(f, frames.file, {".png"}, true);
    read_size(f, frames.size, false);
    read_view(context.findings, f, frames.view);
    read_span(context, f, frames.span);
    return frames;
}

StillOutput read_still(const OutputContext& context, Fields& f) {
    StillOutput still;
    still.file = context.scene.name + ".png";
    read_file(f, still.file, {".png"}, false);
    read_size(f, still.size, false);
    read_view(context.findings, f, still.view);
    if (const Node* at = f.require("at", "\"370 ms\"")) read_instant(f, *at, "at", still.at);
    return still;
}

void read_channels(const OutputContext& context, Fields& f, std::vector<sim::Channel>& out) {
    const Node* node = f.take("channels");
    if (!node) return;
    if (node->kind != Node::Kind::array || node->items.empty())
        return f.fail(*node, "channels",
                      fmt::format("{} must be an array of names such as [\"theta\", \"contact_force\"], not {}",
                                  f.path("channels"), shown(*node)));
    std::vector<std::string> known;
    const std::vector<sim::Channel> every = all_channels(context.scene.problem);
    for (const sim::Channel& channel : every) known.push_back(name(channel));
    for (std::size_t i = 0; i < node->items.size(); ++i) {
        const Node& item = node->items[i];
        const std::string key = fmt::format("channels.{}", i);
        if (item.kind != Node::Kind::string) {
            f.fail(item, key, fmt::format("{} must be a channel's name in quotes, not {}", f.path(key), shown(item)));
            continue;
        }
        const auto found = std::find(known.begin(), known.end(), item.text);
        if (found == known.end()) {
            const auto channel = sim::channel_named(item.text);
            f.fail(item, key,
                   channel ? fmt::format("{} = {}: the beam has no such coordinate", f.path(key), in_quotes(item.text))
                           : fmt::format("{} = {} is not a channel{}", f.path(key), in_quotes(item.text),
                                         suggestion_or_list(item.text, known)));
            continue;
        }
        const sim::Channel channel = every[static_cast<std::size_t>(found - known.begin())];
        if (std::find(out.begin(), out.end(), channel) != out.end())
            f.fail(
                item, key,
                fmt::format("{} = {} stands twice; a table has each column once", f.path(key), in_quotes(item.text)));
        else
            out.push_back(channel);
    }
}

TrajectoryOutput read_trajectory(const OutputContext& context, Fields& f) {
    TrajectoryOutput table;
    table.file = context.scene.name + ".csv";
    read_file(f, table.file, {".csv", ".npz"}, false);
    read_channels(context, f, table.channels);
    const Node* rate = f.take("rate");
    const Node* times = f.take("times");
    if (rate && times)
        f.fail(*times, "times", fmt::format("{} has both \"rate\" and \"times\"; keep one of them", f.what()));
    if (rate && f.value(*rate, "rate", dim::kFrequency, table.rate)) {
        if (!(table.rate > 0))
            f.fail(*rate, "rate", fmt::format("{} = {} must be positive", f.path("rate"), shown(*rate)));
        else if (table.rate * context.scene.end_time > kMostRows)
            f.fail(*rate, "rate",
                   fmt::format("{} = {} would make {:.3g} rows, more than {:.3g}; lower it", f.path("rate"),
                               shown(*rate), table.rate * context.scene.end_time, kMostRows));
    }
    if (times && f.list_value(*times, "times", dim::kTime, table.times)) {
        if (table.times.empty())
            f.fail(*times, "times", fmt::format("{} is empty; name at least one instant", f.path("times")));
        for (std::size_t i = 0; i < table.times.size(); ++i) {
            double ignored = 0;
            read_instant(f, times->items[i], fmt::format("times.{}", i), ignored);
        }
    }
    return table;
}

ImpactsOutput read_impacts(const OutputContext& context, Fields& f) {
    ImpactsOutput impacts;
    impacts.file = context.scene.name + "-impacts.json";
    read_file(f, impacts.file, {".json", ".csv"}, false);
    return impacts;
}

SummaryOutput read_summary(const OutputContext& context, Fields& f) {
    SummaryOutput summary;
    summary.file = context.scene.name + "-summary.json";
    read_file(f, summary.file, {".json"}, false);
    f.boolean("horizon", summary.horizon);
    return summary;
}

std::optional<Output> read_output(const OutputContext& context, const Node& node) {
    Fields f(context.findings, &node, fmt::format("outputs.{}", context.index));
    if (!f.node()) return std::nullopt;
    const Node* type = f.require("type", "\"video\"");
    if (!type) return std::nullopt;
    if (type->kind == Node::Kind::string)
        if (const auto planned = not_available("outputs.type", type->text)) {
            f.fail(*type, "type", fmt::format("{}: {}", f.path("type"), *planned));
            return std::nullopt;
        }
    using Read = Output (*)(const OutputContext&, Fields&);
    Read read = nullptr;
    if (!f.choice_value<Read>(
            *type, "type",
            {{"video", [](const OutputContext& c, Fields& g) -> Output { return read_video(c, g); }},
             {"frames", [](const OutputContext& c, Fields& g) -> Output { return read_frames(c, g); }},
             {"still", [](const OutputContext& c, Fields& g) -> Output { return read_still(c, g); }},
             {"trajectory", [](const OutputContext& c, Fields& g) -> Output { return read_trajectory(c, g); }},
             {"impacts", [](const OutputContext& c, Fields& g) -> Output { return read_impacts(c, g); }},
             {"summary", [](const OutputContext& c, Fields& g) -> Output { return read_summary(c, g); }}},
            read))
        return std::nullopt;
    Output output = read(context, f);
    f.finish("outputs");
    return output;
}

// Two outputs must not write one file.
void refuse_shared_files(Findings& findings, const std::vector<std::pair<const Node*, Output>>& outputs) {
    for (std::size_t later = 1; later < outputs.size(); ++later)
        for (std::size_t earlier = 0; earlier < later; ++earlier) {
            const std::string &a = file_of(outputs[earlier].second), &b = file_of(outputs[later].second);
            if (!may_collide(a, b)) continue;
            const Node& object = *outputs[later].first;
            const Member* file = object.find("file");
            findings.error(
                file ? file->value.place : object.place, fmt::format("outputs.{}.file", later),
                fmt::format("outputs.{} writes {}, which outputs.{} writes too ({}); give it a \"file\" of its own",
                            later, in_quotes(b), earlier, in_quotes(a)));
            break;
        }
}

void read_outputs(Findings& findings, const Node* node, Scene& scene) {
    if (!node) return;
    if (node->kind != Node::Kind::array)
        return findings.error(node->place, "outputs",
                              fmt::format("outputs must be an array [ … ], not {}", shown(*node)));
    std::vector<std::pair<const Node*, Output>> outputs;
    for (std::size_t i = 0; i < node->items.size(); ++i)
        if (auto output = read_output({findings, scene, i}, node->items[i]))
            outputs.emplace_back(&node->items[i], std::move(*output));
    if (outputs.size() == node->items.size()) refuse_shared_files(findings, outputs);
    for (auto& [place, output] : outputs) scene.outputs.push_back(std::move(output));
}

// ---- the whole ---------------------------------------------------------------------------------

// Where a key path stands: its value, or else the key of its nearest ancestor in the file.
Place place_of(const Node& root, std::string_view path, bool& exact) {
    const Node* node = &root;
    Place place = root.place;
    exact = true;
    while (!path.empty()) {
        const std::size_t dot = std::min(path.find('.'), path.size());
        const std::string_view key = path.substr(0, dot);
        path.remove_prefix(std::min(dot + 1, path.size()));
        if (const Member* member = node->find(key)) {
            place = path.empty() ? member->value.place : member->key_place;
            node = &member->value;
            continue;
        }
        std::size_t index = 0;
        const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
        if (node->kind != Node::Kind::array || error != std::errc{} || end != key.data() + key.size() ||
            index >= node->items.size()) {
            exact = false;
            break;
        }
        node = &node->items[index];
        place = node->place;
    }
    return place;
}

// The mechanics' own judgement, at the places of the scene.
void judge_physics(const Node& root, const Scene& scene, Findings& findings, std::vector<Message>& messages) {
    const bool partial = findings.any();
    for (const sim::Finding& finding : sim::validate(scene.problem)) {
        bool exact = false;
        const Place place = place_of(root, finding.path, exact);
        // With unread values replaced by defaults, only what the user wrote himself can be judged.
        if (partial && (!exact || !finding.fatal || findings.failed(finding.path))) continue;
        const bool named = finding.message.starts_with(finding.path);
        messages.push_back(
            {place, named ? finding.message : fmt::format("{}: {}", finding.path, finding.message), finding.fatal});
    }
}

Scene read_tree(const Node& root, const std::string& scene_name, std::vector<Message>& messages) {
    Scene scene;
    scene.name = scene_name;
    scene.title.clear();
    Findings findings;
    Fields f(findings, &root, "");
    std::string schema;
    f.text("$schema", schema);
    f.text("title", scene.title);
    read_hub(findings, f.take("hub"), scene.problem.hub);
    read_beam(findings, f.take("beam"), scene.problem.beam);
    read_cam(findings, f.take("cam"), scene.problem.cam);
    read_contact(findings, f.take("contact"), scene.problem.contact);
    f.quantity("gravity", dim::kAcceleration, scene.problem.gravity);
    read_initial(findings, f.take("initial"), scene.problem.initial);
    read_solver(findings, f.take("solver"), scene.problem.solver);
    read_time(findings, f.take("time"), scene.end_time);
    judge_physics(root, scene, findings, messages);
    read_outputs(findings, f.take("outputs"), scene);
    f.finish();
    for (Message& message : findings.take()) messages.push_back(std::move(message));
    return scene;
}

std::string stem(const std::string& path) {
    std::string name = std::filesystem::path(path).stem().string();
    return name.empty() || path == "-" ? "scene" : name;
}

struct CloseFile {
    void operator()(std::FILE* file) const {
        if (file != stdin) std::fclose(file);
    }
};

}  // namespace

Reading read_scene(Source file, const std::vector<std::string>& overrides) {
    Reading reading;
    const std::string name = stem(file.name);
    reading.sources.push_back(std::move(file));
    Parsed parsed = parse(reading.sources.front().text);
    reading.messages = std::move(parsed.messages);
    if (!parsed.is_json) return reading;
    for (const std::string& text : overrides) {
        reading.sources.push_back(override_source(text));
        apply_override(parsed.root, text, reading.sources.size() - 1, reading.messages);
    }
    Scene scene = read_tree(parsed.root, name, reading.messages);
    std::stable_sort(reading.messages.begin(), reading.messages.end(),
                     [](const Message& a, const Message& b) { return a.place < b.place; });
    const bool fatal =
        std::any_of(reading.messages.begin(), reading.messages.end(), [](const Message& m) { return m.fatal; });
    if (!fatal) reading.scene = std::move(scene);
    return reading;
}

Source load_source(const std::string& path) {
    std::error_code ignored;
    if (path != "-" && std::filesystem::is_directory(path, ignored))
        throw UnreadableFile(fmt::format("{} is a directory; name a scene file inside it", path));
    errno = 0;
    std::unique_ptr<std::FILE, CloseFile> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
    if (!file)
        throw UnreadableFile(
            errno == ENOENT
                ? fmt::format("{}: there is no such file; `beamcam init` writes a scene to start from", path)
                : fmt::format("{} cannot be opened: {}", path, std::strerror(errno)));
    Source source{path == "-" ? "<stdin>" : path, {}, true};
    std::array<char, 65536> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
        source.text.append(block.data(), n);
        if (source.text.size() > kLargestScene) break;  // the parser refuses it in words
    }
    if (std::ferror(file.get())) throw UnreadableFile(fmt::format("{} cannot be read: {}", path, std::strerror(errno)));
    return source;
}

std::optional<Size> parse_size(std::string_view text) {
    Size size;
    const char* end = text.data() + text.size();
    const auto [x, error] = std::from_chars(text.data(), end, size.width);
    if (error != std::errc{} || x == end || *x != 'x') return std::nullopt;
    const auto [last, bad] = std::from_chars(x + 1, end, size.height);
    if (bad != std::errc{} || last != end) return std::nullopt;
    const bool fits =
        std::min(size.width, size.height) >= kSmallestSide && std::max(size.width, size.height) <= kLargestSide;
    return fits ? std::optional(size) : std::nullopt;
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    const char* end = text.data() + text.size();
    FrameRate rate;
    if (text.find('/') != std::string_view::npos) {
        const auto [slash, error] = std::from_chars(text.data(), end, rate.numerator);
        if (error != std::errc{} || slash == end || *slash != '/') return std::nullopt;
        const auto [last, bad] = std::from_chars(slash + 1, end, rate.denominator);
        if (bad != std::errc{} || last != end) return std::nullopt;
    } else {
        double value = 0;
        const auto [last, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc{} || last != end || !(value >= kSlowestFrameRate && value <= kFastestFrameRate))
            return std::nullopt;
        const output::FrameRate meant = output::frame_rate(value);  // 29.97 means 30000/1001
        rate = {meant.rate, meant.base};
    }
    if (rate.numerator <= 0 || rate.denominator <= 0 || rate.value() < kSlowestFrameRate ||
        rate.value() > kFastestFrameRate)
        return std::nullopt;
    const int divisor = std::gcd(rate.numerator, rate.denominator);
    return FrameRate{rate.numerator / divisor, rate.denominator / divisor};
}

std::string problem_with_span(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time), fps = span.fps.value();
    const double first = std::round(span.from * fps), last = std::round(to * fps);
    if (!(last > first))
        return fmt::format(
            "no frame lies between {:g} s and {:g} s at {:g} frames a second; \"to\" must be later than \"from\"",
            span.from, to, fps);
    if (last - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are more than the {:.0f} that one output can have; use \"from\" and \"to\", or fewer frames "
            "a second",
            last - first, kMostFrames);
    return {};
}

}  // namespace beamcam::scenes
