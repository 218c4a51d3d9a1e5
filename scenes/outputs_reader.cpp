// The outputs of a scene: files, sizes, spans, channels.
#include <charconv>
#include <filesystem>
#include <numeric>
#include <optional>

#include "output/video.hpp"
#include "render/figure/style.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/files.hpp"
#include "scenes/film_times.hpp"
#include "scenes/reader.hpp"
#include "scenes/sections.hpp"

namespace beamcam::scenes {
namespace {

namespace dim = dimension;

// Reasons: below 16 px nothing can be drawn, above 16384 px OpenGL's largest viewport ends.
constexpr int kSmallestSide = 16, kLargestSide = 16384;
constexpr double kSlowestFrameRate = 0.1, kFastestFrameRate = 1000;  // [Hz]: players give up long before
constexpr FrameRate kGifRate{25, 1};                                 // what a GIF has unless told otherwise
constexpr double kWidestOrbit = 1.2;      // [rad]: further round, beam and cam hide each other
constexpr double kMostRows = 20'000'000;  // 160 MB a channel

// Everything that the outputs' readers share.
struct OutputContext {
    Findings& findings;
    const Scene& scene;  // name, physics and end time are read before
    const SceneContext& file;
    std::size_t index;
    PictureContext pictures() const { return {findings, scene, file}; }
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

void read_size(Fields& f, Size& size) {
    const Node* node = f.take("size");
    if (!node) return;
    if (node->kind != Node::Kind::array || node->items.size() != 2)
        return f.fail(*node, "size",
                      fmt::format("{} must be [width, height] in pixels, not {}", f.path("size"), shown(*node)));
    Size read;
    const bool fine = f.whole_value(node->items[0], "size.0", kSmallestSide, kLargestSide, read.width) &
                      f.whole_value(node->items[1], "size.1", kSmallestSide, kLargestSide, read.height);
    if (fine) size = read;
}

// Where the solid view is seen from.
void read_orbit(Findings& findings, Fields& v, render::View& view) {
    const Node* node = v.take("camera");
    if (!node) return;
    Fields f(findings, node, v.path("camera"));
    const auto angle = [&](const char* key, double& out) {
        double value = 0;
        const Node* given = f.take(key);
        if (!given || !f.value(*given, key, dim::kAngle, value)) return;
        if (!(std::abs(value) <= kWidestOrbit))
            f.fail(*given, key,
                   fmt::format("{} = {} is outside −{} … {} rad, from where the mechanism can be seen", f.path(key),
                               shown(*given), kWidestOrbit, kWidestOrbit));
        else
            out = value;
    };
    angle("yaw", view.orbit.yaw);
    angle("pitch", view.orbit.pitch);
    angle("swing", view.orbit.swing);
    f.finish();
    if (view.style != render::Style::solid)
        findings.warning(node->place, fmt::format("{} moves in the solid view alone; \"style\": \"solid\" shows that",
                                                  v.path("camera")));
}

void read_view(Findings& findings, Fields& f, render::View& view) {
    using render::Style, render::Theme;
    f.choice<Theme>("theme", {{"light", Theme::light}, {"dark", Theme::dark}, {"print", Theme::print}}, view.theme);
    f.choice<bool>("background", {{"paper", false}, {"transparent", true}}, view.transparent);
    const Node* node = f.take("view");
    if (!node) return;
    Fields v(findings, node, f.path("view"));
    v.choice<Style>("style", {{"lit", Style::lit}, {"flat", Style::flat}, {"solid", Style::solid}}, view.style);
    using render::TraceColor;
    v.choice<TraceColor>("trace", {{"force", TraceColor::force}, {"age", TraceColor::age}}, view.trace);
    v.choice<bool>("tip_path", {{"recent", false}, {"whole", true}}, view.tip_path);
    read_orbit(findings, v, view);
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
                       fmt::format("{} = {} is outside 1 (true shape) … 1e6", v.path("exaggeration"), shown(*factor)));
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
    read_pace(context.pictures(), f, span);
    if (!fine || !f.node() || context.findings.failed("time")) return;
    if (std::string problem = problem_with_span(span, context.scene.end_time); !problem.empty())
        return context.findings.error(f.node()->place, f.path("to"), fmt::format("{}: {}", f.what(), problem));
    const double end = span.to.value_or(context.scene.end_time);
    for (std::size_t i = 0; i < span.events.size(); ++i)
        if (const Instant& at = span.events[i].at;  // a warning, so that films can be shortened
            at.kind == Instant::Kind::time && (at.t < span.from || at.t > end))
            context.findings.warning(
                f.node()->place,
                fmt::format("{} = {:g} s is no instant of a film from {:g} s to {:g} s: it is not shown",
                            f.path(fmt::format("events.{}.at", i)), at.t, span.from, end));
}

// What the codec, the container and the picture ask of each other.
void judge_format(Fields& f, const VideoOutput& video) {
    if (!f.node()) return;
    const std::string ending = std::filesystem::path(video.file).extension().string();
    const auto place = [&](const char* key) -> const Node& {
        const Member* member = f.node()->find(key);
        return member ? member->value : *f.node();
    };
    const output::Codec codec = video.encoding.codec;
    if (std::string problem = output::format_problem(ending, codec, video.view.transparent); !problem.empty())
        return f.fail(place(output::goes_into(codec, ending) ? "background" : "codec"), "codec",
                      fmt::format("{}: {}", f.what(), problem));
    if (std::string problem = output::size_problem(codec, video.size.width, video.size.height); !problem.empty())
        f.fail(place("size"), "size", fmt::format("{}: {}", f.path("size"), problem));
    if (std::string problem = output::rate_problem(codec, video.span.fps.value()); !problem.empty())
        f.fail(place("fps"), "fps", fmt::format("{}: {}", f.path("fps"), problem));
    const auto quality = output::quality_scale(codec);
    if (f.has("preset") && codec != output::Codec::h264)
        f.fail(place("preset"), "preset",
               fmt::format("{}: {} has no presets, H.264 alone has; remove it", f.path("preset"), title(codec)));
    if (f.has("crf") && !quality)
        f.fail(place("crf"), "crf",
               fmt::format("{}: {} has no crf, it keeps what its format can; remove it", f.path("crf"), title(codec)));
    else if (quality && video.encoding.crf.value_or(0) > quality->worst)
        f.fail(place("crf"), "crf",
               fmt::format("{} = {} is outside 0 … {} of {}", f.path("crf"), *video.encoding.crf, quality->worst,
                           title(codec)));
}

void read_encoding(Fields& f, VideoOutput& video) {
    using output::Codec;
    Encoding& encoding = video.encoding;
    encoding.codec =
        output::default_codec(std::filesystem::path(video.file).extension().string()).value_or(Codec::h264);
    f.choice<Codec>("codec",
                    {{"h264", Codec::h264},
                     {"vp9", Codec::vp9},
                     {"av1", Codec::av1},
                     {"prores", Codec::prores},
                     {"ffv1", Codec::ffv1},
                     {"gif", Codec::gif},
                     {"apng", Codec::apng},
                     {"webp", Codec::webp}},
                    encoding.codec);
    int crf = 0;
    if (f.whole("crf", 0, 63, crf)) encoding.crf = crf;
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
    f.choice<bool>("rate_mode", {{"constant", false}, {"variable", true}}, encoding.variable_rate);
    if (!encoding.crf)
        if (const auto quality = output::quality_scale(encoding.codec)) encoding.crf = quality->usual;
}

// A huge picture is told before it is drawn.
void announce_memory(const OutputContext& context, const Fields& f, const Picture& picture) {
    const double memory = memory_of(picture);
    if (f.node() && memory >= kMuchMemory)
        context.findings.warning(f.node()->place,
                                 fmt::format("{} of {} × {} pixels takes about {:.2g} GB of memory for each thread",
                                             f.what(), picture.size.width, picture.size.height, memory / 1e9));
}

VideoOutput read_video(const OutputContext& context, Fields& f) {
    VideoOutput video = default_film(context.scene);
    read_file(f, video.file, {".mp4", ".webm", ".mov", ".mkv", ".gif", ".apng", ".webp"}, false);
    read_size(f, video.size);
    read_view(context.findings, f, video.view);
    announce_memory(context, f, video);
    read_arrangement(context.pictures(), f, video);
    read_encoding(f, video);
    if (video.encoding.codec == output::Codec::gif) video.span.fps = kGifRate;
    if (const Node* poster = f.take("poster")) {
        Instant at;
        if (read_at(f, *poster, "poster", at)) video.span.poster = at;
    }
    read_span(context, f, video.span);
    judge_format(f, video);
    return video;
}

FramesOutput read_frames(const OutputContext& context, Fields& f) {
    FramesOutput frames;
    frames.file = context.scene.name + "-####.png";
    read_file(f, frames.file, {".png"}, true);
    read_size(f, frames.size);
    read_view(context.findings, f, frames.view);
    announce_memory(context, f, frames);
    read_arrangement(context.pictures(), f, frames);
    read_span(context, f, frames.span);
    return frames;
}

StillOutput read_still(const OutputContext& context, Fields& f) {
    StillOutput still;
    still.file = context.scene.name + ".png";
    read_file(f, still.file, {".png"}, false);
    read_size(f, still.size);
    read_view(context.findings, f, still.view);
    announce_memory(context, f, still);
    read_arrangement(context.pictures(), f, still);
    if (const Node* at = f.require("at", "\"370 ms\"")) read_at(f, *at, "at", still.at);
    return still;
}

// Reasons: narrower no label fits, wider no sheet is; below 50 dpi nothing is legible.
constexpr double kNarrowestFigure = 0.03, kWidestFigure = 1;  // [m]
constexpr double kCoarsest = 50, kFinest = 2400;              // [dpi]

void read_figure_name(const OutputContext& context, Fields& f, std::string& out) {
    const Node* node = f.require("figure", "\"free-fall\"");
    if (!node) return;
    if (node->kind != Node::Kind::string)
        return f.fail(*node, "figure",
                      fmt::format("{} must be a figure's name in quotes, not {}", f.path("figure"), shown(*node)));
    const Recipe* recipe = recipe_named(node->text);
    if (!recipe) {
        std::vector<std::string> known;
        for (const Recipe& r : recipes()) known.emplace_back(r.name);
        return f.fail(*node, "figure",
                      fmt::format("{} = {} is not a figure{}", f.path("figure"), in_quotes(node->text),
                                  suggestion_or_list(node->text, known)));
    }
    out = recipe->name;
    if (context.findings.any()) return;  // judged when the physics is known
    if (const auto refusal = refusal_of(*recipe, context.scene))
        f.fail(*node, "figure", fmt::format("{} = \"{}\": {}", f.path("figure"), recipe->name, *refusal));
}

FigureOutput read_figure(const OutputContext& context, Fields& f) {
    FigureOutput figure;
    read_figure_name(context, f, figure.figure);
    figure.file = figure.figure.empty() ? context.scene.name + ".pdf" : figure.figure + ".pdf";
    read_file(f, figure.file, {".pdf", ".svg", ".png"}, false);
    if (const Node* node = f.take("column")) {
        const std::vector<std::string> known = render::figure::column_names();
        if (node->kind == Node::Kind::string && render::figure::column_named(node->text))
            figure.column = node->text;
        else
            f.fail(*node, "column",
                   fmt::format("{} = {} is not known{}", f.path("column"), shown(*node),
                               suggestion_or_list(node->kind == Node::Kind::string ? node->text : "", known)));
    }
    double width = 0;
    if (const Node* node = f.take("width"); node && f.value(*node, "width", dim::kLength, width)) {
        if (!(width >= kNarrowestFigure && width <= kWidestFigure))
            f.fail(
                *node, "width",
                fmt::format("{} = {} is outside {:g} … {:g} mm; a plain number is in metres, \"90 mm\" says its unit",
                            f.path("width"), shown(*node), kNarrowestFigure * 1e3, kWidestFigure * 1e3));
        else
            figure.width = width;
    }
    if (const Node* node = f.take("dpi")) {
        if (node->kind != Node::Kind::number || !(node->number >= kCoarsest && node->number <= kFinest))
            f.fail(*node, "dpi",
                   fmt::format("{} = {} must be a number in {:g} … {:g}", f.path("dpi"), shown(*node), kCoarsest,
                               kFinest));
        else
            figure.dpi = node->number;
    }
    f.choice<Lang>("lang", {{"en", Lang::en}, {"zh", Lang::zh}}, figure.lang);
    return figure;
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
             {"figure", [](const OutputContext& c, Fields& g) -> Output { return read_figure(c, g); }},
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
    FileClaims claims;
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (const std::string& file : written_by(outputs[i].second)) claims.add(file, i);
    for (const auto& [later, earlier] : claims.clashes()) {
        const Node& object = *outputs[later.owner].first;
        const Member* file = object.find("file");
        findings.error(
            file ? file->value.place : object.place, fmt::format("outputs.{}.file", later.owner),
            fmt::format("outputs.{} writes {}, which outputs.{} writes too ({}); give it a \"file\" of its own",
                        later.owner, in_quotes(later.file), earlier.owner, in_quotes(earlier.file)));
    }
}

}  // namespace

void read_outputs(const SceneContext& context, Findings& findings, const Node* node, Scene& scene) {
    if (!node) return;
    if (node->kind != Node::Kind::array)
        return findings.error(node->place, "outputs",
                              fmt::format("outputs must be an array [ … ], not {}", shown(*node)));
    std::vector<std::pair<const Node*, Output>> outputs;
    for (std::size_t i = 0; i < node->items.size(); ++i)
        if (auto output = read_output({findings, scene, context, i}, node->items[i]))
            outputs.emplace_back(&node->items[i], std::move(*output));
    if (outputs.size() == node->items.size()) refuse_shared_files(findings, outputs);
    for (auto& [object, output] : outputs) {
        const LineColumn at = locate(context.source.text, object->place.offset);
        scene.output_places.push_back(object->place.source == 0
                                          ? fmt::format("{}:{}:{}", context.source.name, at.line, at.column)
                                          : context.source.name);
        scene.outputs.push_back(std::move(output));
    }
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
    if (!span.real_time()) {
        if (to > span.from) return {};  // how many frames, only the motion tells
        return fmt::format("the film ends at {:g} s and begins at {:g} s; \"to\" must be later than \"from\"", to,
                           span.from);
    }
    const double first = std::round(span.from * fps), last = std::round(to * fps);
    if (!(last > first))
        return fmt::format(
            "no frame lies between {:g} s and {:g} s at {:g} frames a second; {}", span.from, to, fps,
            to > span.from ? "let \"to\" be later, or raise \"fps\"" : "\"to\" must be later than \"from\"");
    if (last - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are more than the {:.0f} that one output can have; use \"from\" and \"to\", or fewer frames "
            "a second",
            last - first, kMostFrames);
    return {};
}

}  // namespace beamcam::scenes
