#include "scenes/format/sweep_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/format/keys.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::SampleKind;

static constexpr int kMostValues = 100'000'000, kMostRandom = 1'000'000;
// More turns than an integration can reach.
static constexpr sim::Range kTurns{0, 1e9, false, false, nullptr};

static void visit(SceneVisitor& v, sim::CamSpan& span) {
    v.number(sim::written_if(!span.time, "cam_turns"), span.turns, sim::kPlainNumber, kTurns,
             "Turns of the cam; seconds if the cam is at rest.");
    v.number("time", span.time, dim::kTime, sim::kNotNegative, "Time, rounded up to whole turns of the cam.");
    v.exclusive("cam_turns", "time");
}

static DimensionOf dimension_of(const std::string& key) {
    return [&key](const ObjectReader& r) -> std::optional<sim::Dimension> {
        const auto known = sim::number_key(r.context().scene.problem, key);
        return known ? std::optional(known->dimension) : std::nullopt;
    };
}

static void visit(SceneVisitor& v, RandomKey& key) {
    v.text(sim::required("key", "\"initial.angle\""), key.key, "A key of the scene that is a number.");
    v.value("from", quantity_format(key.from, dimension_of(key.key)), "Lowest value.");
    v.value("to", quantity_format(key.to, dimension_of(key.key)), "Highest value.");
}

static void visit(SceneVisitor& v, SweptKey& over) {
    v.text(sim::required("key", "\"cam.speed\""), over.key, "A key of the scene that is a number.");
    v.value("from", quantity_format(over.from, dimension_of(over.key)), "First value.");
    v.value("to", quantity_format(over.to, dimension_of(over.key)), "Last value.");
    v.integer("count", over.count, 1, kMostValues, "Number of values, both ends included.");
    v.choice("spacing", over.logarithmic, {{false, "linear"}, {true, "log"}},
             "Spacing of the values between the ends.");
    v.value("values", quantities_format(over.values, dimension_of(over.key), 1), "A list of values.");
    v.exclusive("from", "values");
}

