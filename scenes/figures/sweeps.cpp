#include "scenes/figures/sweeps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "output/data/sweep_data.hpp"
#include "render/base/error.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/key_label.hpp"
#include "scenes/figures/recipes.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;
using render::Color;
using render::rgb;
using sim::AttractorClass;

// How each class is drawn and called.
struct ClassLook {
    AttractorClass kind;
    std::uint32_t color;
    const char* zh;
};
constexpr ClassLook kClasses[] = {
    {AttractorClass::rest, 0xF2F2F2, "静止"},         {AttractorClass::following, 0xD0D0D0, "跟随"},
    {AttractorClass::periodic, 0x0072B2, "周期"},     {AttractorClass::quasi_periodic, 0x009E73, "准周期"},
    {AttractorClass::chaotic, 0xD55E00, "混沌"},      {AttractorClass::aperiodic, 0xE69F00, "非周期"},
    {AttractorClass::over_the_top, 0x404040, "翻越"}, {AttractorClass::unsettled, 0xF0E442, "未定"},
};
const ClassLook& look_of(AttractorClass kind) { return *std::ranges::find(kClasses, kind, &ClassLook::kind); }
Color color_of(AttractorClass kind) { return rgb(look_of(kind).color); }
std::string class_label(AttractorClass kind, Lang lang) { return lang == Lang::en ? name(kind) : look_of(kind).zh; }

// For periods from one to five; beyond these the last.
constexpr std::uint32_t kPeriodColors[] = {0x08306B, 0x2171B5, 0x6BAED6, 0x9ECAE1, 0xC6DBEF};
constexpr std::uint32_t kValueColors[] = {0x000000, 0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};
constexpr std::uint32_t kSeedColors[] = {0x000000, 0xE0218A, 0x009E73, 0x56B4E9};

// The points of a sweep as its figures read them.
class SweptPoints {
  public:
    SweptPoints(const Swept& swept, Lang how) : scene(*swept.scene), data(*swept.data), lang(how) {
        starts_ = starts_of(scene.sweep->seeds);
    }
    const output::SweepAxis& axis(std::size_t i) const { return data.axes.at(i); }
    std::uint64_t seeds() const { return starts_.size(); }
    SeedKind seed(std::uint64_t point) const { return starts_[point % starts_.size()]; }
    figure::Scale scale(std::size_t i) const {
        return scene.sweep->over[i].logarithmic ? figure::Scale::logarithmic : figure::Scale::linear;
    }
    // Of the samples; throws PictureError.
    std::size_t column(const std::string& name) const {
        std::vector<std::string> known;
        for (std::size_t c = 0; c < data.columns.size(); ++c) {
            if (data.columns[c].name == name) return c;
            known.push_back(data.columns[c].name);
        }
        throw render::PictureError(fmt::format("the samples have no column {}: {}", name, fmt::join(known, ", ")));
    }
    bool of_impacts() const { return scene.sweep->sampling.kind == sim::SampleKind::impacts; }

    const Scene& scene;
    const output::SweepData& data;
    const Lang lang;

  private:
    std::vector<SeedKind> starts_;
};

AttractorClass kind_of(const output::StoredPoint& p) { return static_cast<AttractorClass>(p.kind); }

std::string label_of(const std::string& name, const std::string& unit, Lang lang) {
    if (name == "cam_phase") return lang == Lang::en ? "cam phase / turn" : "凸轮相位 / 转";
    return axis_label(symbol_of(name), unit);
}
std::string label_of(const output::SweepAxis& axis) { return axis_label(symbol_of(axis.name), axis.unit); }

struct StartLook {
    SeedKind kind;
    Words label;
    const char* lane;  // beside the strip of classes, whose highest lane is the first start
};
constexpr StartLook kStarts[] = {
    {SeedKind::same, {"same start", "相同初值"}, "= "},
    {SeedKind::carry_up, {"carried up", "递增延续"}, "→ "},
    {SeedKind::carry_down, {"carried down", "递减延续"}, "← "},
    {SeedKind::random, {"random starts", "随机初值"}, ""},
};
const StartLook& look_of(SeedKind kind) { return *std::ranges::find(kStarts, kind, &StartLook::kind); }

