// One motion serves every problem with the same key, a finished file every scene with the same inputs. So the keys must
// change with every leaf of a scene that matters, and with no other. The leaves are those of the schema: one that the
// full scenes lack fails the test.
#include "scenes/motions/identity.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "render/base/modules.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;
using Pointer = SortedJson::json_pointer;
using testing::kCorpus;

// The schema as a tree of leaves. A leaf is named by its path and the variants on the way:
// "hub.drive{type=prescribed law=spin-up}.duration".
class Schema {
  public:
    Schema() : root_(SortedJson::parse(testing::slurp(BEAMCAM_TEST_DIR "/../scenes/beamcam-scene.schema.json"))) {
        enumerate(root_, "", {});
    }
    const std::set<std::string>& leaves() const { return leaves_; }

    struct Leaf {
        std::string id;
        Pointer place;                // in the scene
        std::set<std::string> words;  // that the schema allows there
    };
    // Every leaf that a scene has.
    std::vector<Leaf> leaves_of(const SortedJson& scene) const {
        std::vector<Leaf> found;
        walk(root_, "", {}, scene, Pointer(), found);
        return found;
    }

  private:
    using Entered = std::map<std::string, std::string>;  // reference → the path at which it was first followed

    static bool is_tag(const SortedJson& schema) { return schema.contains("const"); }

    // The variants that a schema offers, references followed. A reference that is followed already leads nowhere in
    // `enumerate`, and back to its first path in `walk`.
    struct Variant {
        const SortedJson* schema;
        std::string path;
        Entered entered;
        bool again = false;
    };
    void expand(const SortedJson& schema, const std::string& path, Entered entered, bool again,
                std::vector<Variant>& out) const {
        if (const auto reference = schema.find("$ref"); reference != schema.end()) {
            const auto& name = reference->get_ref<const std::string&>();
            const auto [first, fresh] = entered.emplace(name, path);
            const std::string from = first->second;
            return expand(root_.at(Pointer(name.substr(1))), from, entered, again || !fresh, out);
        }
        if (const auto all = schema.find("allOf"); all != schema.end())
            return expand(all->front(), path, entered, again, out);
        for (const char* choice : {"anyOf", "oneOf"})
            if (const auto all = schema.find(choice); all != schema.end()) {
                for (const SortedJson& each : *all) expand(each, path, entered, again, out);
                return;
            }
        out.push_back({&schema, path, entered, again});
    }
    std::vector<Variant> variants(const SortedJson& schema, const std::string& path, const Entered& entered) const {
        std::vector<Variant> out;
        expand(schema, path, entered, false, out);
        return out;
    }

    // A variant differs from the others by its tags and its required keys.
    static std::string label(const SortedJson& object) {
        std::string text;
        for (const SortedJson& key : object.value("required", SortedJson::array())) {
            const SortedJson& property = object.at("properties").at(key.get<std::string>());
            if (!text.empty()) text += ' ';
            text += key.get<std::string>() + (is_tag(property) ? "=" + property["const"].get<std::string>() : "");
        }
        return text.empty() ? "" : "{" + text + "}";
    }
    static std::string below(const Variant& variant, const std::string& key) {
        const std::string path = variant.path + label(*variant.schema);
        return path.empty() ? key : path + "." + key;
    }

    void enumerate(const SortedJson& schema, const std::string& path, const Entered& entered) {
        if (is_tag(schema)) return;
        for (const Variant& variant : variants(schema, path, entered)) {
            if (variant.again) continue;
            const SortedJson& s = *variant.schema;
            if (s.contains("properties")) {
                for (const auto& [key, property] : s["properties"].items())
                    enumerate(property, below(variant, key), variant.entered);
            } else if (s.contains("items")) {
                enumerate(s["items"], variant.path + "[]", variant.entered);
            } else if (!s.contains("type") || s["type"] != "null") {  // one type, or an array of them
                leaves_.insert(variant.path);
            }
        }
    }

    static bool matches(const SortedJson& object, const SortedJson& value) {
        if (!object.contains("properties") || !value.is_object()) return false;
        for (const SortedJson& key : object.value("required", SortedJson::array()))
            if (!value.contains(key.get<std::string>())) return false;
        for (const auto& [key, given] : value.items()) {
            const auto property = object["properties"].find(key);
            if (property == object["properties"].end()) return false;
            if (is_tag(*property) && (*property)["const"] != given) return false;
            if (property->contains("enum") &&
                std::ranges::find((*property)["enum"], given) == (*property)["enum"].end())
                return false;
        }
        return true;
    }

