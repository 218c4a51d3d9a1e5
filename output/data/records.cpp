#include "output/data/records.hpp"

#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <type_traits>

#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {

namespace {

using Json = nlohmann::ordered_json;

// Messages may quote bytes of the user that are not UTF-8; they become U+FFFD.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

// A value of any member below; absent values, NaN and infinities are null.
template <typename T>
Json json_of(const T& value) {
    return value;
}
template <typename T>
Json json_of(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

// Calls visit(name, value) for every field, in the order of JSON and CSV.
template <typename Visit>
void for_each_field(const sim::Impact& i, Visit visit) {
    visit("t_start", i.t_start);
    visit("t_end", i.t_end);
    visit("x", i.x);
    visit("cam_angle", i.cam_angle);
    visit("v_n_before", i.v_n_before);
    visit("v_t_before", i.v_t_before);
    visit("v_n_after", i.v_n_after);
    visit("v_t_after", i.v_t_after);
    visit("duration", i.duration);
    visit("force_peak", i.force_peak);
    visit("penetration_peak", i.penetration_peak);
    visit("impulse_n", i.impulse_n);
    visit("impulse_t", i.impulse_t);
    visit("restitution", i.restitution);
    visit("energy_lost", i.energy_lost);
    visit("collision", i.collision);
    if (!i.at_touch) return;
    const auto state = [&](const std::optional<sim::TouchState>& at, const std::string& suffix) {
        const auto value = [&](double known) { return at ? std::optional(known) : std::nullopt; };
        const sim::TouchState& some = at ? *at : *i.at_touch;
        visit("theta" + suffix, value(some.theta));
        visit("theta_dot" + suffix, value(some.theta_dot));
        visit("contact_s" + suffix, value(some.contact_s));
        for (std::size_t k = 0; k < some.q.size(); ++k) visit("q" + std::to_string(k + 1) + suffix, value(some.q[k]));
    };
    state(i.at_touch, "");
    state(i.at_release, "_after");
}

template <typename Visit>
void for_each_field(const sim::Collision& c, Visit visit) {
    visit("t_start", c.t_start);
    visit("t_end", c.t_end);
    visit("count", c.count);
    visit("x", c.x);
    visit("v_n_before", c.v_n_before);
    visit("v_n_after", c.v_n_after);
    visit("restitution", c.restitution);
    visit("force_peak", c.force_peak);
    visit("energy_lost", c.energy_lost);
}

template <typename Record>
Json array_of(const std::vector<Record>& records) {
    Json list = Json::array();
    for (const Record& record : records) {
        Json object = Json::object();
        for_each_field(record,
                       [&object](const std::string& name, const auto& value) { object[name] = json_of(value); });
        list.push_back(std::move(object));
    }
    return list;
}

void append_cell(std::string& line, double value) { append_number(line, value); }
void append_cell(std::string& line, int value) { line += std::to_string(value); }
void append_cell(std::string& line, const std::optional<double>& value) {
    if (value) append_number(line, *value);
}

Json units(const sim::Problem& problem) {
    Json map = Json::object();
    for (const sim::Channel channel : sim::all_channels(problem)) map[sim::name(channel)] = sim::unit(channel, problem);
    return map;
}

Json extrema_of(const sim::Result& result, const std::vector<sim::Channel>& channels) {
    if (channels.size() != result.extrema.size())
        throw std::logic_error("summary: " + std::to_string(channels.size()) + " channels for " +
                               std::to_string(result.extrema.size()) + " extrema");
    Json map = Json::object();
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const sim::Extremum& e = result.extrema[i];
        map[sim::name(channels[i])] = {{"min", e.min}, {"t_min", e.t_min}, {"max", e.max}, {"t_max", e.t_max}};
    }
    return map;
}

// Also within steps, if the extrema of the residual were computed.
double largest_residual(const sim::Result& result, const std::vector<sim::Channel>& channels) {
    double largest = result.energy_residual_max;
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].kind == sim::ChannelKind::energy_residual)
            largest = std::max({largest, result.extrema[i].max, -result.extrema[i].min});
    return largest;
}

void add_reproducibility(const sim::Result& result, Json& json) {
    json["reproducible_until"] = *result.reproducible_until;
    Json& lost = json["not_reproducible"] = Json::array();
    for (const sim::Interval& interval : result.not_reproducible)
        lost.push_back({json_of(interval.from), json_of(interval.to)});
    if (result.reproducible_again_from) json["reproducible_again_from"] = *result.reproducible_again_from;
    json["compared_with"] = result.compared_with;
    json["reproducibility"] = result.reproducibility;
}

constexpr const char* kManifestFormat = "beamcam manifest 1";

Json json_of(const FileRecord& made) {
    Json entry = {{"sha256", made.sha256}, {"size", made.size}};
    const auto add = [&entry](const char* key, const std::string& text) {
        if (!text.empty()) entry[key] = text;
    };
    add("version", made.origin.version);
    add("scene", made.origin.scene);
    add("inputs", made.origin.inputs);
    add("stamp", made.stamp);
    return entry;
}