// Edges of cells around the values, half-way between neighbours.
std::vector<double> edges_around(std::vector<double> values) {
    std::ranges::sort(values);
    if (values.size() == 1) return {values[0] - 0.5, values[0] + 0.5};
    std::vector<double> edges{values[0] - 0.5 * (values[1] - values[0])};
    for (std::size_t i = 1; i < values.size(); ++i) edges.push_back(0.5 * (values[i - 1] + values[i]));
    edges.push_back(values.back() + 0.5 * (values.back() - values[values.size() - 2]));
    return edges;
}
// By index the place of each value in ascending order.
std::vector<std::size_t> ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size()), rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

// ---- words --------------------------------------------------------------------------------------

std::string span_words(const sim::CamSpan& span, Lang lang) {
    if (span.time) return fmt::format("{:g} s", *span.time);
    return filled(lang == Lang::en ? "{:g} turns of the cam" : "凸轮 {:g} 转", span.turns);
}

std::string axes_words(const SweptPoints& points) {
    std::string text;
    for (const output::SweepAxis& axis : points.data.axes)
        text += filled(
            points.lang == Lang::en ? "{} = {:.6g} … {:.6g}{} in {} values; " : "{} = {:.6g} … {:.6g}{}，共 {} 值；",
            symbol_of(axis.name), *std::ranges::min_element(axis.values), *std::ranges::max_element(axis.values),
            axis.unit == "1" ? "" : " " + axis.unit, axis.values.size());
    return text;
}

std::string starts_words(const SweptPoints& points) {
    std::string text;
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(points.seeds(), 3); ++k) {
        if (k > 0 && points.seed(k) == points.seed(k - 1)) continue;
        text += (k > 0 ? points.lang == Lang::en ? ", " : "、" : "") + look_of(points.seed(k)).label.in(points.lang);
    }
    return points.seeds() > 3 ? fmt::format("{} ({})", text, points.seeds()) : text;
}

// What is known of the points, for the caption.
std::string caption_words(const SweptPoints& points) {
    const bool en = points.lang == Lang::en;
    std::map<AttractorClass, std::uint64_t> kinds;
    int longest = 0;  // period
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        ++kinds[kind_of(p)];
        longest = std::max(longest, p.period);
    }
    const sim::Sampling& s = points.scene.sweep->sampling;
    std::string text = axes_words(points);
    text += filled(en ? "samples: {}; transient {}, then {} kept; starts: {}. Points: "
                      : "样本：{}；舍去 {}，保留 {}；初值：{}。点数：",
                   text_of_sample(s), span_words(s.transient, points.lang), span_words(s.keep, points.lang),
                   starts_words(points));
    std::string counts;
    for (const auto& [kind, count] : kinds)
        counts += filled(en ? "{}{} {}" : "{0}{2} {1}",
                         counts.empty() ? ""
                         : en           ? ", "
                                        : "，",
                         count, class_label(kind, points.lang));
    text += counts + (en ? ". " : "。");
    if (kinds.contains(AttractorClass::chaotic))
        text += en ? "Where the motion is chaotic a point is a statistic of its start, transient and periods. "
                   : "混沌处的点是其初值、过渡与周期数的统计。";
    if (!s.keep.time && longest > s.keep.turns)
        text += filled(en ? "Of periods longer than the kept turns, up to {}, only a part is sampled. "
                          : "周期长于保留转数（最长 {} 转）时只取其一部分。",
                       longest);
    Varied varied;
    varied.cam_speed =
        std::ranges::find(points.data.axes, "cam.speed", &output::SweepAxis::name) != points.data.axes.end();
    return text + (en ? "But for what is swept: " : "除扫描参数外：") +
           facts(points.scene.problem, points.lang, varied);
}

std::string tolerance_words(const SweptPoints& points) {
    const bool en = points.lang == Lang::en;
    const sim::Problem& problem = points.scene.problem;
    const bool closed =
        problem.beam.model == sim::ModelKind::rigid && problem.contact.model == sim::ContactModel::restitution;
    return filled(en ? "Relative tolerance {}{}." : "相对容差 {}{}。", one_digit(problem.solver.rtol),
                  !closed ? ""
                  : en    ? ", or rounding where the rigid beam is followed in closed form"
                          : "，刚性梁以闭式求解时为舍入误差");
}

// ---- panels -------------------------------------------------------------------------------------