    void walk(const SortedJson& schema, const std::string& path, const Entered& entered, const SortedJson& value,
              const Pointer& place, std::vector<Leaf>& found) const {
        if (is_tag(schema)) return;
        const std::vector<Variant> all = variants(schema, path, entered);
        std::set<std::string> words;
        for (const Variant& variant : all) {
            const SortedJson& s = *variant.schema;
            if (matches(s, value)) {
                for (const auto& [key, given] : value.items())
                    walk(s["properties"][key], below(variant, key), variant.entered, given, place / key, found);
                return;
            }
            if (s.contains("items") && value.is_array()) {
                for (std::size_t i = 0; i < value.size(); ++i)
                    walk(s["items"], variant.path + "[]", variant.entered, value[i], place / i, found);
                return;
            }
            if (s.contains("const")) words.insert(s["const"].get<std::string>());
            for (const SortedJson& word : s.value("enum", SortedJson::array())) words.insert(word.get<std::string>());
        }
        found.push_back({all.front().path, place, words});
    }

    SortedJson root_;
    std::set<std::string> leaves_;
};

// Other values that the leaf might have; not all of them are allowed there.
std::vector<SortedJson> alternatives(const SortedJson& value, const std::set<std::string>& words,
                                     const fs::path& folder) {
    std::vector<SortedJson> others;
    if (value.is_boolean()) others.emplace_back(!value.get<bool>());
    if (value.is_number_integer())
        for (const long step : {1, -1, 2}) others.emplace_back(value.get<long>() + step);
    if (value.is_number())
        for (const double other : {value.get<double>() * 1.015625, value.get<double>() * 0.984375, 1e-3})
            others.emplace_back(other);
    if (value.is_object()) {
        SortedJson larger = value;  // all lengths in another unit: an outline in two would be no outline
        for (auto& inner : larger)
            if (inner == "mm") inner = "cm";
        others.push_back(larger);
    }
    if (value.is_object())
        for (const auto& [key, inner] : value.items())
            for (const SortedJson& other : alternatives(inner, {}, folder)) {
                others.push_back(value);
                others.back()[key] = other;
            }
    if (!value.is_string()) return others;
    for (const std::string& word : words) others.emplace_back(word);
    const auto& text = value.get_ref<const std::string&>();
    if (const std::size_t digit = text.find_first_of("012345678"); digit != std::string::npos) {
        others.emplace_back(text);
        ++others.back().get_ref<std::string&>()[digit];
    }
    others.emplace_back("other " + text);
    if (text == "deg") others.emplace_back("rad");
    if (text == "theta_dot") others.emplace_back("theta");
    for (const auto& entry : fs::directory_iterator(folder)) others.emplace_back(entry.path().filename().string());
    return others;
}

struct Identities {
    std::set<std::string> motion;  // of the scene, and of those that its pictures compare it with
    std::vector<std::string> outputs;
};

std::vector<Compared> compared_in(const Output& output) {
    if (const auto* figure = std::get_if<FigureOutput>(&output)) return figure->series.compare;
    return std::visit(
        [](const auto& o) -> std::vector<Compared> {
            if constexpr (std::is_base_of_v<Picture, std::decay_t<decltype(o)>>)
                return o.compare;
            else
                return {};
        },
        output);
}

Identities identities(const Scene& scene) {
    Identities all;
    all.motion.insert("scene " + motion_key(scene.problem));
    for (std::size_t i = 0; i < scene.outputs.size(); ++i) {
        all.outputs.push_back(inputs_key(scene, i));
        const std::vector<Compared> compared = compared_in(scene.outputs[i]);
        for (std::size_t k = 0; k < compared.size(); ++k)
            all.motion.insert(fmt::format("outputs.{}.compare.{} {}", i, k, motion_key(compared[k].problem)));
    }
    return all;
}

bool is_mechanics(const std::string& section) {
    return section != "$schema" && section != "title" && section != "time" && section != "units" &&
           section != "sweep" && section != "data" && section != "outputs";
}

// Whether another value of the leaf may be another motion, or is only drawn or written.
bool decides_the_motion(const Schema::Leaf& leaf) {
    if (leaf.id.ends_with(".set") || leaf.id.ends_with(".scene")) return true;
    return is_mechanics(leaf.place.to_string().substr(1, leaf.place.to_string().find('/', 1) - 1));
}

// Whether the output shows the leaf.
bool shows(const Scene& scene, std::size_t output, const Schema::Leaf& leaf) {
    const std::string place = leaf.place.to_string();
    if (place.starts_with("/outputs/")) return place.starts_with(fmt::format("/outputs/{}/", output));
    const Output& any = scene.outputs[output];
    const auto* diagram = std::get_if<FigureOutput>(&any);
    const bool data = !diagram && !std::holds_alternative<PictureOutput>(any);
    const bool of_sweep = std::holds_alternative<SweepOutput>(any) || (diagram && diagram->figure == "bifurcation");
    if (place.starts_with("/data/"))
        return std::holds_alternative<FigureOutput>(any) || std::holds_alternative<SummaryOutput>(any) ||
               std::holds_alternative<PictureOutput>(any);
    if (place == "/$schema") return false;
    if (place.starts_with("/sweep/")) return of_sweep;
    if (place == "/title" || place.starts_with("/units/")) return !data;
    if (place != "/time/end") return true;
    if (of_sweep) return false;
    if (const auto* pictures = std::get_if<PictureOutput>(&any)) return !pictures->span.to;
    if (const auto* table = std::get_if<TrajectoryOutput>(&any)) return table->times.empty();
    if (const auto* figure = std::get_if<FigureOutput>(&any)) return !figure->series.to;
    return true;
}

