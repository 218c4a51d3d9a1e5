#include "scenes/regression/baselines.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/json/tree.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPictures = 10'000;  // of one entry: each is a file among the references

constexpr double kRate = 1000;  // [Hz] of a trajectory without "rate" and "times"

class Reader {
  public:
    explicit Reader(const std::string& path) : path_(path) {
        all_.source = load_source(path,
                                  "a file of baselines lists what to test: {\"entries\": {\"fall\": {\"scene\": "
                                  "\"fall.json\", \"output\": {\"type\": \"still\", \"at\": \"0.3 s\"}}}}");
    }

    Baselines read() {
        Parsed parsed = parse(all_.source.text);
        if (!parsed.is_json) throw SceneError(describe({all_.source}, std::move(parsed.messages)));
        std::vector<Message> messages = std::move(parsed.messages);
        all_.folder = path_ == "-" ? "references" : fs::path(path_).stem().string();
        read_object(
            parsed.root, "the file of baselines", [this](ObjectReader& r) { visit(r, all_); }, messages);
        const fs::path named = all_.folder.empty() ? "." : all_.folder;
        all_.references = folder() / named;
        const bool leaves = named.is_absolute() || std::ranges::find(named, fs::path("..")) != named.end();
        all_.root = leaves ? all_.references : folder().empty() ? fs::path(".") : folder();
        for (Baseline& entry : all_.entries) {
            const Member& member = *parsed.root.find("entries")->value.find(entry.name);
            if (member.value.kind == Node::Kind::object) complete(entry, member.key_place);
        }
        if (!messages.empty()) {
            std::string report = describe({all_.source}, std::move(messages));
            for (const Baseline& entry : all_.entries) report += entry.problem;
            throw SceneError(report);
        }
        return std::move(all_);
    }

  private:
    fs::path folder() const { return path_ == "-" ? fs::path(".") : fs::path(path_).parent_path(); }

    // Reads the scene and the output of the entry. A missing scene, or an error in it, concerns its entry only.
    void complete(Baseline& entry, const SourcePosition& place) {
        const Tolerance given = all_.tolerance.overridden_by(entry.tolerance);
        const auto present = [&](const Node& node, const char* key, const char* example) {
            return !node.is_null() ||
                   reject(entry, place, "", fmt::format(" needs {}, for example {}", in_quotes(key), example));
        };
        if (present(entry.scene_key, "scene", "\"fall.json\"") &&
            present(entry.output_key, "output", "{\"type\": \"still\", \"at\": \"0.3 s\"}") && read_scene_of(entry) &&
            read_output_of(entry))
            entry.tolerance = defaults_for(entry).overridden_by(given);
    }

    // Adds the error "entries.NAME.KEY<why>" to the entry.
    bool reject(Baseline& entry, const SourcePosition& place, const char* key, const std::string& why) {
        const std::string text = fmt::format("entries.{}{}{}", entry.name, key, why);
        entry.problem += describe({all_.source}, Message{place, text});
        return false;
    }
    bool reject_scene(Baseline& entry, const std::string& why) {
        return reject(entry, entry.scene_key.place, ".scene", why);
    }
    bool reject_output(Baseline& entry, const std::string& why) {
        return reject(entry, entry.output_key.place, ".output", why);
    }

    std::string beside(const std::string& file) const {
        return fs::path(file).is_absolute() ? file : (folder() / file).string();
    }
    // The file of an entry's scene.
    std::string scene_file(const Baseline& entry) const {
        return entry.scene_key.kind == Node::Kind::string ? beside(entry.scene_key.text) : all_.source.name;
    }

    // A file name, relative to this file, or the scene itself.
    bool read_scene_of(Baseline& entry) {
        const Node& node = entry.scene_key;
        Reading reading;
        if (node.kind == Node::Kind::string) {
            try {
                reading = read_scene({scene_file(entry), output::read_regular_file(scene_file(entry))}, entry.set);
            } catch (const output::IoError& error) {
                return reject_scene(entry, fmt::format(": {}", error.what()));
            }
        } else if (node.kind == Node::Kind::object) {
            reading = read_scene({all_.source.name, {}, true}, node, entry.set);
            reading.sources.front() = all_.source;  // the places are those of the whole file
        } else {
            return reject_scene(entry,
                                fmt::format(" must be a file name or a scene {{ … }}, not {}", as_written(node)));
        }
        if (!reading.scene) {
            reject_scene(entry, ": the scene cannot be read");
            entry.problem += reading.report();
            return false;
        }
        entry.scene = std::move(*reading.scene);
        return true;
    }