// The cell of a point in the strip of classes; none beyond the lanes, of which the first start's is the highest.
std::optional<std::size_t> strip_cell(const SweptPoints& points, const std::vector<std::size_t>& rank,
                                      std::uint64_t lanes, std::uint64_t k) {
    const std::uint64_t seed = k % points.seeds();
    if (seed >= lanes) return std::nullopt;
    return (lanes - 1 - seed) * rank.size() + rank[k / points.seeds()];
}

constexpr std::uint64_t kMostLanes = 8;

// Which class stands where: a row of cells for each start.
figure::Panel class_strip(const SweptPoints& points) {
    figure::Panel strip;
    strip.name = "class";
    const std::vector<double>& values = points.axis(0).values;
    const std::vector<std::size_t> rank = ranks(values);
    const std::uint64_t lanes = std::min(points.seeds(), kMostLanes);
    figure::Cells cells;
    cells.x = edges_around(values);
    for (std::uint64_t lane = 0; lane <= lanes; ++lane) cells.y.push_back(static_cast<double>(lane));
    cells.colors.assign(values.size() * lanes, Color{0, 0, 0, 0});
    std::map<AttractorClass, bool> shown;
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        const std::optional<std::size_t> cell = strip_cell(points, rank, lanes, k);
        if (!points.data.has(k) || !cell) continue;
        const AttractorClass kind = kind_of(points.data.read(k));
        cells.colors[*cell] = color_of(kind);
        shown[kind] = true;
    }
    strip.cells.push_back(std::move(cells));
    for (const auto& [kind, any] : shown) strip.swatches.push_back({class_label(kind, points.lang), color_of(kind)});
    strip.y = {.label = {}, .from = 0, .to = static_cast<double>(lanes), .numbered = false, .ticked = false};
    for (std::uint64_t lane = lanes; lanes > 1 && lane-- > 0;) strip.y.label += look_of(points.seed(lane)).lane;
    strip.legend = figure::Legend::box;
    strip.share = 0.16;
    return strip;
}

// A cloud for each start that is told apart.
std::vector<figure::Cloud> clouds_of_starts(const SweptPoints& points) {
    const std::uint64_t count = points.seed(0) == SeedKind::random ? 1 : points.seeds();
    std::vector<figure::Cloud> clouds;
    for (std::uint64_t seed = 0; seed < count; ++seed)
        clouds.push_back(
            {count > 1 ? look_of(points.seed(seed)).label.in(points.lang) : "",
             {},
             {},
             count > 1 ? rgb(kSeedColors[seed % std::size(kSeedColors)]).faded(seed > 0 ? 0.65 : 1) : rgb(0x000000)});
    return clouds;
}

void add(figure::Cloud& cloud, double x, double y) {
    cloud.x.push_back(x);
    cloud.y.push_back(y);
}
bool all_empty(const std::vector<figure::Cloud>& clouds) {
    return std::ranges::all_of(clouds, [](const figure::Cloud& cloud) { return cloud.x.empty(); });
}

const char* exponent_words(Lang lang) {
    return lang == Lang::en ? "$λ_1$: the largest Lyapunov exponent where it is known and finite."
                            : "$λ_1$：最大 Lyapunov 指数（已知且有限处）。";
}

// `order`: in which the clouds hold the points. `added` is told of each dot.
using Added = std::function<void(std::size_t panel, std::size_t cloud, std::uint64_t point)>;

std::vector<std::uint64_t> as_numbered(const SweptPoints& points) {
    std::vector<std::uint64_t> order(points.data.points());
    std::iota(order.begin(), order.end(), std::uint64_t{0});
    return order;
}

