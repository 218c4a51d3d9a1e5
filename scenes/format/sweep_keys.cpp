#include "scenes/format/sweep_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/files/numbers.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::SampleKind;

// More turns than any integration reaches.
static constexpr sim::Range kTurns{0, 1e9, false, false, nullptr};

static void visit(SceneVisitor& v, sim::CamSpan& span) {
    v.number(sim::written_if(!span.time, "cam_turns"), span.turns, sim::kPlainNumber, kTurns,
             "Turns of the cam; of a cam at rest, seconds.");
    v.number("time", span.time, dim::kTime, sim::kNotNegative, "Time, rounded up to whole turns of the cam.");
    v.exclusive("cam_turns", "time");
}

// The dimension of the scene's key; none where it is refused anyway.
static sim::Dimension dimension_of(const std::string& key, const ObjectReader& r) {
    const auto known = sim::number_key(r.context().scene.problem, key);
    return known ? known->dimension : dim::kNone;
}

// A value of another key, in its units.
template <class Number>  // double, or optional<double>
static ValueFormat value_format(Number& value, const std::string& of) {
    const auto read = [&value, &of](ObjectReader& r, const Node& node, const std::string& key) {
        double given = 0;
        if (r.number_value(node, key, dimension_of(of, r), given)) value = given;
    };
    return {"number, or text with the unit of the key", R"({"anyOf": [{"type": "number"}, {"type": "string"}]})", read,
            [&value] {
                const std::optional<double> given = value;
                return given ? std::optional(number_node(*given)) : std::nullopt;
            }};
}

static ValueFormat values_format(std::vector<double>& values, const std::string& of) {
    const auto read = [&values, &of](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::array || node.items.empty())
            return r.fail(node, key,
                          fmt::format("{} must be a list of numbers, not {}", r.path(key), as_written(node)));
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            double given = 0;
            if (r.number_value(node.items[i], fmt::format("{}.{}", key, i), dimension_of(of, r), given))
                values.push_back(given);
        }
    };
    const auto write = [&values]() -> std::optional<Node> {
        if (values.empty()) return std::nullopt;
        Node all = array_node();
        for (const double value : values) all.items.push_back(number_node(value));
        return all;
    };
    return {"list of numbers, or texts with the unit of the key",
            R"({"type": "array", "minItems": 1, "items": {"anyOf": [{"type": "number"}, {"type": "string"}]}})", read,
            write};
}

static void visit(SceneVisitor& v, RandomKey& key) {
    v.text(sim::required("key", "\"initial.angle\""), key.key, "A key of the scene that is a number.");
    v.value("from", value_format(key.from, key.key), "Lowest value.");
    v.value("to", value_format(key.to, key.key), "Highest value.");
}

static void visit(SceneVisitor& v, SweptKey& over) {
    v.text(sim::required("key", "\"cam.speed\""), over.key, "A key of the scene that is a number.");
    v.value("from", value_format(over.from, over.key), "First value.");
    v.value("to", value_format(over.to, over.key), "Last value.");
    v.integer("count", over.count, 1, 100'000'000, "How many values, both ends included.");
    v.choice("spacing", over.logarithmic, {{false, "linear"}, {true, "log"}}, "Of the values between the ends.");
    v.value("values", values_format(over.values, over.key), "The values themselves.");
    v.text(sim::written_if(!over.file.empty(), "file"), over.file, "A .csv or .npz file with the values.");
    v.text(sim::written_if(!over.column.empty(), "column"), over.column, "Its column.");
    v.exclusive("from", "values");
    v.exclusive("from", "file");
    v.exclusive("values", "file");
}

