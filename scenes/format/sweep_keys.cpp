#include "scenes/format/sweep_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/files/numbers.hpp"
#include "scenes/format/file_column.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"
#include "sim/orbit/exponents.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::SampleKind;

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
    v.integer("count", over.count, 1, 100'000'000, "Number of values, both ends included.");
    v.choice("spacing", over.logarithmic, {{false, "linear"}, {true, "log"}},
             "Spacing of the values between the ends.");
    v.value("values", quantities_format(over.values, dimension_of(over.key), 1), "A list of values.");
    v.text(sim::written_if(!over.file.empty(), "file"), over.file,
           "A .csv or .npz file with the values; its path is relative to the scene's folder.");
    v.text(sim::written_if(!over.column.empty(), "column"), over.column, "The column of the file.");
    v.exclusive("from", "values");
    v.exclusive("from", "file");
    v.exclusive("values", "file");
    v.check([&over](ObjectReader& r) {
        if (over.file.empty() || over.column.empty() || r.diagnostics().failed(r.path("file"))) return;
        const std::filesystem::path folder = std::filesystem::path(r.context().source.name).parent_path();
        r.reject_if("file", read_column(over, folder, r.context().scene.problem));
    });
}

namespace {

constexpr int kMostRandom = 1'000'000;
std::string set_section(std::string_view channel, sim::Sampling& sampling, const sim::Problem& problem) {
    const std::vector<std::string> known = channel_names(all_channels(problem));
    if (std::ranges::find(known, channel) == known.end())
        return fmt::format("{} is not a channel of this scene{}", in_quotes(channel),
                           suggestion_or_list(channel, known));
    sampling.channel = *sim::channel_named(channel);
    sampling.kind = sampling.channel.kind == sim::ChannelKind::cam_angle ? SampleKind::section : SampleKind::crossings;
    return "";
}

ValueFormat sample_format(sim::Sampling& sampling) {
    const auto read = [&sampling](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::string)
            return r.expect(node, key, "\"impacts\", \"apexes\", \"peaks\" or {{\"section\": CHANNEL, \"at\": VALUE}}");
        if (const std::string problem = parse_sample(node.text, r.context().scene.problem, sampling); !problem.empty())
            r.reject_value(node, key, ": {}", problem);
    };
    const auto write = [&sampling] {
        const bool is_word = sampling.kind == SampleKind::impacts || sampling.kind == SampleKind::apexes ||
                             sampling.kind == SampleKind::peaks;
        return is_word ? Node(text_of_sample(sampling)) : Node();
    };
    return {
        "\"impacts\", \"apexes\", \"peaks\", \"section:CHANNEL=VALUE\" or object",
        R"({"anyOf": [{"enum": ["impacts", "apexes", "apex", "peaks"]}, {"type": "string", "pattern": "^section:.+=.+$"}]})",
        read, write};
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
    v.check([&sampling, channel](ObjectReader& r) {
        r.reject_if("section", set_section(channel, sampling, r.context().scene.problem));
    });
}