figure::Figure bifurcation(const SweptPoints& points, const std::string& value, const std::vector<std::uint64_t>& order,
                           const Added& added) {
    const std::size_t column = points.column(value), width = points.data.columns.size();
    figure::Panel panel, exponents;
    panel.clouds = exponents.clouds = clouds_of_starts(points);
    for (const std::uint64_t k : order) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        const std::size_t cloud = panel.clouds.size() > 1 ? k % points.seeds() : 0;
        const double at = points.data.place(k)[0];
        if (std::isfinite(p.exponent)) add(exponents.clouds[cloud], at, p.exponent), added(1, cloud, k);
        if (!has_section(kind_of(p))) continue;
        for (std::size_t i = column; i < p.samples.size(); i += width)
            add(panel.clouds[cloud], at, p.samples[i]), added(0, cloud, k);
    }
    panel.name = value;
    panel.y = {.label = label_of(value, points.data.columns[column].unit, points.lang)};
    panel.legend = figure::Legend::box;
    const bool empty = all_empty(panel.clouds);
    if (empty) {  // numbers would be invented
        panel.y = {.from = 0, .to = 1, .numbered = false, .ticked = false};
        panel.legend = figure::Legend::none;
        panel.share = 0.15;
    }
    exponents.name = "exponent";
    exponents.y = {.label = "$λ_1$ / s^{−1}"};
    exponents.rules = {{.at = 0}};
    exponents.legend = figure::Legend::none;
    exponents.share = 0.35;

    figure::Figure out;
    const bool known = !all_empty(exponents.clouds);
    out.panels = {std::move(panel)};
    if (known) out.panels.push_back(std::move(exponents));
    out.panels.push_back(class_strip(points));
    const std::vector<double> edges = out.panels.back().cells[0].x;
    for (figure::Panel& each : out.panels)
        each.x = {.label = label_of(points.axis(0)),
                  .scale = points.scale(0),
                  .from = edges.front(),
                  .to = edges.back(),
                  .tight = true};
    out.stack = out.share_x = true;
    out.aspect = empty ? 0.35 : known ? 1.05 : 0.8;
    if (empty) out.caption = points.lang == Lang::en ? "No motion has a section to draw." : "没有可绘制的截面。";
    if (known) out.caption += (empty ? " " : "") + std::string(exponent_words(points.lang));
    return out;
}

// ---- maps ---------------------------------------------------------------------------------------

// What stands in a cell of a map: periods apart from each other, other motions by their class.
figure::Swatch map_entry(const output::StoredPoint& p, Lang lang) {
    if (kind_of(p) != AttractorClass::periodic) return {class_label(kind_of(p), lang), color_of(kind_of(p))};
    const int most = static_cast<int>(std::size(kPeriodColors)), shown = std::min(p.period, most);
    const char* text = lang == Lang::en ? shown == most ? "period {} and more" : "period {}"
                       : shown == most  ? "周期 {} 及以上"
                                        : "周期 {}";
    return {filled(text, shown), rgb(kPeriodColors[shown - 1])};
}

constexpr const char* kMapValues[] = {"class", "exponent", "impacts_per_period"};

// A number of the point, or the mean of a column of its samples; NaN: none.
double map_value(const SweptPoints& points, const output::StoredPoint& p, const std::string& value) {
    if (value == "exponent") return std::isfinite(p.exponent) ? p.exponent : sim::kNan;
    if (value == "impacts_per_period") return p.impacts_per_period;
    const std::size_t column = points.column(value), width = points.data.columns.size();
    double sum = 0;
    for (std::size_t i = column; i < p.samples.size(); i += width) sum += p.samples[i];
    return p.samples.empty() ? sim::kNan : sum / static_cast<double>(p.samples.size() / width);
}

std::string map_label(const SweptPoints& points, const std::string& value) {
    const bool en = points.lang == Lang::en;
    if (value == "exponent") return en ? "largest exponent / s^{−1}" : "最大 Lyapunov 指数 / s^{−1}";
    if (value == "impacts_per_period") return en ? "impacts per period" : "每周期碰撞次数";
    return (en ? "mean of " : "平均 ") + label_of(value, points.data.columns[points.column(value)].unit, points.lang);
}

void color_by_class(const SweptPoints& points, const std::vector<output::StoredPoint>& entries, figure::Panel& panel) {
    std::map<std::pair<int, std::size_t>, figure::Swatch> swatches;  // in the order of classes, then of periods
    for (const output::StoredPoint& p : entries) {
        const figure::Swatch entry = map_entry(p, points.lang);
        panel.cells[0].colors[p.point] = entry.color;
        const auto period = static_cast<std::size_t>(std::max(p.period, 0));
        swatches.emplace(std::pair(p.kind, std::min(period, std::size(kPeriodColors))), entry);
    }
    for (const auto& [order, entry] : swatches) panel.swatches.push_back(entry);
    panel.legend = figure::Legend::box;
}

