#include "scenes/regression/baselines.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <utility>

#include "output/json/tree.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// ---- reading -------------------------------------------------------------------------------------

constexpr int kMostPictures = 10'000;  // of one entry: each has a digest in the file and a reference picture

bool is_plain_name(std::string_view name) {
    const bool plain = std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
               c == '.';
    });
    return plain && !name.empty() && name.size() <= 100 && name.front() != '.';
}

bool is_digest(const Node& node) {
    return node.kind == Node::Kind::string && node.text.size() == 64 &&
           node.text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

class Reader {
  public:
    explicit Reader(const std::string& path) : path_(path) { all_.source = load_source(path); }

    Baselines read() {
        Parsed parsed = parse(all_.source.text);
        if (!parsed.is_json) throw SceneError(describe({all_.source}, std::move(parsed.messages)));
        messages_ = std::move(parsed.messages);
        read_root(parsed.root);
        for (Message& message : diagnostics_.take()) messages_.push_back(std::move(message));
        if (!messages_.empty()) {
            std::string report = describe({all_.source}, std::move(messages_));
            for (const Baseline& entry : all_.entries) report += entry.problem;
            throw SceneError(report);
        }
        return std::move(all_);
    }

  private:
    fs::path folder() const { return path_ == "-" ? fs::path(".") : fs::path(path_).parent_path(); }

    void read_root(const Node& root) {
        ObjectReader f(diagnostics_, &root, "", "the file of baselines");
        std::string schema, references = path_ == "-" ? "references" : fs::path(path_).stem().string();
        f.text("$schema", schema, "Where an editor finds the schema.");
        f.text("references", references, "Folder of the references.");
        all_.references = folder() / (references.empty() ? "." : references);
        if (const Node* node = f.take("tolerance")) read_tolerances(diagnostics_, *node, "tolerance", defaults_);
        if (const Node* node = f.take("renderers")) read_renderers(*node);
        if (const Node* node =
                f.take(sim::required("entries", "{\"fall\": {\"scene\": \"fall.json\", \"output\": {…}}}")))
            read_entries(*node);
        f.finish();
    }

    void read_renderers(const Node& node) {
        ObjectReader f(diagnostics_, &node, "renderers");
        if (!f.node()) return;
        for (const Member& member : node.members) {
            RendererParts parts;
            for (const Member& part : member.value.members) parts[part.key] = part.value.text;
            all_.renderers[member.key] = std::move(parts);
        }
    }

    void read_entries(const Node& node) {
        ObjectReader f(diagnostics_, &node, "entries");
        if (!f.node()) return;
        if (node.members.empty()) f.fail(node, "", "entries is empty; add at least one entry");
        for (const Member& member : node.members) {
            if (!is_plain_name(member.key))
                diagnostics_.error(
                    member.key_place, "entries." + member.key,
                    fmt::format("{} is the name of files, too: use letters, digits, '-', '_' and '.' only",
                                in_quotes(member.key)));
            else
                read_entry(member);
        }
    }

    void read_entry(const Member& member) {
        const std::string path = "entries." + member.key;
        ObjectReader f(diagnostics_, &member.value, path);
        if (!f.node()) return;
        Baseline entry;
        entry.name = member.key;
        std::vector<std::string> overrides;
        if (const Node* set = f.take("set")) read_overrides(*set, path + ".set", overrides);
        f.text("file", entry.file, "Pictures of another program, in place of a scene.");
        f.text("expected", entry.expected, "Expected pictures, in place of accepted digests.");
        const bool drawn_here = entry.file.empty();
        const Node *scene = drawn_here ? f.take("scene") : nullptr, *output = drawn_here ? f.take("output") : nullptr;
        f.boolean("physics", entry.physics, "Whether the motion is compared, too.");
        Tolerances own;
        if (const Node* tolerance = f.take("tolerance"))
            read_tolerances(diagnostics_, *tolerance, path + ".tolerance", own);
        if (const Node* accepted = f.take("accepted")) read_accepted(*accepted, path + ".accepted", entry.accepted);
        f.number("reproducible_until", entry.reproducible_until, dimension::kTime, sim::kNotNegative,
                 "Time up to which the motion is reproducible.");
        f.finish();
        for (std::string* file : {&entry.file, &entry.expected})
            if (!file->empty()) *file = beside(*file);
        if (!drawn_here) {
            entry.tolerances = Tolerances{{0, 0.0, {}, {}, {}}, {}}.overridden_by(defaults_).overridden_by(own);
            all_.entries.push_back(std::move(entry));
            return;
        }
        // A missing scene, or an error in it, concerns its entry only.
        const auto present = [&](const Node* node, const char* key, const char* example) {
            return node || reject(entry, member.key_place,
                                  fmt::format("{} needs {}, for example {}", path, in_quotes(key), example));
        };
        if (present(scene, "scene", "\"fall.json\"") &&
            present(output, "output", "{\"type\": \"still\", \"at\": \"0.3 s\"}") &&
            read_scene_of(*scene, overrides, path, entry) &&
            read_output_of(*output, path + ".output", scene_file(*scene), entry) &&
            (entry.expected.empty() || entry.has_pictures() ||
             reject(entry, *output, fmt::format("{}.output has no pictures to compare with \"expected\"", path))))
            entry.tolerances = defaults_for(entry).overridden_by(defaults_).overridden_by(own);
        all_.entries.push_back(std::move(entry));
    }

    bool reject(Baseline& entry, const Node& node, const std::string& text) { return reject(entry, node.place, text); }
    bool reject(Baseline& entry, const Place& place, const std::string& text) {
        entry.problem += describe({all_.source}, Message{place, text});
        return false;
    }

    void read_overrides(const Node& node, const std::string& path, std::vector<std::string>& overrides) {
        const bool fine = node.kind == Node::Kind::array &&
                          std::ranges::all_of(node.items, [](const Node& n) { return n.kind == Node::Kind::string; });
        if (!fine)
            return diagnostics_.error(
                node.place, path,
                fmt::format("{} must be an array of strings such as \"cam.speed=5\", not {}", path, as_written(node)));
        for (const Node& item : node.items) overrides.push_back(item.text);
    }

    void read_accepted(const Node& node, const std::string& path, std::vector<Accepted>& accepted) {
        if (node.kind != Node::Kind::array)
            return diagnostics_.error(node.place, path,
                                      fmt::format("{} must be an array [ … ], not {}", path, as_written(node)));
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            ObjectReader f(diagnostics_, &node.items[i], fmt::format("{}.{}", path, i));
            Accepted one;
            f.text("renderer", one.renderer, "The renderer of the accepted pictures.");
            const Node* digests = f.take(sim::required("sha256", "[\"0123…\"]"));
            f.finish();
            if (!digests) continue;
            if (digests->kind != Node::Kind::array || !std::ranges::all_of(digests->items, is_digest)) {
                f.fail(*digests, "sha256",
                       fmt::format("{} must be an array of digests, 64 digits 0…9 a…f each; --update writes them",
                                   f.path("sha256")));
                continue;
            }
            for (const Node& digest : digests->items) one.sha256.push_back(digest.text);
            accepted.push_back(std::move(one));
        }
    }

    // The file of an entry's scene.
    std::string scene_file(const Node& node) const {
        if (node.kind != Node::Kind::string) return all_.source.name;
        return beside(node.text);
    }
    std::string beside(const std::string& file) const {
        return fs::path(file).is_absolute() ? file : (folder() / file).string();
    }

    // A file name, relative to this file, or the scene itself.
    bool read_scene_of(const Node& node, const std::vector<std::string>& overrides, const std::string& path,
                       Baseline& entry) {
        Reading reading;
        if (node.kind == Node::Kind::string) {
            try {
                reading = read_scene(load_named_source(scene_file(node)), overrides);
            } catch (const UnreadableFile& error) {
                return reject(entry, node, fmt::format("{}.scene: {}", path, error.what()));
            }
        } else if (node.kind == Node::Kind::object) {
            reading = read_scene({all_.source.name, {}, true}, node, overrides);
            reading.sources.front() = all_.source;  // the places are those of the whole file
        } else {
            return reject(
                entry, node,
                fmt::format("{}.scene must be a file name or a scene {{ … }}, not {}", path, as_written(node)));
        }
        if (!reading.scene) {
            reject(entry, node, fmt::format("{}.scene: the scene cannot be read", path));
            entry.problem += reading.report();
            return false;
        }
        entry.scene = std::move(*reading.scene);
        return true;
    }

    // The output replaces those of the scene.
    bool read_output_of(const Node& node, const std::string& path, const std::string& scene_name, Baseline& entry) {
        entry.scene.name = entry.name;
        if (const Member* type = node.find("type"); type && type->value.text == "sweep") {
            entry.is_sweep = true;
            entry.scene.set_outputs({});
            if (node.members.size() > 1)
                return reject(
                    entry, node,
                    fmt::format("{}: the \"sweep\" of the scene describes the sweep; remove the other keys", path));
            if (!entry.scene.sweep) return reject(entry, node, fmt::format("{}: the scene has no \"sweep\"", path));
            return true;
        }
        using enum PictureOutput::Kind;
        std::vector<Message> messages;
        const bool fine = read_only_output(node, scene_name, path + ".", entry.scene, messages);
        for (const Message& message : messages)
            if (message.fatal) entry.problem += describe({all_.source}, message);
        if (!fine) return false;
        if (picture_of(entry.output(), video)) {
            return reject(
                entry, node,
                fmt::format("{}: films are compared before they are encoded; write \"type\": \"frames\"", path));
        }
        if (const auto* pictures = std::get_if<PictureOutput>(&entry.output()); pictures && pictures->is_document())
            return reject(entry, node, fmt::format("{}: this type has no pictures; write \"type\": \"frames\"", path));
        if (const PictureOutput* sequence = picture_of(entry.output(), frames)) {
            const double last = sequence->span.to.value_or(entry.scene.end_time);
            if ((last - sequence->span.from) * sequence->span.fps.value() > kMostPictures) {
                return reject(
                    entry, node,
                    fmt::format("{}: more than {} pictures; use \"from\" and \"to\", or fewer frames a second", path,
                                kMostPictures));
            }
        }
        return true;
    }

    static Tolerances defaults_for(const Baseline& entry) {
        bool lit = false;
        if (const auto* picture = entry.picture()) lit = picture->view.style != render::Style::flat;
        // Flat views have the same pixels on all machines with the same libraries; those of OpenGL differ by a level or
        // two between processors. The tolerances of motion and impacts lie between the effect of another tolerance of
        // the solver up to the horizon (7e-6, 5e-5) and the effect of 0.1 % contact stiffness in one impact (1e-4,
        // 5e-4).
        return {{lit ? 2 : 0, 0.0, {}, 2e-5, 1e-4}, {}};
    }

    std::string path_;
    Baselines all_;
    Tolerances defaults_;
    Diagnostics diagnostics_;
    std::vector<Message> messages_;
};

}  // namespace

bool Baseline::has_pictures() const { return !file.empty() || !(is_sweep || is_data(output())); }

const Picture* Baseline::picture() const {
    if (!file.empty() || is_sweep) return nullptr;
    const PictureOutput* still = picture_of(output(), PictureOutput::Kind::still);
    return still ? still : picture_of(output(), PictureOutput::Kind::frames);
}

bool Baseline::is_of_first_renderer(long frame, const std::string& sha256) const {
    const std::vector<std::string>& first = accepted.front().sha256;
    return std::cmp_less(frame, first.size()) && first[static_cast<std::size_t>(frame)] == sha256;
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
