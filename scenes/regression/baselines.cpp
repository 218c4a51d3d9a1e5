#include "scenes/regression/baselines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "output/files/numbers.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/tree.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// ---- reading -------------------------------------------------------------------------------------

constexpr int kMostPictures = 10'000;  // of one entry: each has a digest in the file and a reference beside it

bool is_plain_name(std::string_view name) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
               c == '.';
    });
    return plain && !name.empty() && name.size() <= 100 && name.front() != '.';
}

bool is_digest(const Node& node) {
    return node.kind == Node::Kind::string && node.text.size() == 64 &&
           node.text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// One past the closing bracket of the object or array that opens at `begin`, or of the scalar. `plain` has no comments.
std::size_t end_of_value(std::string_view plain, std::size_t begin) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = begin; i < plain.size(); ++i) {
        const char c = plain[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"') {
                in_string = false;
                if (depth == 0) return i + 1;
            }
            continue;
        }
        if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            ++depth;
        } else if (c == '}' || c == ']') {
            if (depth == 0) return i;  // of what holds the scalar
            if (--depth == 0) return i + 1;
        } else if (depth == 0 && (c == ',' || c == ' ' || c == '\n' || c == '\t' || c == '\r')) {
            return i;
        }
    }
    return plain.size();
}

class Reader {
  public:
    explicit Reader(const std::string& path) : path_(path) { all_.source = load_source(path); }

    Baselines read() {
        Parsed parsed = parse(all_.source.text);
        if (!parsed.is_json) throw SceneError(describe({all_.source}, std::move(parsed.messages)));
        messages_ = std::move(parsed.messages);
        read_root(parsed.root);
        for (Message& message : findings_.take()) messages_.push_back(std::move(message));
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
        ObjectReader f(findings_, &root, "", "the baselines");
        std::string schema, references = path_ == "-" ? "references" : fs::path(path_).stem().string();
        f.text("$schema", schema, "Where an editor finds the schema.");
        f.text("references", references, "Folder of the references.");
        all_.references = folder() / references;
        if (const Node* node = f.take("tolerance")) read_tolerance(*node, "tolerance", defaults_);
        if (const Node* node = f.take("renderers")) read_renderers(*node);
        if (const Node* node =
                f.take(sim::required("entries", "{\"fall\": {\"scene\": \"fall.json\", \"output\": {…}}}")))
            read_entries(*node);
        f.finish();
    }

    void read_tolerance(const Node& node, const std::string& path, Tolerance& tolerance) {
        ObjectReader f(findings_, &node, path);
        f.whole("channel", tolerance.channel, 0, 255, "Of a pixel's channel, in levels.");
        f.number("share", tolerance.share, dimension::kNone, sim::between(0, 1),
                 "Of the pixels that may differ by more.");
        f.number("ssim", tolerance.ssim, dimension::kNone, sim::between(0, 1),
                 "Pictures at least so similar are equivalent.");
        f.number("motion", tolerance.motion, dimension::kNone, sim::between(0, 1), "Of a channel's range.");
        f.number("impacts", tolerance.impacts, dimension::kNone, sim::between(0, 1), "Of an impact's quantities.");
        f.finish();
    }

    void read_renderers(const Node& node) {
        ObjectReader f(findings_, &node, "renderers");
        if (!f.node()) return;
        for (const Member& member : node.members) {
            RendererParts parts;
            for (const Member& part : member.value.members) parts[part.key] = part.value.text;
            all_.renderers[member.key] = std::move(parts);
        }
    }

    void read_entries(const Node& node) {
        ObjectReader f(findings_, &node, "entries");
        if (!f.node()) return;
        if (node.members.empty()) f.fail(node, "", "entries is empty; name at least one thing to guard");
        for (const Member& member : node.members) {
            if (!is_plain_name(member.key))
                findings_.error(
                    member.key_place, "entries." + member.key,
                    fmt::format("{} names files: use letters, digits, '-', '_' and '.' only", in_quotes(member.key)));
            else
                read_entry(member);
        }
    }