    // The output replaces those of the scene.
    bool read_output_of(Baseline& entry) {
        const Node& node = entry.output_key;
        entry.scene.name = entry.name;
        if (const Member* type = node.find("type"); type && type->value.text == "sweep") {
            entry.is_sweep = true;
            entry.scene.set_outputs({});
            if (node.members.size() > 1)
                return reject_output(entry, ": the \"sweep\" of the scene describes the sweep; remove the other keys");
            return entry.scene.sweep || reject_output(entry, ": the scene has no \"sweep\"");
        }
        using enum PictureOutput::Kind;
        std::vector<Message> messages;
        const bool fine = read_only_output(node, scene_file(entry), fmt::format("entries.{}.output", entry.name),
                                           entry.scene, messages);
        for (const Message& message : messages)
            if (message.fatal) entry.problem += describe({all_.source}, message);
        if (!fine) return false;
        if (is_data(entry.output()) && !std::holds_alternative<TrajectoryOutput>(entry.output()))
            return reject_output(entry,
                                 ": this type has no references; a \"trajectory\" guards the motion and its impacts");
        // Rows that follow the motion would be others after a change of the solver's tolerance.
        if (auto* table = std::get_if<TrajectoryOutput>(&entry.scene.outputs.front()); table && table->times.empty())
            table->rate = table->rate.value_or(kRate);
        if (picture_of(entry.output(), video))
            return reject_output(entry, ": films are compared before they are encoded; write \"type\": \"frames\"");
        if (picture_of(entry.output(), page))
            return reject_output(entry, ": this type has no pictures; write \"type\": \"frames\"");
        if (const PictureOutput* sequence = picture_of(entry.output(), frames)) {
            const double last = sequence->span.to.value_or(entry.scene.end_time);
            if ((last - sequence->span.from) * sequence->span.fps.value() > kMostPictures)
                return reject_output(
                    entry, fmt::format(": more than {} pictures; use \"from\" and \"to\", or fewer frames a second",
                                       kMostPictures));
        }
        return true;
    }

    static Tolerance defaults_for(const Baseline& entry) {
        bool lit = false;
        if (const auto* picture = entry.picture()) lit = picture->view.style != render::Style::flat;
        // Flat views have the same pixels on all machines with the same libraries; those of OpenGL differ by a level or
        // two between processors. The tolerances of motion and impacts lie between the effect of another tolerance of
        // the solver up to the horizon (7e-6, 5e-5) and the effect of 0.1 % contact stiffness in one impact (1e-4,
        // 5e-4).
        return {lit ? 2 : 0, 0.0, {}, 2e-5, 1e-4};
    }

    std::string path_;
    Baselines all_;
};

}  // namespace

bool Baseline::has_pictures() const { return !is_sweep && !is_data(output()); }

const Picture* Baseline::picture() const {
    if (is_sweep) return nullptr;
    const PictureOutput* still = picture_of(output(), PictureOutput::Kind::still);
    return still ? still : picture_of(output(), PictureOutput::Kind::frames);
}

Baselines read_baselines(const std::string& path) { return Reader(path).read(); }

std::vector<const Baseline*> chosen_entries(const Baselines& baselines, const std::string& path,
                                            const std::vector<std::string>& patterns) {
    const auto is_selected = [](const Baseline& entry, const std::string& pattern) {
        return fnmatch(pattern.c_str(), entry.name.c_str(), 0) == 0;
    };
    std::vector<std::string> known;
    for (const Baseline& entry : baselines.entries) known.push_back(entry.name);
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(baselines.entries, [&](const auto& entry) { return is_selected(entry, pattern); }))
            throw UsageError(
                fmt::format("{} has no entry {}{}", path, in_quotes(pattern), suggestion_or_list(pattern, known)));
    std::vector<const Baseline*> chosen;
    for (const Baseline& entry : baselines.entries)
        if (patterns.empty() ||
            std::ranges::any_of(patterns, [&](const auto& pattern) { return is_selected(entry, pattern); }))
            chosen.push_back(&entry);
    return chosen;
}

}  // namespace beamcam::scenes
