#include "render/film/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render/film/page.hpp"
#include "render/film/panel.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/mechanism/mesh.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

constexpr std::size_t kJoints = 25;  // along the beam
constexpr int kSides = 96;           // of a disc
constexpr double kLargestTurn =
    1;  // rotation of the cam between two keys [rad]; beyond π interpolation would go backwards
constexpr double kThinnest = 0.008, kWide = 0.06;  // depth and width of the drawn beam relative to its length

// The binary arrays of the file and their JSON descriptions.
class Arrays {
  public:
    template <class Number>
    int add(const std::vector<Number>& values, const char* type, int component, int width, bool bounds, int target) {
        while (bytes_.size() % 4 != 0) bytes_ += '\0';
        std::string view = fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{})", bytes_.size(),
                                       values.size() * sizeof(Number));
        if (target != 0) view += fmt::format(R"(,"target":{})", target);
        views_.push_back(view + "}");
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
        std::string accessor =
            fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}")", views_.size() - 1, component,
                        values.size() / static_cast<std::size_t>(width), type);
        if (bounds) {
            std::vector<Number> low(values.begin(), values.begin() + width), high = low;
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::size_t k = i % static_cast<std::size_t>(width);
                low[k] = std::min(low[k], values[i]), high[k] = std::max(high[k], values[i]);
            }
            accessor += fmt::format(R"(,"min":[{}],"max":[{}])", fmt::join(low, ","), fmt::join(high, ","));
        }
        accessors_.push_back(accessor + "}");
        return static_cast<int>(accessors_.size()) - 1;
    }
    int floats(const std::vector<float>& values, const char* type, int width, bool bounds = false, int target = 0) {
        return add(values, type, 5126, width, bounds, target);
    }
    std::string& bytes() { return bytes_; }
    std::string json() const {
        return fmt::format(R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}])",
                           fmt::join(accessors_, ","), fmt::join(views_, ","), bytes_.size());
    }

  private:
    std::string bytes_;
    std::vector<std::string> views_, accessors_;
};

class Model {
  public:
    explicit Model(const FilmSetup& setup)
        : context_(std::make_shared<const FilmSetup>(setup)),
          problem_(context_.motion(0).problem),
          length_(problem_.beam.length),
          wide_(kWide * length_),
          depth_(std::max(beam_depth(problem_.beam), kThinnest * length_)) {
        double first = context_.at(0);
        for (int k = 0; k < context_.frames(); ++k) {
            poses_.push_back(context_.pose(0, k));
            beams_.push_back(drawn_beam(problem_, poses_.back(), context_.factor, depth_));
            times_.push_back(static_cast<float>(context_.at(k) - first));
        }
        keys_ = arrays_.floats(times_, "SCALAR", 1, true);
    }