    void read_entry(const Member& member) {
        const std::string path = "entries." + member.key;
        ObjectReader f(findings_, &member.value, path);
        if (!f.node()) return;
        Baseline entry;
        entry.name = member.key;
        std::vector<std::string> overrides;
        if (const Node* set = f.take("set")) read_overrides(*set, path + ".set", overrides);
        f.text("file", entry.file, "Pictures of another tool, instead of a scene.");
        f.text("expected", entry.expected, "Pictures that are expected, instead of accepted digests.");
        const bool drawn_here = entry.file.empty();
        const Node* scene = drawn_here ? f.take(sim::required("scene", "\"fall.json\"")) : nullptr;
        const Node* output =
            drawn_here ? f.take(sim::required("output", "{\"type\": \"still\", \"at\": \"0.3 s\"}")) : nullptr;
        f.truth("physics", entry.physics, "Whether the motion is compared, and no picture.");
        Tolerance own;
        if (const Node* tolerance = f.take("tolerance")) read_tolerance(*tolerance, path + ".tolerance", own);
        if (const Node* accepted = f.take("accepted")) read_accepted(*accepted, path + ".accepted", entry.accepted);
        f.number("reproducible_until", entry.reproducible_until, dimension::kTime, sim::kAny,
                 "Until when the motion is reproducible.");
        f.finish();
        for (std::string* file : {&entry.file, &entry.expected})
            if (!file->empty()) *file = beside(*file);
        if (!drawn_here) {
            entry.tolerance = Tolerance{0, 0.0, {}, {}, {}}.overridden_by(defaults_).overridden_by(own);
            all_.entries.push_back(std::move(entry));
            return;
        }
        if (!scene || !output) return;
        // What is wrong with a scene costs its own entry alone.
        if (read_scene_of(*scene, overrides, path, entry) &&
            read_output_of(*output, path + ".output", scene_file(*scene), entry))
            entry.tolerance = defaults_for(entry).overridden_by(defaults_).overridden_by(own);
        all_.entries.push_back(std::move(entry));
    }

    bool refuse(Baseline& entry, const Node& node, const std::string& text) {
        entry.problem += describe({all_.source}, Message{node.place, text});
        return false;
    }

    void read_overrides(const Node& node, const std::string& path, std::vector<std::string>& overrides) {
        const bool fine =
            node.kind == Node::Kind::array && std::all_of(node.items.begin(), node.items.end(),
                                                          [](const Node& n) { return n.kind == Node::Kind::string; });
        if (!fine)
            return findings_.error(
                node.place, path,
                fmt::format("{} must be an array of texts such as \"cam.speed=5\", not {}", path, shown(node)));
        for (const Node& item : node.items) overrides.push_back(item.text);
    }