namespace {

constexpr sim::Named<SeedKind> kSeedKinds[] = {{SeedKind::same, "same"},
                                               {SeedKind::carry_up, "carry-up"},
                                               {SeedKind::carry_down, "carry-down"},
                                               {SeedKind::random, "random"}};
constexpr int kMostRandom = 1'000'000;
std::string quantity(std::string_view text, double& out) {
    const QuantityText read = parse_quantity(text);
    if (!read.quantity) return read.problem;
    out = read.quantity->value;
    return "";
}

std::string set_section(std::string_view channel, sim::Sampling& sampling, const sim::Problem& problem) {
    std::vector<std::string> known;
    for (const sim::Channel& each : all_channels(problem)) known.push_back(name(each));
    if (std::ranges::find(known, channel) == known.end())
        return fmt::format("{} is not a channel of this scene{}", in_quotes(channel),
                           suggestion_or_list(std::string(channel), known));
    sampling.channel = *sim::channel_named(channel);
    sampling.kind = sampling.channel.kind == sim::ChannelKind::cam_angle ? SampleKind::section : SampleKind::crossings;
    return "";
}

ValueFormat sample_format(sim::Sampling& sampling) {
    const auto read = [&sampling](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind == Node::Kind::string && node.text == "impacts")
            sampling.kind = SampleKind::impacts;
        else if (node.kind == Node::Kind::string && node.text == "apexes")
            sampling.kind = SampleKind::apexes;
        else
            r.fail(node, key,
                   fmt::format("{} must be \"impacts\", \"apexes\" or {{\"section\": CHANNEL, \"at\": VALUE}}, not {}",
                               r.path(key), as_written(node)));
    };
    const auto write = [&sampling]() -> std::optional<Node> {
        if (sampling.kind == SampleKind::impacts) return text_node("impacts");
        if (sampling.kind == SampleKind::apexes) return text_node("apexes");
        return std::nullopt;
    };
    return {"\"impacts\", \"apexes\" or object", R"({"enum": ["impacts", "apexes"]})", read, write};
}

void visit_section(SceneVisitor& v, sim::Sampling& sampling) {
    std::string channel = sampling.kind == SampleKind::crossings ? name(sampling.channel) : "cam_angle";
    v.text(sim::required("section", "\"cam_angle\""), channel,
           "The channel; cam_angle takes one sample a turn of the cam.");
    v.number("at", sampling.level, sim::kPlainNumber, sim::kAny, "Its value, in the channel's SI unit.");
    v.choice("direction", sampling.rising, {{true, "rising"}, {false, "falling"}},
             "Which way it passes; a cam angle passes one way.");
    v.check([&sampling, channel](ObjectReader& r) {
        const std::string problem = set_section(channel, sampling, r.context().scene.problem);
        if (!problem.empty()) r.fail(r.place("section"), "section", fmt::format("{}: {}", r.path("section"), problem));
    });
}

ValueFormat seed_format(SweepSeeds& seeds) {
    const auto one = [&seeds](ObjectReader& r, const Node& node, const std::string& key) {
        const auto found = std::ranges::find_if(kSeedKinds, [&](const auto& k) { return node.text == k.name; });
        if (node.kind != Node::Kind::string || found == std::end(kSeedKinds) || found->value == SeedKind::random)
            return r.fail(node, key,
                          fmt::format("{} must be \"same\", \"carry-up\" or \"carry-down\", not {}", r.path(key),
                                      as_written(node)));
        seeds.kinds.push_back(found->value);
    };
    const auto read = [&seeds, one](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind == Node::Kind::string) {  // as after --seed
            if (const std::string problem = parse_seeds(node.text, seeds); !problem.empty())
                r.fail(node, key, fmt::format("{}: {}, not {}", r.path(key), problem, as_written(node)));
            return;
        }
        seeds.kinds.clear();
        if (node.kind != Node::Kind::array) return one(r, node, key);
        for (std::size_t i = 0; i < node.items.size(); ++i) one(r, node.items[i], fmt::format("{}.{}", key, i));
    };
    const auto write = [&seeds]() -> std::optional<Node> {
        if (seeds.random > 0) return std::nullopt;
        if (seeds.kinds.size() == 1) return text_node(name(seeds.kinds.front()));
        Node all = array_node();
        for (const SeedKind kind : seeds.kinds) all.items.push_back(text_node(name(kind)));
        return all;
    };
    return {"\"same\", \"carry-up\", \"carry-down\", several of them, \"random:N\", or object",
            R"({"anyOf": [{"enum": ["same", "carry-up", "carry-down", "carry-up,carry-down"]}, )"
            R"({"type": "string", "pattern": "^random:[1-9][0-9]*$"}, {"type": "array", "minItems": 1, )"
            R"("uniqueItems": true, "items": {"enum": ["same", "carry-up", "carry-down"]}}]})",
            read, write};
}