bool shows_the_whole_run(const Output& output) {
    return std::holds_alternative<ImpactsOutput>(output) || std::holds_alternative<SummaryOutput>(output);
}

std::set<std::string> difference(const std::set<std::string>& a, const std::set<std::string>& b) {
    std::set<std::string> only;
    std::ranges::set_difference(a, b, std::inserter(only, only.end()));
    return only;
}

TEST(Identity, ChangesExactlyWithTheLeavesThatMatter) {
    SKIP_UNDER_SANITIZERS();
    const Schema schema;
    std::set<std::string> changed;
    for (const char* folder : {"full", "whole"})
        for (const auto& entry : fs::directory_iterator(kCorpus / folder)) {
            const fs::path& file = entry.path();
            if (file.extension() != ".json") continue;  // a column of numbers for a scene
            const auto read = [&](const SortedJson& scene) {
                return read_scene({file.string(), scene.dump(), true}).scene;
            };
            const SortedJson full = SortedJson::parse(testing::slurp(file));
            const auto scene = read(full);
            ASSERT_TRUE(scene) << file;
            const Identities before = identities(*scene);
            for (const Schema::Leaf& leaf : schema.leaves_of(full)) {
                for (const SortedJson& value : alternatives(full[leaf.place], leaf.words, file.parent_path())) {
                    if (value == full[leaf.place]) continue;
                    SortedJson other = full;
                    other[leaf.place] = value;
                    const auto reread = read(other);
                    if (!reread) continue;
                    changed.insert(leaf.id);
                    const Identities after = identities(*reread);
                    const std::string what =
                        fmt::format("{}: {} = {}", file.filename().string(), leaf.id, value.dump());
                    if (leaf.id != "outputs[]{type=figure}.figure") {  // a preset may bring motions of its own
                        EXPECT_EQ(after.motion != before.motion, decides_the_motion(leaf)) << what;
                    }
                    const bool longer = run_end(*scene) != run_end(*reread);  // a later state, or a later row
                    for (std::size_t i = 0; i < before.outputs.size(); ++i)
                        EXPECT_EQ(after.outputs[i] != before.outputs[i],
                                  shows(*scene, i, leaf) || (longer && shows_the_whole_run(scene->outputs[i])))
                            << what << ", of " << i;
                    if (!leaf.words.contains(value.is_string() ? value.get<std::string>() : "")) break;
                }
            }
        }
    for (const std::string& leaf : difference(schema.leaves(), changed))
        ADD_FAILURE() << "no full scene has " << leaf << ", or none can have another value there";
    EXPECT_GE(schema.leaves().size(), 150u);
}

TEST(Identity, IsThatOfTheProblemHoweverItIsWritten) {
    const auto key = [](const std::string& text) { return motion_key(testing::read(text).scene->problem); };
    EXPECT_EQ(key("{}"), key(R"({"beam": {"length": "1000 mm"}, "title": "other", "time": {"end": 3}})"));
}

// Started by the test below in a process of its own, because the identity is computed once.
TEST(Identity, DISABLED_IsPrintedAfterAModuleIsLoaded) {
    if (const char* module = std::getenv("BEAMCAM_TEST_LOADS")) {
        ASSERT_TRUE(dlopen(module, RTLD_NOW)) << dlerror();
    }
    fmt::print("identity {}\n", program_identity());
}

// The module of films brings FFmpeg, which the program is not linked with.
TEST(Identity, DoesNotDependOnTheModulesThatWereLoadedBefore) {
    const auto identity = [](const std::string& loads) {
        const testing::Folder folder;
        const testing::Finished printed =
            testing::shell(folder, "env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX " + loads + " " +
                                       fs::read_symlink("/proc/self/exe").string() +
                                       " --gtest_also_run_disabled_tests --gtest_filter=Identity.DISABLED_Is*");
        EXPECT_EQ(printed.code, 0) << printed.out << printed.err;
        const std::size_t at = printed.out.find("identity ");
        return at == std::string::npos ? std::string() : printed.out.substr(at, printed.out.find('\n', at) - at);
    };
    const fs::path self = fs::read_symlink("/proc/self/exe");
    fs::path module;
    for (const fs::path& place : render::module_places(self, "beamcam_video.so"))
        if (module.empty() && fs::exists(place)) module = place;
    if (module.empty()) GTEST_SKIP() << "the module of films is not built";
    const std::string alone = identity("");
    EXPECT_TRUE(alone.starts_with("identity beamcam ")) << alone;
    EXPECT_EQ(identity("BEAMCAM_TEST_LOADS='" + module.string() + "'"), alone);
}

}  // namespace
}  // namespace beamcam::scenes