    void read_accepted(const Node& node, const std::string& path, std::vector<Accepted>& accepted) {
        if (node.kind != Node::Kind::array)
            return findings_.error(node.place, path,
                                   fmt::format("{} must be an array [ … ], not {}", path, shown(node)));
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            ObjectReader f(findings_, &node.items[i], fmt::format("{}.{}", path, i));
            Accepted one;
            f.text("renderer", one.renderer, "What drew the accepted pictures.");
            const Node* digests = f.take(sim::required("sha256", "[\"0123…\"]"));
            f.finish();
            if (!digests) continue;
            if (digests->kind != Node::Kind::array ||
                !std::all_of(digests->items.begin(), digests->items.end(), is_digest)) {
                f.fail(*digests, "sha256",
                       fmt::format("{} must be an array of digests, 64 digits 0…9 a…f each; --update writes them",
                                   f.path("sha256")));
                continue;
            }
            for (const Node& digest : digests->items) one.sha256.push_back(digest.text);
            accepted.push_back(std::move(one));
        }
    }

    // The file that an entry's scene stands in.
    std::string scene_file(const Node& node) const {
        if (node.kind != Node::Kind::string) return all_.source.name;
        return beside(node.text);
    }
    std::string beside(const std::string& file) const {
        return fs::path(file).is_absolute() ? file : (folder() / file).string();
    }

    // A file beside this one, or a scene that stands here.
    bool read_scene_of(const Node& node, const std::vector<std::string>& overrides, const std::string& path,
                       Baseline& entry) {
        Reading reading;
        if (node.kind == Node::Kind::string) {
            try {
                reading = read_scene(load_named_source(scene_file(node)), overrides, files_);
            } catch (const UnreadableFile& error) {
                return refuse(entry, node, fmt::format("{}.scene: {}", path, error.what()));
            }
        } else if (node.kind == Node::Kind::object) {
            reading = read_scene({all_.source.name, {}, true}, node, overrides, files_);
            reading.sources.front() = all_.source;  // the places are those of the whole file
        } else {
            return refuse(entry, node,
                          fmt::format("{}.scene must be a file name or a scene {{ … }}, not {}", path, shown(node)));
        }
        if (!reading.scene) {
            refuse(entry, node, fmt::format("{}.scene: the scene cannot be read", path));
            entry.problem += reading.report();
            return false;
        }
        entry.scene = std::move(*reading.scene);
        return true;
    }

    // Of a scene that stands in this file: its first source is this file, the others are overrides.

    // The output is read as one of the scene's own, which it replaces.
    bool read_output_of(const Node& node, const std::string& path, const std::string& scene_name, Baseline& entry) {
        entry.scene.name = entry.name;
        std::vector<Message> messages;
        const bool fine = read_only_output(node, scene_name, path + ".", files_, entry.scene, messages);
        for (const Message& message : messages)
            if (message.fatal) entry.problem += describe({all_.source}, message);
        if (!fine) return false;
        if (std::holds_alternative<VideoOutput>(entry.output())) {
            return refuse(
                entry, node,
                fmt::format("{}: films are guarded before they are encoded; write \"type\": \"frames\"", path));
        }
        if (std::holds_alternative<PageOutput>(entry.output()))
            return refuse(entry, node, fmt::format("{}: a page has no pictures; write \"type\": \"frames\"", path));
        if (const auto* frames = std::get_if<FramesOutput>(&entry.output())) {
            const double last = frames->span.to.value_or(entry.scene.end_time);
            if ((last - frames->span.from) * frames->span.fps.value() > kMostPictures) {
                return refuse(
                    entry, node,
                    fmt::format("{}: more than {} pictures; use \"from\" and \"to\", or fewer frames a second", path,
                                kMostPictures));
            }
        }
        return true;
    }

    static Tolerance defaults_for(const Baseline& entry) {
        bool lit = false;
        if (const auto* still = std::get_if<StillOutput>(&entry.output()))
            lit = still->view.style != render::Style::flat;
        if (const auto* frames = std::get_if<FramesOutput>(&entry.output()))
            lit = frames->view.style != render::Style::flat;
        // Flat views are the same everywhere with the same libraries; OpenGL differs in the last levels by processor.
        // Motion and impacts: between what another tolerance of the solver changes up to the horizon (7e-6, 5e-5) and
        // what a thousandth of the contact's stiffness changes in one impact (1e-4, 5e-4).
        return {lit ? 2 : 0, 0.0, {}, 2e-5, 1e-4};
    }

    std::string path_;
    Baselines all_;
    Tolerance defaults_;
    Findings findings_;
    SceneFiles files_;
    std::vector<Message> messages_;
};

// ---- writing -------------------------------------------------------------------------------------

struct Edit {
    std::size_t begin = 0, end = 0;
    std::string text;
};

std::string json_text(std::string_view text) {
    std::string out;
    out.push_back('"');
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out.append(1, '\\').append(1, c);
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out.push_back(c);
    }
    out.push_back('"');
    return out;
}

// Replaces the value of a key, or adds the key behind the last one.
void set_member(std::string_view plain, const Node& object, const std::string& key, const std::string& value,
                const std::string& indent, std::vector<Edit>& edits) {
    if (const Member* member = object.find(key)) {
        const std::size_t begin = member->value.place.offset;
        edits.push_back({begin, end_of_value(plain, begin), value});
    } else if (object.members.empty()) {
        edits.push_back(
            {object.place.offset + 1, object.place.offset + 1, fmt::format("{}{}: {}", indent, json_text(key), value)});
    } else {
        const std::size_t at = end_of_value(plain, object.members.back().value.place.offset);
        edits.push_back({at, at, fmt::format(",{}{}: {}", indent, json_text(key), value)});
    }
}

std::string accepted_text(const std::vector<Accepted>& accepted) {
    std::string text = "[";
    for (const Accepted& one : accepted) {
        text += text.size() > 1 ? "," : "";
        text += fmt::format("\n        {{\"renderer\": {}, \"sha256\": [", json_text(one.renderer));
        if (one.sha256.size() == 1) {
            text += json_text(one.sha256.front()) + "]}";
            continue;
        }
        for (std::size_t i = 0; i < one.sha256.size(); ++i)
            text += fmt::format("{}\n          {}", i > 0 ? "," : "", json_text(one.sha256[i]));
        text += "\n        ]}";
    }
    return text + (accepted.empty() ? "]" : "\n      ]");
}

std::string renderers_text(const std::map<std::string, RendererParts>& renderers) {
    std::string text = "{";
    for (const auto& [id, parts] : renderers) {
        text += fmt::format("{}\n    {}: {{", text.size() > 1 ? "," : "", json_text(id));
        bool first = true;
        for (const auto& [part, version] : parts) {
            text += fmt::format("{}\n      {}: {}", first ? "" : ",", json_text(part), json_text(version));
            first = false;
        }
        text += "\n    }";
    }
    return text + (renderers.empty() ? "}" : "\n  }");
}

}  // namespace