// Cells without a number stay white.
void color_by_value(const SweptPoints& points, const std::vector<output::StoredPoint>& entries,
                    const std::string& value, figure::Panel& panel) {
    figure::Cells& cells = panel.cells[0];
    cells.values.assign(cells.colors.size(), sim::kNan);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const output::StoredPoint& p : entries) {
        const double number = cells.values[p.point] = map_value(points, p, value);
        if (std::isnan(number)) continue;
        low = std::min(low, number);
        high = std::max(high, number);
    }
    if (!(low <= high))
        throw render::PictureError(fmt::format("no point of this sweep has a number for \"{}\"", value));
    if (low == high) low -= 0.5, high += 0.5;
    for (std::size_t i = 0; i < cells.colors.size(); ++i)
        if (!std::isnan(cells.values[i])) cells.colors[i] = figure::map_color((cells.values[i] - low) / (high - low));
    panel.color_bar = figure::ColorBar{.label = map_label(points, value), .from = low, .to = high};
    panel.legend = figure::Legend::none;
}

// What a map coloured by a number leaves white.
std::string white_words(const SweptPoints& points, const std::string& value) {
    const bool en = points.lang == Lang::en;
    if (value == "class") return "";
    if (value == "exponent")
        return en ? "White: the exponent is not known, or −∞ where lasting contact forgets every difference."
                  : "白色：指数未知，或持续接触使一切差异消失（−∞）。";
    return en ? "White: no sample." : "白色：无样本。";
}

figure::Figure two_key_map(const SweptPoints& points, const std::string& value) {
    figure::Panel panel;
    panel.name = value;
    const output::SweepAxis &across = points.axis(0), &up = points.axis(1);
    const std::vector<std::size_t> column = ranks(across.values), row = ranks(up.values);
    panel.cells.push_back({edges_around(across.values), edges_around(up.values), {}});
    panel.cells[0].colors.assign(across.values.size() * up.values.size(), Color{0, 0, 0, 0});
    std::vector<output::StoredPoint> entries;  // of the first start; `point` is the place of its cell
    for (std::uint64_t k = 0; k < points.data.points(); k += points.seeds()) {
        if (!points.data.has(k)) continue;
        const std::uint64_t cell = k / points.seeds(), width = across.values.size();
        entries.push_back(points.data.read(k));
        entries.back().point = row[cell / width] * width + column[cell % width];
    }
    if (value == "class")
        color_by_class(points, entries, panel);
    else
        color_by_value(points, entries, value, panel);
    panel.x = {.label = label_of(across), .scale = points.scale(0), .tight = true};
    panel.y = {.label = label_of(up), .scale = points.scale(1), .tight = true};
    figure::Figure out;
    out.panels = {std::move(panel)};
    out.aspect = 0.9;
    out.caption = white_words(points, value);
    return out;
}

// ---- planes of samples --------------------------------------------------------------------------

// A cloud for each value of one key, if they are few; else one of all.
std::vector<figure::Cloud> clouds_of_values(const SweptPoints& points) {
    const output::SweepAxis& axis = points.axis(0);
    if (points.data.axes.size() > 1 || axis.values.size() > std::size(kValueColors))
        return {{"", {}, {}, rgb(0x000000)}};
    std::vector<figure::Cloud> clouds;
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        clouds.push_back({value_label(symbol_of(axis.name), axis.values[i], axis.unit), {}, {}, rgb(kValueColors[i])});
    if (clouds.size() == 1) clouds[0].label.clear();
    return clouds;
}