// Nothing if the entry is invalid.
std::optional<FileRecord> file_record_of(const Json& entry) {
    if (!entry.is_object()) return {};
    const Json digest = entry.value("sha256", Json()), size = entry.value("size", Json());
    if (!digest.is_string() || !size.is_number_unsigned()) return {};
    const auto text = [&entry](const char* key) {
        const Json value = entry.value(key, Json());
        return value.is_string() ? value.get<std::string>() : std::string();
    };
    return FileRecord{digest.get<std::string>(), size.get<std::uintmax_t>(),
                      Origin{text("inputs"), text("version"), text("scene")}, text("stamp")};
}

std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json json_of(const sim::Timing& time) {
    if (time.repeats == 0) return nullptr;
    return {{"median", time.median}, {"low", time.low}, {"high", time.high}, {"repeats", time.repeats}};
}

// `head`: the keys that identify the row.
Json accuracy_row(Json head, const sim::AccuracyRow& row) {
    head["error"] = json_of(row.error);
    if (!row.error) {
        head["note"] = row.note;
        return head;
    }
    head["trusted_until"] = row.trusted_until;
    head["seconds"] = json_of(row.time);
    head["steps"] = row.steps;
    head["rhs_evaluations"] = row.rhs_evaluations;
    head["impacts"] = row.impacts;
    head["touch_error"] = json_of(row.touch_error);
    return head;
}

}  // namespace

std::string impacts_json(const sim::Result& result) {
    Json json;
    json["impacts"] = array_of(result.impacts);
    json["collisions"] = array_of(result.collisions);
    return text_of(json);
}

std::string impacts_csv(const sim::Result& result) {
    std::string text;
    const sim::Impact& first = result.impacts.empty() ? sim::Impact{} : result.impacts.front();
    for_each_field(first, [&text](const std::string& name, const auto&) {
        if (!text.empty()) text += ',';
        text += name;
    });
    text += '\n';
    for (const sim::Impact& impact : result.impacts) {
        std::string line;
        for_each_field(impact, [&line](const std::string& name, const auto& value) {
            if (name != "t_start") line += ',';
            append_cell(line, value);
        });
        text += line + '\n';
    }
    return text;
}

void write_impacts(const Target& file, const sim::Result& result) {
    const std::string ending = file.path.extension().string();
    if (ending == ".json") return write_file(file, impacts_json(result));
    if (ending == ".csv") return write_file(file, impacts_csv(result));
    throw UnsupportedOption("cannot write " + file.path.string() + ": impacts end in .json or .csv");
}

namespace {

void add_part(const Agreement::Part& part, Json& out) {
    out["rows"] = part.rows;
    if (part.rows == 0) return;
    out["rms"] = part.rms, out["largest"] = part.largest, out["t_largest"] = part.t_largest;
    out["highest"] = part.highest;
}

// Differences are measured minus computed, in the channel's unit.
Json json_of(const Agreement& each, const char* unit) {
    Json out{{"label", each.label}, {"file", each.file}, {"channel", sim::name(each.channel)}, {"unit", unit}};
    add_part(each.whole, out);
    Json& collisions = out["collisions"] = Json::array();
    for (const auto& after : each.collisions) {
        collisions.push_back({{"collision", after.collision}, {"t_start", after.t_start}});
        add_part(after, collisions.back());
    }
    if (!each.beyond) return out;
    const auto both = [](const Agreement::Statistics& s) { return Json{{"mean", s.mean}, {"deviation", s.deviation}}; };
    out["not_reproducible"] = {{"rows", each.beyond->rows},
                               {"measured", both(each.beyond->measured)},
                               {"computed", both(each.beyond->computed)}};
    return out;
}

}  // namespace

std::string summary_json(const sim::Problem& problem, const sim::Result& result,
                         const std::vector<sim::Channel>& extrema, const Work* work,
                         const std::vector<Agreement>& data) {
    Json json;
    json["units"] = units(problem);
    json["model"] = sim::name(problem.beam.model);
    json["modes"] = problem.beam.model == sim::ModelKind::rigid ? 0 : problem.beam.modes;
    json["end_time"] = result.end_time;
    json["steps"] = result.counters.steps;
    Json& steps = json["steps_by_method"] = Json::object();
    for (const auto& [method, count] : result.steps_by_method) steps[std::string(sim::name(method))] = count;
    json["rhs_evaluations"] = result.counters.rhs_evaluations;
    json["wall_seconds"] = result.wall_seconds;
    Json& zeros = json["events"]["theta_zero"] = Json::array();
    for (const sim::ZeroCrossing& zero : result.theta_zero)
        zeros.push_back({{"t", zero.t}, {"theta_dot", zero.theta_dot}});
    json["extrema"] = extrema_of(result, extrema);
    json["energy_residual_max"] = largest_residual(result, extrema);
    json["energy_scale"] = result.energy_scale;
    json["impacts"] = result.impacts.size();
    json["collisions"] = result.collisions.size();
    if (result.reproducible_until) add_reproducibility(result, json);
    for (const Agreement& each : data) json["data"].push_back(json_of(each, unit(each.channel, problem)));
    json["warnings"] = result.warnings;
    if (work) for_each_count(*work, [&](const char* name, long count) { json["work"][name] = count; });
    return text_of(json);
}

