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
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

constexpr std::size_t kJoints = 25;  // along the beam
constexpr int kSides = 96;           // of a disc
constexpr double kLargestTurn =
    1;  // rotation of the cam between two keys [rad]; beyond π interpolation would go backwards
constexpr double kThinnest = 0.008, kWide = 0.06;  // depth and width of the drawn beam relative to its length

struct Shape {
    std::vector<float> places, normals;
    std::vector<std::uint8_t> joints;  // four per vertex, only for the beam
    std::vector<float> weights;
    std::vector<std::uint32_t> corners;

    std::uint32_t vertex(double x, double y, double z, double nx, double ny, double nz) {
        for (const double v : {x, y, z}) places.push_back(static_cast<float>(v));
        for (const double v : {nx, ny, nz}) normals.push_back(static_cast<float>(v));
        return static_cast<std::uint32_t>(places.size() / 3 - 1);
    }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        corners.insert(corners.end(), {a, b, c, a, c, d});
    }
    void disc(Vec2 centre, double radius, double back, double front) {
        const auto ring = [&](double z, double nz) {
            const auto first = static_cast<std::uint32_t>(places.size() / 3);
            for (int i = 0; i < kSides; ++i) {
                const Vec2 n = sim::unit(2 * std::numbers::pi * i / kSides);
                vertex(centre.x + radius * n.x, centre.y + radius * n.y, z, nz == 0 ? n.x : 0, nz == 0 ? n.y : 0, nz);
            }
            return first;
        };
        const std::uint32_t low = ring(back, 0), high = ring(front, 0), under = ring(back, -1), over = ring(front, 1);
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            quad(low + i, low + next, high + next, high + i);
            if (i == 0 || next == 0) continue;
            corners.insert(corners.end(), {over, over + i, over + next});
            corners.insert(corners.end(), {under, under + next, under + i});
        }
    }
    void box(double x0, double x1, double y0, double y1, double z0, double z1) {
        const double at[2][3] = {{x0, y0, z0}, {x1, y1, z1}};
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                std::array<std::uint32_t, 4> face{};
                for (int k = 0; k < 4; ++k) {
                    int which[3] = {0, 0, 0};
                    which[axis] = side;
                    which[(axis + 1) % 3] = (k == 1 || k == 2) ? 1 : 0;
                    which[(axis + 2) % 3] = k >= 2 ? 1 : 0;
                    double n[3] = {0, 0, 0};
                    n[axis] = side == 1 ? 1 : -1;
                    face[static_cast<std::size_t>(k)] =
                        vertex(at[which[0]][0], at[which[1]][1], at[which[2]][2], n[0], n[1], n[2]);
                }
                side == 1 ? quad(face[0], face[1], face[2], face[3]) : quad(face[3], face[2], face[1], face[0]);
            }
    }
};

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
          depth_(std::max(problem_.beam.depth, kThinnest * length_)) {
        double first = context_.at(0, 0);
        for (int k = 0; k < context_.frames(); ++k) {
            poses_.push_back(context_.pose(0, k));
            beams_.push_back(drawn_beam(problem_, poses_.back(), context_.factor, depth_));
            times_.push_back(static_cast<float>(context_.at(0, k) - first));
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
            const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
            return fmt::format(
                R"({{"name":"{}","pbrMetallicRoughness":{{"baseColorFactor":[{:.4f},{:.4f},{:.4f},1],"metallicFactor":{},"roughnessFactor":0.45}}}})",
                name, linear(c.r), linear(c.g), linear(c.b), metal);
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

    int add_mesh(const Shape& shape, Material material) {
        constexpr int kVertices = 34962, kIndices = 34963, kByte = 5121, kWord = 5125;
        std::string attributes =
            fmt::format(R"("POSITION":{},"NORMAL":{})", arrays_.floats(shape.places, "VEC3", 3, true, kVertices),
                        arrays_.floats(shape.normals, "VEC3", 3, false, kVertices));
        if (!shape.joints.empty())
            attributes += fmt::format(R"(,"JOINTS_0":{},"WEIGHTS_0":{})",
                                      arrays_.add(shape.joints, "VEC4", kByte, 4, false, kVertices),
                                      arrays_.floats(shape.weights, "VEC4", 4, false, kVertices));
        meshes_.push_back(fmt::format(R"({{"primitives":[{{"attributes":{{{}}},"indices":{},"material":{}}}]}})",
                                      attributes, arrays_.add(shape.corners, "SCALAR", kWord, 1, false, kIndices),
                                      static_cast<int>(material)));
        return static_cast<int>(meshes_.size()) - 1;
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
        Shape support;
        support.box(-0.8 * hub, 0.8 * hub, -foot, 0, -1.5 * wide_, -0.75 * wide_);
        support.box(-1.5 * hub, 1.5 * hub, -foot - 0.012 * length_, -foot, -1.5 * wide_, 0.75 * wide_);
        add_node("support", fmt::format(R"(,"mesh":{})", add_mesh(support, steel)));
        Shape pins;
        pins.disc({0, 0}, 0.35 * hub, -1.5 * wide_, 0.75 * wide_);
        if (problem_.cam) pins.disc(problem_.cam->centre, 0.1 * problem_.cam->radius, -1.5 * wide_, 0.68 * wide_);
        add_node("axes", fmt::format(R"(,"mesh":{})", add_mesh(pins, dark)));
    }

    void add_hub() {
        Shape shape;
        shape.disc({0, 0}, hub_size(), -0.7 * wide_, 0.7 * wide_);
        const int node = add_node("hub", fmt::format(R"(,"mesh":{})", add_mesh(shape, steel)));
        std::vector<float> turns;
        for (const sim::Pose& pose : poses_) add_turn(turns, pose.theta);
        add_track(node, "rotation", keys_, turns);
    }

    void add_cam() {
        const sim::Cam& cam = *problem_.cam;
        Shape shape, mark;
        shape.disc({cam.eccentricity, 0}, cam.radius, -0.62 * wide_, 0.62 * wide_);
        mark.disc({cam.eccentricity + 0.85 * cam.radius, 0}, 0.05 * cam.radius, 0.62 * wide_, 0.63 * wide_);
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

    // Rings of four corners, with two or three normals each; every ring belongs to one joint.
    void add_beam() {
        const std::size_t last = beams_.front().line.size() - 1, count = std::min(kJoints, last + 1);
        const DrawnBeam& beam = beams_.front();
        Shape shape;
        const auto add = [&](std::size_t joint, double x, double y, double z, Vec2 n, double nz) {
            shape.joints.insert(shape.joints.end(), {static_cast<std::uint8_t>(joint), 0, 0, 0});
            shape.weights.insert(shape.weights.end(), {1, 0, 0, 0});
            return shape.vertex(x, y, z, n.x, n.y, nz);
        };
        const double half = wide_ / 2;
        std::vector<std::array<std::uint32_t, 8>> rings;
        for (std::size_t i = 0; i < count; ++i) {
            const double x = length_ * static_cast<double>(i) / static_cast<double>(count - 1);
            rings.push_back({add(i, x, beam.low, -half, {0, -1}, 0), add(i, x, beam.low, half, {0, -1}, 0),
                             add(i, x, beam.low, half, {}, 1), add(i, x, beam.high, half, {}, 1),
                             add(i, x, beam.high, half, {0, 1}, 0), add(i, x, beam.high, -half, {0, 1}, 0),
                             add(i, x, beam.high, -half, {}, -1), add(i, x, beam.low, -half, {}, -1)});
        }
        for (std::size_t i = 0; i + 1 < count; ++i)
            for (std::size_t k = 0; k < 8; k += 2)
                shape.quad(rings[i][k], rings[i + 1][k], rings[i + 1][k + 1], rings[i][k + 1]);
        for (const std::size_t i : {std::size_t{0}, count - 1}) {
            const double x = i == 0 ? 0 : length_, n = i == 0 ? -1 : 1;
            const std::uint32_t a = add(i, x, beam.low, -half, {n, 0}, 0), b = add(i, x, beam.high, -half, {n, 0}, 0),
                                c = add(i, x, beam.high, half, {n, 0}, 0), d = add(i, x, beam.low, half, {n, 0}, 0);
            i == 0 ? shape.quad(a, d, c, b) : shape.quad(a, b, c, d);
        }
        const int mesh = add_mesh(shape, blue);
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