namespace {

void set_section(ObjectReader& r, const std::string& channel, sim::Sampling& sampling) {
    const std::vector<std::string> known = channel_names(all_channels(r.context().scene.problem));
    if (std::ranges::find(known, channel) == known.end())
        return r.reject("section", ": {} is not a channel of this scene{}", in_quotes(channel),
                        suggestion_or_list(channel, known));
    sampling.channel = *sim::channel_named(channel);
    sampling.kind = sampling.channel.kind == sim::ChannelKind::cam_angle ? SampleKind::section : SampleKind::crossings;
}

void visit_section(SceneVisitor& v, sim::Sampling& sampling) {
    std::string channel = sampling.kind == SampleKind::crossings ? name(sampling.channel) : "cam_angle";
    v.text(sim::required("section", "\"cam_angle\""), channel,
           "The channel; cam_angle gives one sample in each turn of the cam.");
    v.value("at",
            quantity_format(sampling.level,
                            [&channel](const ObjectReader& r) {
                                const auto known = sim::channel_named(channel);
                                return known ? std::optional(dimension_of(*known, r.context().scene.problem))
                                             : std::nullopt;
                            }),
            "The value that the channel passes; a plain number is in its SI unit.");
    v.choice("direction", sampling.rising, {{true, "rising"}, {false, "falling"}},
             "Direction in which the channel passes the value; not used for cam_angle.");
    v.check([&sampling, channel](ObjectReader& r) { set_section(r, channel, sampling); });
}

// The object that "section:theta_dot=0:falling" abbreviates.
Node section_node(std::string_view text) {
    const std::size_t colon = text.find(':'), equals = std::min(text.find('='), text.size());
    const std::size_t end = std::min(text.find(':', equals), text.size());
    Node out = object_node({{"section", std::string(text.substr(colon + 1, equals - colon - 1))}});
    if (equals < end) add(out, "at", value_node(std::string(text.substr(equals + 1, end - equals - 1))));
    if (end < text.size()) add(out, "direction", std::string(text.substr(end + 1)));
    return out;
}

// The object or list that a text abbreviates: "random:8", "carry-up,carry-down".
Node seeds_node(std::string_view text) {
    constexpr std::string_view kRandom = "random:";
    if (text.starts_with(kRandom))
        return object_node({{"random", value_node(std::string(text.substr(kRandom.size())))}});
    return Node(split(text, ','));
}

// Reads the value that a text abbreviates, an object with these keys.
void read_abbreviated(ObjectReader& r, const Node& text, const std::string& key, Node object,
                      const std::function<void(ObjectReader&)>& visit_keys) {
    move_to(object, text.place);
    ObjectReader inside = r.inside(object, key);
    visit_keys(inside);
    inside.finish();
}

ValueFormat sample_format(sim::Sampling& sampling) {
    static constexpr sim::Named<SampleKind> kWords[] = {{SampleKind::impacts, "impacts"},
                                                        {SampleKind::apexes, "apexes"},
                                                        {SampleKind::apexes, "apex"},
                                                        {SampleKind::peaks, "peaks"}};
    const auto read = [&sampling](ObjectReader& r, const Node& node, const std::string& key) {
        if (word_in(node).starts_with("section:"))
            return read_abbreviated(r, node, key, section_node(node.text),
                                    [&](ObjectReader& inside) { visit_section(inside, sampling); });
        for (const auto& [kind, word] : kWords)
            if (word_in(node) == word) return void(sampling.kind = kind);
        r.reject_value(node, key,
                       "; write impacts, apexes, peaks, or section:CHANNEL=VALUE, for example section:cam_angle=0");
    };
    const auto write = [&sampling] {
        const auto word = std::ranges::find(kWords, sampling.kind, &sim::Named<SampleKind>::value);
        return word == std::end(kWords) ? Node() : Node(word->name);
    };
    return {
        "\"impacts\", \"apexes\", \"peaks\", \"section:CHANNEL=VALUE\" or object",
        R"({"anyOf": [{"enum": ["impacts", "apexes", "apex", "peaks"]}, {"type": "string", "pattern": "^section:.+=.+$"}]})",
        read, write};
}

void visit_random(SceneVisitor& v, SweepSeeds& seeds) {
    v.integer(sim::required("random", "8"), seeds.random, 1, kMostRandom,
              "Number of motions from random starts at each point.");
    List keys = SceneVisitor::items_of(seeds.keys);
    keys.of = "keys";
    v.list("key", keys,
           "The random keys. By default initial.angle, up to 0.3 rad above the scene's value, and "
           "initial.angular_velocity, from -1 to 1 rad/s.");
    v.check([&seeds](ObjectReader&) { seeds.kinds = {SeedKind::random}; });
}

ValueFormat seed_format(SweepSeeds& seeds) {
    const auto read = [&seeds](ObjectReader& r, const Node& node, const std::string& key) {
        const Node list = node.kind == Node::Kind::string ? seeds_node(node.text) : node;
        if (list.kind == Node::Kind::object)
            return read_abbreviated(r, node, key, list, [&](ObjectReader& inside) { visit_random(inside, seeds); });
        std::vector<SeedKind> kinds;
        for (const Node& item : list.items) {
            const auto found = std::ranges::find(kSeedKinds, word_in(item), &sim::Named<SeedKind>::name);
            if (found == std::end(kSeedKinds) || found->value == SeedKind::random) break;
            if (std::ranges::find(kinds, found->value) != kinds.end())
                return r.reject(key, ": {} is listed twice; remove one of them", item.text);
            kinds.push_back(found->value);
        }
        if (kinds.empty() || kinds.size() < list.items.size())
            return r.reject_value(node, key,
                                  "; write \"same\", \"carry-up\", \"carry-down\", several of them, or \"random:N\"");
        seeds.kinds = std::move(kinds), seeds.random = 0;
    };
    const auto write = [&seeds]() -> Node {
        if (seeds.random > 0) return {};
        if (seeds.kinds.size() == 1) return name(seeds.kinds.front());
        return array_node(seeds.kinds, [](SeedKind kind) { return name(kind); });
    };
    return {"\"same\", \"carry-up\", \"carry-down\", several of them, \"random:N\", or object",
            R"({"anyOf": [{"enum": ["same", "carry-up", "carry-down", "carry-up,carry-down"]}, )"
            R"({"type": "string", "pattern": "^random:[1-9][0-9]*$"}, {"type": "array", "minItems": 1, )"
            R"("uniqueItems": true, "items": {"enum": ["same", "carry-up", "carry-down"]}}]})",
            read, write};
}

bool is_random(const SweepSeeds& seeds) {
    return std::ranges::find(seeds.kinds, SeedKind::random) != seeds.kinds.end();
}

void check_sweep(ObjectReader& r, const Sweep& sweep) {
    const sim::Problem& problem = r.context().scene.problem;
    const auto reject = [&](const std::string& key, const std::string& why) {
        if (!r.diagnostics().failed(r.path(key))) r.reject(key, ": {}", why);  // else it has an error already
    };
    const auto need_key = [&](const std::string& at, const std::string& key) {
        if (const std::string wrong = problem_with_number_key(problem, key); !wrong.empty()) reject(at, wrong);
    };
    if (sweep.over.size() == 2 && sweep.over[0].key == sweep.over[1].key)
        reject("over.1.key", fmt::format("{} is listed twice; remove one of them", sweep.over[0].key));
    const bool carries = std::ranges::any_of(
        sweep.seeds.kinds, [](SeedKind kind) { return kind == SeedKind::carry_up || kind == SeedKind::carry_down; });
    for (std::size_t i = 0; i < sweep.over.size(); ++i) {
        const SweptKey& over = sweep.over[i];
        const std::string at = fmt::format("over.{}", i);
        need_key(at + ".key", over.key);
        const bool ranged = over.from && over.to && over.count;
        const bool partly = over.from || over.to || over.count;
        if (partly == !over.values.empty() || (partly && !ranged))
            reject(at, "write from, to and count, or values");
        else if (ranged && *over.count == 1 && *over.from != *over.to)
            reject(at + ".count", "one value cannot have two ends; write at least 2, or equal ends");
        else if (ranged && over.logarithmic && !(*over.from * *over.to > 0))
            reject(at, "logarithmic spacing needs ends of one sign, neither of them 0");
        std::vector<double> values = over.values;
        if (ranged && *over.count > 1) values = {*over.from, *over.to};
        std::ranges::sort(values);
        if (std::ranges::adjacent_find(values) != values.end() && !carries && !is_random(sweep.seeds))
            reject(at + (ranged ? ".count" : ".values"), "equal values give equal motions; write each value once");
    }
    for (const SweptKey& over : sweep.over)
        if (carries && over.key.starts_with("initial."))
            reject("seed", fmt::format("a carried motion does not start at {}; use \"same\"", over.key));
    for (const RandomKey& key : sweep.seeds.keys) {
        need_key("seed.key", key.key);
        if (key.from > key.to)
            reject("seed.key", fmt::format("\"from\" of {} is greater than \"to\"; exchange them", key.key));
    }
    if (!sweep.seeds.keys.empty() && !is_random(sweep.seeds))
        reject("seed.key", "random keys need random starts; add \"random\"");
    const sim::CamSpan& keep = sweep.sampling.keep;
    if (!(keep.time.value_or(keep.turns) > 0)) reject("keep", "must be greater than 0");
    if (!problem.cam && (sweep.sampling.kind == SampleKind::impacts || sweep.sampling.kind == SampleKind::section ||
                         sweep.sampling.kind == SampleKind::peaks))
        reject("sample", "there is no cam; use \"apexes\", or add a \"cam\"");
}

}  // namespace