std::string modes_json(const std::vector<sim::Mode>& modes) {
    Json all = Json::array();
    for (const sim::Mode& mode : modes) {
        Json shape = Json::array();
        for (const sim::Vec2& at : mode.shape) shape.push_back({at.x, at.y});
        all.push_back({{"omega", mode.omega},
                       {"hz", mode.omega / (2 * std::numbers::pi)},
                       {"shape", std::move(shape)},
                       {"q", mode.q}});
    }
    return Json{{"modes", std::move(all)}}.dump(2) + "\n";
}

std::string accuracy_json(const sim::Accuracy& a) {
    Json work = Json::array(), modes = Json::array(), models = Json::array(), contact = Json::array();
    for (const auto& row : a.work)
        work.push_back(accuracy_row({{"method", sim::name(row.method)}, {"rtol", row.rtol}}, row));
    for (const auto& row : a.modes) modes.push_back(accuracy_row({{"modes", row.modes}}, row));
    for (const auto& row : a.models) models.push_back(accuracy_row({{"model", sim::name(row.model)}}, row));
    for (const auto& row : a.contact) contact.push_back(accuracy_row({{"change", row.change}}, row));
    Json all = {{"of", a.of_tip ? "tip_deflection / length" : "theta"},
                {"units", {{"error", "rad"}, {"seconds", "s"}, {"trusted_until", "s"}, {"touch_error", "s"}}},
                {"end_time", a.end_time},
                {"until", a.until},
                {"reference_error", a.reference_error},
                {"target", a.target},
                {"time_integration", work},
                {"modes", {{"against", a.most_modes}, {"rows", modes}}},
                {"models", {{"against", sim::name(a.best_model)}, {"until", a.models_until}, {"rows", models}}},
                {"contact", contact},
                {"recommendation", nullptr}};
    if (const auto& r = a.recommendation)
        all["recommendation"] = {{"rtol", r->rtol},   {"modes", r->modes},     {"until", r->until},
                                 {"error", r->error}, {"seconds", r->seconds}, {"text", r->text}};
    return all.dump(2) + "\n";
}

std::string stress_json(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    Json plates = Json::array(), cases = Json::array();
    for (const sim::CaseGrid& grid : campaign.grids)
        plates.push_back({{"title", grid.title},
                          {"row_title", grid.row_title},
                          {"column_title", grid.column_title},
                          {"rows", grid.rows},
                          {"columns", grid.columns}});
    for (std::size_t i = 0; i < results.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        const sim::StressResult& r = results[i];
        cases.push_back({{"plate", one.grid},
                         {"row", one.row},
                         {"column", one.column},
                         {"variant", one.variant},
                         {"outcome", name(r.outcome)},
                         {"closure", r.closure},
                         {"steps_per_second", r.steps_per_second},
                         {"steps", r.steps},
                         {"impacts", r.impacts},
                         {"reached", r.reached},
                         {"words", r.message}});
    }
    return text_of({{"plates", std::move(plates)}, {"cases", std::move(cases)}});
}

std::string manifest_json(const FileRecords& files) {
    Json json;
    json["format"] = kManifestFormat;
    json["files"] = Json::object();
    for (const auto& [name, made] : files) json["files"][name] = json_of(made);
    return text_of(json);
}

std::optional<FileRecords> parse_manifest(const std::string& text) {
    const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object() || json.value("format", Json()) != kManifestFormat) return {};
    const Json entries = json.value("files", Json());
    if (!entries.is_object()) return {};
    FileRecords files;
    for (const auto& item : entries.items()) {
        const auto made = file_record_of(item.value());
        if (!made) return {};
        files[item.key()] = *made;
    }
    return files;
}

std::string journal_line(const std::string& temporary) { return line_of({{"temporary", temporary}}); }

std::string journal_line(const std::string& name, const FileRecord& made) {
    return line_of({{"name", name}, {"made", json_of(made)}});
}

JournalLines parse_journal(const std::string& text) {
    JournalLines all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
        if (!json.is_object()) continue;
        const Json temporary = json.value("temporary", Json()), name = json.value("name", Json());
        if (temporary.is_string()) all.temporaries.push_back(temporary.get<std::string>());
        if (!name.is_string()) continue;
        if (const auto made = file_record_of(json.value("made", Json())))
            all.placed.emplace_back(name.get<std::string>(), *made);
    }
    return all;
}

}  // namespace beamcam::output