Tolerance Tolerance::overridden_by(const Tolerance& over) const {
    return {over.channel ? over.channel : channel, over.share ? over.share : share, over.ssim ? over.ssim : ssim,
            over.motion ? over.motion : motion, over.impacts ? over.impacts : impacts};
}

bool Baseline::has_pictures() const { return !file.empty() || !is_data(output()); }

Baselines read_baselines(const std::string& path) { return Reader(path).read(); }

std::vector<const Baseline*> chosen_entries(const Baselines& baselines, const std::string& path,
                                            const std::vector<std::string>& patterns) {
    const auto is_meant = [](const Baseline& entry, const std::string& pattern) {
        return fnmatch(pattern.c_str(), entry.name.c_str(), 0) == 0;
    };
    std::vector<std::string> known;
    for (const Baseline& entry : baselines.entries) known.push_back(entry.name);
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(baselines.entries, [&](const auto& entry) { return is_meant(entry, pattern); }))
            throw UsageError(
                fmt::format("{} has no entry {}{}", path, in_quotes(pattern), suggestion_or_list(pattern, known)));
    std::vector<const Baseline*> chosen;
    for (const Baseline& entry : baselines.entries)
        if (patterns.empty() ||
            std::ranges::any_of(patterns, [&](const auto& pattern) { return is_meant(entry, pattern); }))
            chosen.push_back(&entry);
    return chosen;
}

void apply_tolerance(Tolerance& tolerance, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const auto number = output::number_in<double>(equals == std::string::npos ? "" : text.substr(equals + 1));
    if (!number)
        throw UsageError(
            fmt::format("--tolerance {}: write channel=2, share=1e-4, ssim=0.98, motion=1e-5 or impacts=1e-4", text));
    const double value = *number;
    if (key == "channel") {
        if (!(value >= 0 && value <= 255 && value == static_cast<int>(value)))
            throw UsageError(fmt::format("--tolerance {}: a channel differs by 0 … 255", text));
        tolerance.channel = static_cast<int>(value);
        return;
    }
    if (!(value >= 0 && value <= 1)) throw UsageError(fmt::format("--tolerance {}: must lie in 0 … 1", text));
    if (key == "share")
        tolerance.share = value;
    else if (key == "ssim")
        tolerance.ssim = value;
    else if (key == "motion")
        tolerance.motion = value;
    else if (key == "impacts")
        tolerance.impacts = value;
    else
        throw UsageError(fmt::format("--tolerance {}: unknown tolerance {}{}", text, in_quotes(key),
                                     suggestion_or_list(key, {"channel", "share", "ssim", "motion", "impacts"})));
}

std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& changes,
                   const std::map<std::string, RendererParts>& renderers) {
    const std::string& text = baselines.source.text;
    const std::string plain = blank_comments(text);  // the same offsets
    const Parsed parsed = parse(text);
    const Node& entries = parsed.root.find("entries")->value;
    std::vector<Edit> edits;
    std::set<std::string> used;
    for (const Baseline& entry : baselines.entries) {
        const auto change =
            std::find_if(changes.begin(), changes.end(), [&](const BaselineEdit& c) { return c.name == entry.name; });
        for (const Accepted& one : change == changes.end() ? entry.accepted : change->accepted)
            used.insert(one.renderer);
        if (change == changes.end()) continue;
        const Node& object = entries.find(entry.name)->value;
        if (entry.has_pictures() && entry.expected.empty())
            set_member(plain, object, "accepted", accepted_text(change->accepted), "\n      ", edits);
        if (change->reproducible_until) {
            std::string number;
            output::append_number(number, *change->reproducible_until);
            set_member(plain, object, "reproducible_until", number, "\n      ", edits);
        }
    }
    std::map<std::string, RendererParts> listed;
    for (const std::string& id : used)
        if (const auto found = renderers.find(id); found != renderers.end())
            listed[id] = found->second;
        else if (const auto known = baselines.renderers.find(id); known != baselines.renderers.end())
            listed[id] = known->second;
    if (!listed.empty() || !baselines.renderers.empty())
        set_member(plain, parsed.root, "renderers", renderers_text(listed), "\n  ", edits);

    std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin > b.begin; });
    std::string result = text;
    for (const Edit& edit : edits) result.replace(edit.begin, edit.end - edit.begin, edit.text);
    return result;
}

}  // namespace beamcam::scenes