void visit(SceneVisitor& v, Sweep& sweep) {
    List over = SceneVisitor::items_of(sweep.over);
    over.min_size = 1, over.max_size = 2, over.of = "keys";
    over.example = "[{\"key\": \"cam.speed\", \"from\": 40, \"to\": 52, \"count\": 601}]";
    v.list(sim::required("over", over.example), over, "The keys that vary: one, or two as a grid.");
    v.value(
        "sample", sample_format(sweep.sampling),
        "The samples of each motion: its state at impacts, at apexes, or where a channel passes a value; or one, "
        "\"peaks\": the largest force, stress, gap and rebound, number and longest duration of impacts, and the share "
        "of the time without contact.",
        SceneVisitor::keys_of(sweep.sampling, visit_section));
    v.object("transient", sweep.sampling.transient, "Time before the first sample.");
    v.object("keep", sweep.sampling.keep, "Time during which samples are taken.");
    v.value("seed", seed_format(sweep.seeds),
            "Start of each motion: the scene's initial state, the end of the motion at the previous value (upwards or "
            "downwards), or a random state.",
            SceneVisitor::keys_of(sweep.seeds, visit_random));
    v.boolean("exponents", sweep.sampling.exponents,
              "Also compute the largest Lyapunov exponent of each motion. Only with it is a class \"chaotic\".");
    v.check([&sweep](ObjectReader& r) { check_sweep(r, sweep); });
}

Node sweep_tree(const Scene& scene) {
    Sweep sweep = scene.sweep.value_or(Sweep{});
    return tree_of([&sweep](SceneVisitor& v) { visit(v, sweep); });
}

std::string read_sweep(const Node& keys, Scene& scene) {
    std::vector<Message> messages;
    std::map<std::string, OtherScene> others;
    const Node root = object_node({{"sweep", keys}});
    const Source source;
    const SceneContext context{scene, root, source, others};
    Sweep sweep;
    read_object(
        root, "the options", [&sweep](ObjectReader& r) { r.object("sweep", sweep, ""); }, messages, &context);
    scene.sweep = std::move(sweep);
    const auto error = std::ranges::find_if(messages, &Message::fatal);
    return error == messages.end() ? "" : error->text;
}

std::string problem_with_number_key(const sim::Problem& problem, const std::string& key) {
    std::vector<std::string> known;
    for (const sim::NumberKey& each : sim::number_keys(problem)) known.push_back(each.path);
    if (std::ranges::find(known, key) != known.end()) return "";
    return fmt::format("{} is not a number of this scene{}", in_quotes(key), suggestion_or_list(key, known));
}

}  // namespace beamcam::scenes