void visit_random(SceneVisitor& v, SweepSeeds& seeds) {
    v.integer(sim::required("random", "8"), seeds.random, 1, kMostRandom,
              "So many motions from random starts at each point.");
    List keys = SceneVisitor::items_of(seeds.keys);
    keys.of = "keys";
    v.list(
        "key", keys,
        "What is random. None: initial.angle, from the scene's to 0.3 rad more, and initial.angular_velocity, from -1 "
        "to 1 rad/s.");
    v.check([&seeds](ObjectReader&) { seeds.kinds = {SeedKind::random}; });
}

bool is_random(const SweepSeeds& seeds) {
    return std::ranges::find(seeds.kinds, SeedKind::random) != seeds.kinds.end();
}

}  // namespace

const char* name(SeedKind kind) { return kSeedKinds[static_cast<std::size_t>(kind)].name; }

void visit(SceneVisitor& v, Sweep& sweep) {
    List over = SceneVisitor::items_of(sweep.over);
    over.least = 1, over.most = 2, over.of = "keys";
    over.example = "[{\"key\": \"cam.speed\", \"from\": 40, \"to\": 52, \"count\": 601}]";
    v.list(sim::required("over", over.example), over, "What varies: one key, or two as a grid.");
    v.value_or_object(
        "sample", sample_format(sweep.sampling),
        [&](sim::Visitor& inside) { visit_section(static_cast<SceneVisitor&>(inside), sweep.sampling); },
        "What is kept of each motion: its state at impacts, at apexes, or where a channel passes a value.");
    v.object("transient", sweep.sampling.transient, "What passes before samples are kept.");
    v.object("keep", sweep.sampling.keep, "How long samples are kept.");
    v.value_or_object(
        "seed", seed_format(sweep.seeds),
        [&](sim::Visitor& inside) { visit_random(static_cast<SceneVisitor&>(inside), sweep.seeds); },
        "Where each motion starts: as the scene says, from where that of the value before ended (upwards, downwards), "
        "or at random.");
    v.check([&sweep](ObjectReader& r) {
        for (const SweepProblem& problem : problems_of(sweep, r.context().scene.problem))
            if (!r.diagnostics().failed(r.path(problem.key)))  // told already
                r.fail(r.place("over"), problem.key, fmt::format("{}: {}", r.path(problem.key), problem.text));
    });
}

std::string parse_sample(std::string_view text, const sim::Problem& problem, sim::Sampling& sampling) {
    if (text == "impacts" || text == "apexes" || text == "apex") {
        sampling.kind = text == "impacts" ? SampleKind::impacts : SampleKind::apexes;
        return "";
    }
    constexpr std::string_view kSection = "section:";
    const std::size_t equals = text.find('=');
    if (!text.starts_with(kSection) || equals == std::string_view::npos)
        return "choose impacts, apexes, or section:CHANNEL=VALUE, for example section:cam_angle=0";
    std::string_view value = text.substr(equals + 1);
    if (const std::size_t colon = value.find(':'); colon != std::string_view::npos) {
        const std::string_view direction = value.substr(colon + 1);
        if (direction != "rising" && direction != "falling") return "a channel passes its value rising or falling";
        sampling.rising = direction == "rising";
        value = value.substr(0, colon);
    }
    if (std::string problem_with_value = quantity(value, sampling.level); !problem_with_value.empty())
        return problem_with_value;
    return set_section(text.substr(kSection.size(), equals - kSection.size()), sampling, problem);
}