ValueFormat seed_format(SweepSeeds& seeds) {
    const auto read = [&seeds](ObjectReader& r, const Node& node, const std::string& key) {
        std::string text = node.text;  // in the notation of --seed
        for (const Node& item : node.items) text += (text.empty() ? "" : ",") + item.text;
        const bool is_list = node.kind == Node::Kind::array && !text.starts_with("random");
        const std::string problem = node.kind == Node::Kind::string || is_list
                                        ? parse_seeds(text, seeds)
                                        : "write \"same\", \"carry-up\", \"carry-down\" or \"random:N\"";
        if (!problem.empty()) r.reject_value(node, key, ": {}", problem);
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

bool is_random(const SweepSeeds& seeds) {
    return std::ranges::find(seeds.kinds, SeedKind::random) != seeds.kinds.end();
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
    v.check([&sweep](ObjectReader& r) {
        for (const SweepProblem& problem : problems_of(sweep, r.context().scene.problem))
            if (!r.diagnostics().failed(r.path(problem.key)))  // else it has an error already
                r.reject(problem.key, ": {}", problem.text);
    });
}

std::string parse_sample(std::string_view text, const sim::Problem& problem, sim::Sampling& sampling) {
    if (text == "impacts" || text == "apexes" || text == "apex") {
        sampling.kind = text == "impacts" ? SampleKind::impacts : SampleKind::apexes;
        return "";
    }
    if (text == "peaks") {
        sampling.kind = SampleKind::peaks;
        return "";
    }
    constexpr std::string_view kSection = "section:";
    const std::size_t equals = text.find('=');
    if (!text.starts_with(kSection) || equals == std::string_view::npos)
        return "write impacts, apexes, peaks, or section:CHANNEL=VALUE, for example section:cam_angle=0";
    std::string_view value = text.substr(equals + 1);
    if (const std::size_t colon = value.find(':'); colon != std::string_view::npos) {
        const std::string_view direction = value.substr(colon + 1);
        if (direction != "rising" && direction != "falling")
            return "the direction after the second colon is rising or falling";
        sampling.rising = direction == "rising";
        value = value.substr(0, colon);
    }
    std::string wrong = set_section(text.substr(kSection.size(), equals - kSection.size()), sampling, problem);
    if (!wrong.empty()) return wrong;
    const Dimension expected = dimension_of(sampling.channel, problem);
    const QuantityText level = parse_quantity(value, &expected);
    if (!level.quantity) return level.problem;
    if (!same(level.quantity->dimension, expected) && !same(level.quantity->dimension, dimension::kNone))
        return fmt::format("{} is no value of {}, whose unit is {}", in_quotes(value), name(sampling.channel),
                           si_unit(expected));
    sampling.level = level.quantity->value;
    return "";
}

std::string parse_seeds(std::string_view text, SweepSeeds& seeds) {
    constexpr std::string_view kRandom = "random:";
    SweepSeeds read;
    read.keys = seeds.keys;
    read.kinds.clear();
    if (text.starts_with(kRandom)) {
        const auto count = output::number_in<int>(text.substr(kRandom.size()));
        if (!count || *count < 1 || *count > kMostRandom)
            return fmt::format("write random:N with a number of motions from 1 to {}", kMostRandom);
        read.kinds = {SeedKind::random};
        read.random = *count;
    }
    for (const std::string& word : read.random > 0 ? std::vector<std::string>() : split(text, ',')) {
        const auto found = std::ranges::find(kSeedKinds, word, &sim::Named<SeedKind>::name);
        if (found == std::end(kSeedKinds) || found->value == SeedKind::random)
            return "write same, carry-up, carry-down, carry-up,carry-down, or random:N";
        if (std::ranges::find(read.kinds, found->value) != read.kinds.end())
            return fmt::format("{} is listed twice; remove one of them", word);
        read.kinds.push_back(found->value);
    }
    seeds = std::move(read);
    return "";
}

std::string read_column(SweptKey& over, const std::filesystem::path& folder, const sim::Problem& problem) {
    const auto key = sim::number_key(problem, over.key);
    FileColumn read = read_file_column(folder / over.file, over.column, key ? key->dimension : dim::kNone, true);
    if (!read.problem.empty()) return read.problem;
    over.values = std::move(read.values);
    over.file.clear();
    over.column.clear();
    return "";
}

std::string problem_with_number_key(const sim::Problem& problem, const std::string& key) {
    std::vector<std::string> known;
    for (const sim::NumberKey& each : sim::number_keys(problem)) known.push_back(each.path);
    if (std::ranges::find(known, key) != known.end()) return "";
    return fmt::format("{} is not a number of this scene{}", in_quotes(key), suggestion_or_list(key, known));
}

std::vector<SweepProblem> problems_of(const Sweep& sweep, const sim::Problem& problem) {
    std::vector<SweepProblem> all;
    const auto need_key = [&](const std::string& at, const std::string& key) {
        if (std::string wrong = problem_with_number_key(problem, key); !wrong.empty())
            all.push_back({at, std::move(wrong)});
    };
    if (sweep.over.empty()) all.push_back({"over", "no key varies; write for example cam.speed=40:52:0.02"});
    if (sweep.over.size() > 2) all.push_back({"over", "a sweep varies one or two keys"});
    if (sweep.over.size() == 2 && sweep.over[0].key == sweep.over[1].key)
        all.push_back({"over.1.key", fmt::format("{} is listed twice; remove one of them", sweep.over[0].key)});
    for (std::size_t i = 0; i < sweep.over.size(); ++i) {
        const SweptKey& over = sweep.over[i];
        const std::string at = fmt::format("over.{}", i);
        need_key(at + ".key", over.key);
        const bool ranged = over.from && over.to && over.count;
        const int ways = int(over.from || over.to || over.count) + int(!over.values.empty()) + int(!over.file.empty());
        if (ways != 1 || (over.from && !ranged) || (over.to && !ranged) || (over.count && !ranged))
            all.push_back({at, "write from, to and count; or values; or file and column"});
        else if (ranged && *over.count == 1 && *over.from != *over.to)
            all.push_back({at + ".count", "one value cannot have two ends; write at least 2, or equal ends"});
        else if (ranged && over.logarithmic && !(*over.from * *over.to > 0))
            all.push_back({at, "logarithmic spacing needs ends of one sign, neither of them 0"});
        if (over.file.empty() != over.column.empty()) all.push_back({at, "file and column must be given together"});
    }
    const bool carries = std::ranges::any_of(
        sweep.seeds.kinds, [](SeedKind kind) { return kind == SeedKind::carry_up || kind == SeedKind::carry_down; });
    for (const SweptKey& over : sweep.over)
        if (carries && over.key.starts_with("initial."))
            all.push_back({"seed", fmt::format("a carried motion does not start at {}; use \"same\"", over.key)});
    for (const RandomKey& key : sweep.seeds.keys) {
        need_key("seed.key", key.key);
        if (key.from > key.to)
            all.push_back({"seed.key", fmt::format("\"from\" of {} is greater than \"to\"; exchange them", key.key)});
    }
    if (!sweep.seeds.keys.empty() && !is_random(sweep.seeds))
        all.push_back({"seed.key", "random keys need random starts; add \"random\""});
    const sim::CamSpan& keep = sweep.sampling.keep;
    if (!(keep.time.value_or(keep.turns) > 0)) all.push_back({"keep", "must be greater than 0"});
    if (!problem.cam && (sweep.sampling.kind == SampleKind::impacts || sweep.sampling.kind == SampleKind::section ||
                         sweep.sampling.kind == SampleKind::peaks))
        all.push_back({"sample", "there is no cam; use \"apexes\", or add a \"cam\""});
    if (const auto refusal = sweep.sampling.exponents ? sim::tangent_refusal(problem) : std::nullopt)
        all.push_back({"exponents", *refusal});
    return all;
}

}  // namespace beamcam::scenes