// All samples of all points in one plane; `next`: against the sample after it.
figure::Figure plane(const SweptPoints& points, const std::string& x, const std::string& y, bool next) {
    const std::size_t cx = points.column(x), cy = points.column(y), width = points.data.columns.size();
    figure::Panel panel;
    panel.name = y;
    panel.clouds = clouds_of_values(points);
    panel.legend = figure::Legend::box;
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        if (!has_section(kind_of(p))) continue;
        figure::Cloud& cloud = panel.clouds[panel.clouds.size() > 1 ? k / points.seeds() : 0];
        const std::size_t later = next ? width : 0;
        for (std::size_t i = 0; i + later < p.samples.size(); i += width)
            add(cloud, p.samples[i + cx], p.samples[i + later + cy]);
    }
    if (all_empty(panel.clouds))
        throw render::PictureError(
            "no point has a section to show: all rest, follow the cam, have left it or have not settled");
    const bool en = points.lang == Lang::en;
    const auto axis = [&](const std::string& name, std::size_t c, const char* which, const char* zh) {
        return label_of(name, points.data.columns[c].unit, points.lang) + (next ? en ? which : zh : "");
    };
    panel.x = {.label = axis(x, cx, ", impact $k$", "，第 $k$ 次碰撞")};
    panel.y = {.label = axis(y, cy, ", impact $k$ + 1", "，第 $k$ + 1 次碰撞")};
    figure::Figure out;
    out.panels = {std::move(panel)};
    out.aspect = 0.9;
    return out;
}

// ---- recipes ------------------------------------------------------------------------------------

std::string value_of(const SweptPoints& points, const FigureOutput& how, const char* usual) {
    if (!how.value.empty()) return how.value;
    return std::string_view(usual).empty() ? points.of_impacts() ? "v_n_before" : "theta" : usual;
}

using Draw = figure::Figure (*)(const SweptPoints& points, const FigureOutput& how);

template <const Recipe& recipe, Draw draw>
FigureMaker prepare(const Scene&, const FigureOutput& how, Studies&) {
    return [how](const Results& results) {
        if (!results.swept) throw std::logic_error("a figure of a sweep without its points");
        const SweptPoints points(*results.swept, how.lang);
        figure::Figure out = draw(points, how);
        out.name = recipe.name;
        out.title =
            filled(how.lang == Lang::en ? "{} over {}" : "{}：{}", recipe.title.in(how.lang), points.axis(0).name);
        out.caption = caption_words(points) + (out.caption.empty() ? "" : " ") + out.caption;
        out.accuracy = tolerance_words(points);
        return out;
    };
}

std::optional<std::string> needs_sweep(const Scene& scene) {
    if (scene.sweep) return std::nullopt;
    return "the scene has no \"sweep\"; give it one, or use beamcam sweep --over KEY=VALUES --diagram FILE";
}
std::optional<std::string> needs_one_key(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 1) return std::nullopt;
    return "the sweep varies two keys; \"map\" shows it";
}
std::optional<std::string> needs_two_keys(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 2) return std::nullopt;
    return "the sweep varies one key; a map needs two: \"over\" has to name another, or --over a second time";
}
std::optional<std::string> needs_two_starts(const Scene& scene) {
    if (auto why = needs_two_keys(scene)) return why;
    if (std::ranges::all_of(scene.sweep->over, [](const SweptKey& o) { return o.key.starts_with("initial."); }))
        return std::nullopt;
    return "basins are over two initial values; \"map\" shows other keys";
}
std::optional<std::string> needs_impacts(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->sampling.kind == sim::SampleKind::impacts) return std::nullopt;
    return "its samples are no impacts; set sweep.sample to \"impacts\"";
}

figure::Figure draw_bifurcation(const SweptPoints& points, const FigureOutput& how) {
    return bifurcation(points, value_of(points, how, ""), as_numbered(points), [](auto...) {});
}
figure::Figure draw_map(const SweptPoints& points, const FigureOutput& how) {
    return two_key_map(points, value_of(points, how, kMapValues[0]));
}
figure::Figure draw_poincare(const SweptPoints& points, const FigureOutput&) {
    return points.of_impacts() ? plane(points, "cam_phase", "v_n_before", false)
                               : plane(points, "theta", "theta_dot", false);
}
figure::Figure draw_impact_map(const SweptPoints& points, const FigureOutput&) {
    return plane(points, "cam_phase", "cam_phase", true);
}

Recipe recipe_of_sweep(const char* name, Words title, std::optional<std::string> (*refusal)(const Scene&),
                       decltype(Recipe::prepare) prepare, bool takes_value) {
    return {.name = name,
            .title = title,
            .refusal = refusal,
            .prepare = prepare,
            .of_sweep = true,
            .takes_value = takes_value};
}

}  // namespace

const Recipe kBifurcation = recipe_of_sweep("bifurcation", {"Bifurcation diagram", "分岔图"}, needs_one_key,
                                            prepare<kBifurcation, draw_bifurcation>, true);