std::string parse_seeds(std::string_view text, SweepSeeds& seeds) {
    constexpr std::string_view kRandom = "random:";
    SweepSeeds read;
    read.keys = seeds.keys;
    read.kinds.clear();
    if (text.starts_with(kRandom)) {
        const auto count = output::number_in<int>(text.substr(kRandom.size()));
        if (!count || *count < 1 || *count > kMostRandom) return "write random:N with a number of motions";
        read.kinds = {SeedKind::random};
        read.random = *count;
    }
    for (std::size_t from = 0; read.random == 0 && from <= text.size();) {
        const std::size_t to = std::min(text.find(',', from), text.size());
        const auto found =
            std::ranges::find_if(kSeedKinds, [&](const auto& k) { return text.substr(from, to - from) == k.name; });
        if (found == std::end(kSeedKinds) || found->value == SeedKind::random)
            return "choose same, carry-up, carry-down, carry-up,carry-down, or random:N";
        read.kinds.push_back(found->value);
        from = to + 1;
    }
    seeds = std::move(read);
    return "";
}

std::vector<SweepProblem> problems_of(const Sweep& sweep, const sim::Problem& problem) {
    std::vector<SweepProblem> all;
    std::vector<std::string> known;
    for (const sim::NumberKey& key : sim::number_keys(problem)) known.push_back(key.path);
    const auto need_key = [&](const std::string& at, const std::string& key) {
        if (std::ranges::find(known, key) == known.end())
            all.push_back(
                {at, fmt::format("{} is no number of this scene{}", in_quotes(key), suggestion_or_list(key, known))});
    };
    if (sweep.over.empty()) all.push_back({"over", "say what varies, for example cam.speed=40:52:0.02"});
    if (sweep.over.size() > 2) all.push_back({"over", "a sweep varies one key, or two"});
    if (sweep.over.size() == 2 && sweep.over[0].key == sweep.over[1].key)
        all.push_back({"over.1.key", fmt::format("{} stands twice", sweep.over[0].key)});
    for (std::size_t i = 0; i < sweep.over.size(); ++i) {
        const SweptKey& over = sweep.over[i];
        const std::string at = fmt::format("over.{}", i);
        need_key(at + ".key", over.key);
        const bool ranged = over.from && over.to && over.count;
        const int ways = int(over.from || over.to || over.count) + int(!over.values.empty()) + int(!over.file.empty());
        if (ways != 1 || (over.from && !ranged) || (over.to && !ranged) || (over.count && !ranged))
            all.push_back({at, "give from, to and count, or values, or file and column"});
        else if (ranged && *over.count == 1 && *over.from != *over.to)
            all.push_back({at + ".count", "one value, but two ends; give at least 2, or one end"});
        else if (ranged && over.logarithmic && !(*over.from * *over.to > 0))
            all.push_back({at, "logarithmic spacing needs ends of one sign, neither of them 0"});
        if (over.file.empty() != over.column.empty()) all.push_back({at, "file and column belong together"});
    }
    const bool carries = std::ranges::any_of(
        sweep.seeds.kinds, [](SeedKind kind) { return kind == SeedKind::carry_up || kind == SeedKind::carry_down; });
    for (const SweptKey& over : sweep.over)
        if (carries && over.key.starts_with("initial."))
            all.push_back({"seed", fmt::format("a carried motion does not begin at {}; use \"same\"", over.key)});
    for (const RandomKey& key : sweep.seeds.keys) need_key("seed.key", key.key);
    if (!sweep.seeds.keys.empty() && !is_random(sweep.seeds))
        all.push_back({"seed.key", "only random starts have random keys"});
    const sim::CamSpan& keep = sweep.sampling.keep;
    if (!(keep.time.value_or(keep.turns) > 0)) all.push_back({"keep", "at least one turn of the cam must be kept"});
    if (!problem.cam && (sweep.sampling.kind == SampleKind::impacts || sweep.sampling.kind == SampleKind::section))
        all.push_back({"sample", "there is no cam"});
    return all;
}

}  // namespace beamcam::scenes