    std::string file() {
        add_fixed();
        add_hub();
        if (problem_.cam) add_cam();
        add_beam();
        std::string json = fmt::format(
            R"({{"asset":{{"version":"2.0","generator":"beamcam","extras":{{"title":{},"deflection":{:.9g}}}}},"scene":0,)"
            R"("scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{}],"materials":[{}],"skins":[{}],)"
            R"("animations":[{{"name":"motion","channels":[{}],"samplers":[{}]}}],{}}})",
            json_text(plain_text(context_.setup->title)), context_.factor, fmt::join(roots_, ","),
            fmt::join(nodes_, ","), fmt::join(meshes_, ","), materials(), skin_, fmt::join(channels_, ","),
            fmt::join(samplers_, ","), arrays_.json());
        while (json.size() % 4 != 0) json += ' ';
        std::string& bytes = arrays_.bytes();
        while (bytes.size() % 4 != 0) bytes += '\0';
        std::string out = "glTF";
        const auto word = [&](std::size_t value) {
            const auto number = static_cast<std::uint32_t>(value);
            out.append(reinterpret_cast<const char*>(&number), 4);
        };
        word(2), word(12 + 8 + json.size() + 8 + bytes.size());
        word(json.size()), out += "JSON" + json;
        word(bytes.size()), (out += "BIN") += '\0';
        return out += bytes;
    }

  private:
    enum Material { steel, dark, blue };

    std::string materials() const {
        const auto one = [](const char* name, const Color& c, double metal) {
            return fmt::format(
                R"({{"name":"{}","pbrMetallicRoughness":{{"baseColorFactor":[{:.4f},{:.4f},{:.4f},1],"metallicFactor":{},"roughnessFactor":0.45}}}})",
                name, linear_light(c.r), linear_light(c.g), linear_light(c.b), metal);
        };
        const Palette& p = *context_.palette;
        return one("steel", p.steel, 0.6) + "," + one("pin", p.pin, 0.3) + "," + one("beam", p.motion, 0.1);
    }

    int add_node(const std::string& name, const std::string& more, bool root = true) {
        nodes_.push_back(fmt::format(R"({{"name":"{}"{}}})", name, more));
        const int index = static_cast<int>(nodes_.size()) - 1;
        if (root) roots_.push_back(index);
        return index;
    }

    // `joints`: of each vertex; empty for rigid bodies.
    int add_mesh(const Mesh& mesh, Material material, const std::vector<std::size_t>& joints = {}) {
        constexpr int kVertices = 34962, kIndices = 34963, kByte = 5121, kWord = 5125;
        std::vector<float> places, normals, weights;
        for (const MeshVertex& v : mesh.vertices) {
            places.insert(places.end(), v.place.begin(), v.place.end());
            normals.insert(normals.end(), v.normal.begin(), v.normal.end());
        }
        std::string attributes =
            fmt::format(R"("POSITION":{},"NORMAL":{})", arrays_.floats(places, "VEC3", 3, true, kVertices),
                        arrays_.floats(normals, "VEC3", 3, false, kVertices));
        if (!joints.empty()) {
            std::vector<std::uint8_t> owners;
            for (const std::size_t joint : joints) {
                owners.insert(owners.end(), {static_cast<std::uint8_t>(joint), 0, 0, 0});
                weights.insert(weights.end(), {1, 0, 0, 0});
            }
            attributes +=
                fmt::format(R"(,"JOINTS_0":{},"WEIGHTS_0":{})", arrays_.add(owners, "VEC4", kByte, 4, false, kVertices),
                            arrays_.floats(weights, "VEC4", 4, false, kVertices));
        }
        meshes_.push_back(fmt::format(R"({{"primitives":[{{"attributes":{{{}}},"indices":{},"material":{}}}]}})",
                                      attributes, arrays_.add(mesh.corners, "SCALAR", kWord, 1, false, kIndices),
                                      static_cast<int>(material)));
        return static_cast<int>(meshes_.size()) - 1;
    }

    void add_cylinder(Mesh& mesh, Vec2 centre, double radius, double back, double front) const {
        mesh.cylinder(
            {.centre = centre, .radius = radius, .back = back, .front = front, .sides = kSides, .closed = true}, {});
    }

    void add_track(int node, const char* path, int keys, const std::vector<float>& values) {
        const bool turns = std::string_view(path) == "rotation";
        samplers_.push_back(fmt::format(R"({{"input":{},"interpolation":"LINEAR","output":{}}})", keys,
                                        arrays_.floats(values, turns ? "VEC4" : "VEC3", turns ? 4 : 3)));
        channels_.push_back(
            fmt::format(R"({{"sampler":{},"target":{{"node":{},"path":"{}"}}}})", samplers_.size() - 1, node, path));
    }
    // A quaternion about z; continuous, because it depends on half the angle.
    static void add_turn(std::vector<float>& track, double angle) {
        for (const double v : {0.0, 0.0, std::sin(angle / 2), std::cos(angle / 2)})
            track.push_back(static_cast<float>(v));
    }

    double hub_size() const {
        double boss = 1.1 * depth_;
        if (problem_.cam)
            boss = std::min(
                boss,
                0.7 * std::max(norm(problem_.cam->centre) - problem_.cam->radius - problem_.cam->eccentricity, 0.0));
        return std::max({problem_.hub.radius, boss, 0.002 * length_});
    }

    void add_fixed() {
        const double hub = hub_size(), foot = hub + 0.04 * length_;
        Mesh support;
        support.box({-0.8 * hub, -foot, -1.5 * wide_}, {0.8 * hub, 0, -0.75 * wide_}, {});
        support.box({-1.5 * hub, -foot - 0.012 * length_, -1.5 * wide_}, {1.5 * hub, -foot, 0.75 * wide_}, {});
        add_node("support", fmt::format(R"(,"mesh":{})", add_mesh(support, steel)));
        Mesh pins;
        add_cylinder(pins, {0, 0}, 0.35 * hub, -1.5 * wide_, 0.75 * wide_);
        if (problem_.cam)
            add_cylinder(pins, problem_.cam->centre, 0.1 * problem_.cam->radius, -1.5 * wide_, 0.68 * wide_);
        add_node("axes", fmt::format(R"(,"mesh":{})", add_mesh(pins, dark)));
    }

    void add_hub() {
        Mesh shape;
        add_cylinder(shape, {0, 0}, hub_size(), -0.7 * wide_, 0.7 * wide_);
        const int node = add_node("hub", fmt::format(R"(,"mesh":{})", add_mesh(shape, steel)));
        std::vector<float> turns;
        for (const sim::Pose& pose : poses_) add_turn(turns, pose.theta);
        add_track(node, "rotation", keys_, turns);
    }

    void add_cam() {
        const sim::Cam& cam = *problem_.cam;
        Mesh shape, mark;
        add_cylinder(shape, {cam.eccentricity, 0}, cam.radius, -0.62 * wide_, 0.62 * wide_);
        add_cylinder(mark, {cam.eccentricity + 0.85 * cam.radius, 0}, 0.05 * cam.radius, 0.62 * wide_, 0.63 * wide_);
        const int on = add_node("cam mark", fmt::format(R"(,"mesh":{})", add_mesh(mark, dark)), false);
        const int node = add_node("cam", fmt::format(R"(,"mesh":{},"children":[{}],"translation":[{:.9g},{:.9g},0])",
                                                     add_mesh(shape, steel), on, cam.centre.x, cam.centre.y));
        const double duration = times_.back();
        const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(cam.speed) * duration / kLargestTurn)));
        std::vector<float> times, turns;
        for (int i = 0; i <= steps && (i == 0 || duration > 0); ++i) {
            times.push_back(static_cast<float>(duration * i / steps));
            add_turn(turns, poses_.front().cam_angle - cam.speed * duration * i / steps);
        }
        add_track(node, "rotation", arrays_.floats(times, "SCALAR", 1, true), turns);
    }

    // A bar at rest; every station belongs to one joint.
    void add_beam() {
        const std::size_t last = beams_.front().line.size() - 1, count = std::min(kJoints, last + 1);
        const DrawnBeam& beam = beams_.front();
        std::vector<Vec2> low, high;
        for (std::size_t i = 0; i < count; ++i) {
            const double x = length_ * static_cast<double>(i) / static_cast<double>(count - 1);
            low.push_back({x, beam.low}), high.push_back({x, beam.high});
        }
        Mesh bar;
        bar.bar(low, high, std::vector<Color>(count), wide_ / 2);
        std::vector<std::size_t> owners;
        for (std::size_t k = 0; k < bar.vertices.size(); ++k)
            owners.push_back(k < Mesh::kRing * count ? k / Mesh::kRing : k < Mesh::kRing * count + 4 ? 0 : count - 1);
        const int mesh = add_mesh(bar, blue, owners);
        std::vector<int> joints;
        std::vector<float> inverse;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t at = i * last / (count - 1);
            const double x = length_ * static_cast<double>(i) / static_cast<double>(count - 1);
            std::vector<float> places, turns;
            double before = 0;
            for (const DrawnBeam& one : beams_) {
                const Vec2 p = one.line[at], n = one.left[at];
                const double angle = before + std::remainder(std::atan2(-n.x, n.y) - before, 2 * std::numbers::pi);
                before = angle;
                for (const double v : {p.x, p.y, 0.0}) places.push_back(static_cast<float>(v));
                add_turn(turns, angle);
            }
            joints.push_back(add_node(fmt::format("beam {}", i),
                                      fmt::format(R"(,"translation":[{},{},0],"rotation":[0,0,{},{}])", places[0],
                                                  places[1], turns[2], turns[3]),
                                      false));
            add_track(joints.back(), "translation", keys_, places);
            add_track(joints.back(), "rotation", keys_, turns);
            for (const double v : {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -x, 0.0, 0.0, 1.0})
                inverse.push_back(static_cast<float>(v));
        }
        add_node("joints", fmt::format(R"(,"children":[{}])", fmt::join(joints, ",")));
        skin_ = fmt::format(R"({{"inverseBindMatrices":{},"joints":[{}]}})", arrays_.floats(inverse, "MAT4", 16),
                            fmt::join(joints, ","));
        add_node("beam", fmt::format(R"(,"mesh":{},"skin":0)", mesh));
    }

    FilmContext context_;
    const sim::Problem& problem_;
    double length_, wide_, depth_;
    std::vector<sim::Pose> poses_;
    std::vector<DrawnBeam> beams_;
    std::vector<float> times_;
    Arrays arrays_;
    int keys_ = 0;
    std::vector<int> roots_;
    std::vector<std::string> nodes_, meshes_, channels_, samplers_;
    std::string skin_;
};

}  // namespace

std::string glb_model(const FilmSetup& setup) { return Model(setup).file(); }

}  // namespace beamcam::render