const Recipe kBasins =
    recipe_of_sweep("basins", {"Basins of attraction", "吸引域"}, needs_two_starts, prepare<kBasins, draw_map>, true);
const Recipe kMap =
    recipe_of_sweep("map", {"Map of two keys", "双参数图"}, needs_two_keys, prepare<kMap, draw_map>, true);
const Recipe kPoincare = recipe_of_sweep("poincare", {"Poincaré section", "Poincaré 截面"}, needs_sweep,
                                         prepare<kPoincare, draw_poincare>, false);
const Recipe kImpactMap = recipe_of_sweep("impact-map", {"Map of impacts", "碰撞映射"}, needs_impacts,
                                          prepare<kImpactMap, draw_impact_map>, false);

GrowingDiagram::GrowingDiagram(const Swept& swept, const FigureOutput& how, const std::vector<std::size_t>& place) {
    const SweptPoints points(swept, how.lang);
    std::vector<std::uint64_t> order = as_numbered(points);
    std::ranges::stable_sort(order, {}, [&](std::uint64_t k) { return place[k]; });
    places_.resize(2);
    whole_ = bifurcation(points, value_of(points, how, ""), order,
                         [&](std::size_t panel, std::size_t cloud, std::uint64_t point) {
                             std::vector<std::vector<std::size_t>>& of_panel = places_[panel];
                             of_panel.resize(std::max(of_panel.size(), cloud + 1));
                             of_panel[cloud].push_back(place[point]);
                         });
    if (whole_.panels.size() < 3) places_.pop_back();  // no exponent is known
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i].resize(whole_.panels[i].clouds.size());
    whole_.panels.front().legend = figure::Legend::above;  // a place in the plot would change as it fills
    const std::vector<std::size_t> rank = ranks(points.axis(0).values);
    const std::uint64_t lanes = std::min(points.seeds(), kMostLanes);
    cells_.assign(whole_.panels.back().cells[0].colors.size(), 0);
    for (std::uint64_t k = 0; k < points.data.points(); ++k)
        if (const auto cell = strip_cell(points, rank, lanes, k)) cells_[*cell] = place[k];
    whole_.name = kBifurcation.name;
}

figure::Figure GrowingDiagram::until(std::size_t last, double at) const {
    figure::Figure out = whole_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        for (std::size_t c = 0; c < places_[i].size(); ++c) {
            const std::vector<std::size_t>& places = places_[i][c];
            out.panels[i].clouds[c].shown =
                static_cast<std::size_t>(std::ranges::upper_bound(places, last) - places.begin());
        }
        out.panels[i].rules.push_back({.at = at, .vertical = true});
    }
    std::vector<Color>& colors = out.panels.back().cells[0].colors;
    for (std::size_t i = 0; i < colors.size(); ++i)
        if (cells_[i] > last) colors[i] = Color{0, 0, 0, 0};
    return out;
}

std::string words_of_point(const Swept& swept, std::uint64_t point, Lang lang) {
    const SweptPoints points(swept, lang);
    const output::StoredPoint p = points.data.read(point);
    const output::SweepAxis& axis = points.axis(0);
    std::string text = fmt::format("{} = {:.6g}{}", figure::to_plain(symbol_of(axis.name)), points.data.place(point)[0],
                                   axis.unit == "1" ? "" : " " + axis.unit);
    text += lang == Lang::en ? ": " : "：";
    if (kind_of(p) != AttractorClass::periodic) return text + class_label(kind_of(p), lang);
    if (lang == Lang::zh) return text + fmt::format("周期 {} 圈，碰撞 {:g} 次", p.period, p.impacts_per_period);
    const auto plural = [](auto count) { return count == 1 ? "" : "s"; };
    return text + fmt::format("period {} turn{}, {:g} impact{}", p.period, plural(p.period), p.impacts_per_period,
                              plural(p.impacts_per_period));
}

std::string usual_diagram(const Scene& scene) {
    for (const Recipe& recipe : recipes())
        if (recipe.of_sweep && !recipe.refusal(scene)) return recipe.name;
    return kPoincare.name;
}

std::vector<std::string> diagram_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes())
        if (recipe.of_sweep) names.emplace_back(recipe.name);
    return names;
}

}  // namespace beamcam::scenes
