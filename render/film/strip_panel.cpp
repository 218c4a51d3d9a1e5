// Channels against time, and the energy ledger as stacked bands: both are Charts; here they get their contents.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using sim::Channel;
using sim::ChannelKind;

struct Name {
    const char *words, *symbol;  // markup is made by `math`, subscripts apart
    const char* subscript = "";
    bool rate = false;  // by time
};
Name name_of(Channel channel) {
    switch (channel.kind) {
        case ChannelKind::t:
            return {"Time ", "t"};
        case ChannelKind::theta:
            return {"Hub angle ", "θ"};
        case ChannelKind::theta_dot:
            return {"Hub speed ", "θ", "", true};
        case ChannelKind::tip_deflection:
            return {"Tip deflection ", "w"};
        case ChannelKind::tip_rate:
            return {"Rate of the tip ", "w", "", true};
        case ChannelKind::contact_force:
            return {"Contact force ", "F"};
        case ChannelKind::friction_force:
            return {"Friction ", "F", "t"};
        case ChannelKind::gap:
            return {"Gap ", "g"};
        case ChannelKind::contact_x:
            return {"Contact point on the beam ", "x", "c"};
        case ChannelKind::contact_s:
            return {"Contact point on the disc ", "s", "c"};
        case ChannelKind::cam_angle:
            return {"Cam angle ", "ψ"};
        case ChannelKind::q:
            return {"Modal coordinate ", "q"};
        case ChannelKind::energy_kinetic:
            return {"Kinetic energy ", "T"};
        case ChannelKind::energy_potential:  // above its least value
            return {"Potential energy ", "V − V", "min"};
        case ChannelKind::energy_elastic:
            return {"Bending energy ", "U"};
        case ChannelKind::energy_contact:
            return {"Energy in the contact ", "U", "c"};
        case ChannelKind::loss_structural:
            return {"Lost in the beam ", "D", "s"};
        case ChannelKind::loss_contact:
            return {"Lost in the contact ", "D", "c"};
        case ChannelKind::loss_friction:
            return {"Lost to friction ", "D", "f"};
        case ChannelKind::work_cam:
            return {"Work of the cam ", "W", "c"};
        case ChannelKind::work_drive:
            return {"Work of the drive ", "W", "d"};
        case ChannelKind::energy_residual:
            return {"Ledger residual ", "ΔE"};
        case ChannelKind::separation:
            return {"Separation ", "a", "n"};
        case ChannelKind::separation_paper:
            return {"Separation, printed form ", "a", "p"};
    }
    return {"", ""};
}

std::string symbol_of(Channel channel) {
    const Name name = name_of(channel);
    std::string text = math(name.symbol);
    if (name.rate) text = fmt::format("d{}/d{}", text, math("t"));
    const std::string below = channel.kind == ChannelKind::q ? std::to_string(channel.index) : name.subscript;
    return below.empty() ? text : text + "<sub>" + below + "</sub>";
}

// The symbol in its curve's colour: a legend that needs no room.
std::string colored(const std::string& markup, Color color) {
    const auto byte = [](double share) { return static_cast<int>(std::lround(255 * share)); };
    return fmt::format("<span foreground='#{:02x}{:02x}{:02x}'>{}</span>", byte(color.r), byte(color.g), byte(color.b),
                       markup);
}

std::string unit_text(Channel channel, const sim::Problem& problem) {
    const std::string unit = sim::unit(channel, problem);
    return unit == "m/s^2" ? "m/s²" : unit;
}

// Energies have one colour in strips and in the ledger; nothing for other channels.
std::optional<Color> energy_color(const Palette& p, ChannelKind kind) {
    switch (kind) {
        case ChannelKind::energy_potential:
            return mix(p.paper, p.motion, 0.45);
        case ChannelKind::energy_kinetic:
            return p.motion;
        case ChannelKind::energy_elastic:
            return series_color(p, 1);
        case ChannelKind::energy_contact:
            return p.contact;
        case ChannelKind::loss_structural:
        case ChannelKind::loss_contact:
        case ChannelKind::loss_friction:
            return mix(p.paper, p.muted, 0.55);
        default:
            return {};
    }
}

// Only differences of potential energy mean anything: its least value is the zero.
double zero_of(const sim::Table& table, Channel channel) {
    const auto* v = channel.kind == ChannelKind::energy_potential ? column(table, channel) : nullptr;
    return v && !v->empty() ? *std::ranges::min_element(*v) : 0;
}

bool is_force(Channel c) { return c.kind == ChannelKind::contact_force; }

class ChartPanel : public Panel {
    struct Shown final : State {
        double until = 0;  // the picture's first column that shows no past
    };

  public:
    ChartPanel(const FilmFacts& facts, ChartContent content, const Box& box)
        : facts_(facts), chart_(std::move(content), box, plot_area(box, facts.unit), facts.unit) {
        past_ = chart_.past(*facts.fonts);
    }
    void draw_ground(Canvas& canvas) const override { chart_.draw_ground(canvas, *facts_.palette); }
    Box growing() const override { return chart_.windowed() ? Box{} : chart_.past_box(); }
    std::unique_ptr<State> make_state() const override { return std::make_unique<Shown>(); }
    // What has been, column by column.
    void grow(Canvas& kept, const Image&, int frame, bool anew, State* state) const override {
        if (chart_.windowed()) return;
        const Box at = chart_.past_box();
        double& shown = static_cast<Shown*>(state)->until;
        if (anew) shown = at.x;
        const double until = std::max(shown, double(chart_.past_column(facts_.at(0, frame))));
        kept.image_part(past_, static_cast<int>(at.x), static_cast<int>(at.y), {shown - at.x, 0, until - shown, at.h});
        shown = until;
    }
    void draw(Canvas& canvas, int frame, Style, State*) const override {
        chart_.draw_moving(canvas, *facts_.palette, facts_.at(0, frame), readings(frame));
    }

  protected:
    virtual std::vector<double> readings(int frame) const = 0;
    const FilmFacts& facts_;

  private:
    Chart chart_;
    Image past_;
};

// `member` < 0: of all motions.
ChartContent blank(const FilmFacts& facts, const PanelSpec& spec, int member) {
    ChartContent c;
    c.time = facts.span;
    c.window = spec.window;
    c.time_unit = facts.time.unit;
    c.time_label = math("t") + " / " + facts.time.symbol;
    const auto mark = [&](int whose, ChartMark at) {
        for (const sim::Impact& i : facts.motion(whose).impacts)
            if (i.t_start >= c.time.low && i.t_start <= c.time.high) at.t = i.t_start, c.marks.push_back(at);
    };
    if (member >= 0) {
        mark(member, {.color = facts.palette->contact});
    } else {
        for (int m = 0; m < facts.members(); ++m)
            mark(m, {.color = facts.member_color(m), .lane = m, .lanes = facts.members()});
    }
    return c;
}

// ---- strips ------------------------------------------------------------------------------------

using ForceRow = std::array<double, 2>;  // instant, force

// Where a force between rows is largest: at the vertex of the parabola through the highest row and its neighbours.
double instant_of_peak(const ForceRow& before, const ForceRow& highest, const ForceRow& after) {
    const double left = highest[0] - before[0], right = after[0] - highest[0];
    const double rise = (highest[1] - before[1]) / left, fall = (after[1] - highest[1]) / right;  // rise >= 0 >= fall
    const double lean = rise - fall > 0 ? (rise * right + fall * left) / (rise - fall) : 0;
    const double least = 0.01 * std::min(left, right);
    double shift = 0.5 * lean;
    if (std::abs(shift) < least) shift = lean < 0 ? -least : least;  // the row itself keeps its own value
    return highest[0] + std::clamp(shift, -0.9 * left, 0.9 * right);
}

// The force from the tables of chart and trace, and the peaks that their rows miss, each beside the row that is nearest
// it; an impact that no row meets is a triangle. Rows keep their values: they are those of the frames' instants. An
// impact that is not over within the rows has no peak yet.
void force_rows(const FilmFacts& facts, int member, Curve& curve) {
    const Motion& one = facts.motion(member);
    std::vector<ForceRow> rows;
    for (const sim::Table* table : {&one.chart, &one.trace}) {
        const auto *t = column(*table, {ChannelKind::t, 0}), *force = column(*table, {ChannelKind::contact_force, 0});
        if (!t || !force) continue;
        for (std::size_t i = 0; i < table->rows(); ++i)
            if (!std::isnan((*force)[i])) rows.push_back({(*t)[i], (*force)[i]});
    }
    const auto by_time = [&] { std::ranges::stable_sort(rows, {}, [](const ForceRow& r) { return r[0]; }); };
    by_time();
    const auto same = std::ranges::unique(rows, {}, [](const ForceRow& r) { return r[0]; });
    rows.erase(same.begin(), same.end());
    const auto sampled = static_cast<std::ptrdiff_t>(rows.size());
    for (const sim::Impact& i : one.impacts) {
        if (!i.force_peak || !i.t_end || sampled == 0 || *i.t_end > rows[static_cast<std::size_t>(sampled) - 1][0])
            continue;
        const auto begin = rows.begin(), end = begin + sampled;
        const auto first = std::ranges::lower_bound(begin, end, i.t_start, {}, [](const ForceRow& r) { return r[0]; });
        const auto last = std::ranges::upper_bound(first, end, *i.t_end, {}, [](const ForceRow& r) { return r[0]; });
        const auto highest = std::max_element(first, last, [](const auto& p, const auto& q) { return p[1] < q[1]; });
        if (highest == last || !((*highest)[1] > 0)) {
            const ForceRow touch{i.t_start, 0}, peak{(i.t_start + *i.t_end) / 2, *i.force_peak}, release{*i.t_end, 0};
            rows.insert(rows.end(), {touch, peak, release});
        } else if (*i.force_peak > (*highest)[1] && highest != begin && highest + 1 != end) {
            const double at = instant_of_peak(*(highest - 1), *highest, *(highest + 1));
            rows.push_back({at, *i.force_peak});
        }
    }
    std::erase_if(rows, [&](const auto& r) { return r[0] < facts.span.low || r[0] > facts.span.high; });
    by_time();
    for (const auto& r : rows) curve.t.push_back(r[0]), curve.v.push_back(r[1]);
}

Curve curve_of(const FilmFacts& facts, int member, Channel channel) {
    Curve curve;
    if (is_force(channel)) {
        force_rows(facts, member, curve);
        return curve;
    }
    const Motion& one = facts.motion(member);
    const auto *t = column(one.chart, {ChannelKind::t, 0}), *v = column(one.chart, channel);
    if (t && v) curve.t = *t, curve.v = *v;
    for (double& value : curve.v) value -= zero_of(one.chart, channel);
    return curve;
}

Range range_of(const FilmFacts& facts, const std::vector<Curve>& curves, Channel channel) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto see = [&](double v) {
        if (!std::isnan(v)) low = std::min(low, v), high = std::max(high, v);
    };
    for (const Curve& curve : curves)
        for (double v : curve.v) see(v);
    for (int m = 0; channel.kind == ChannelKind::theta && m < facts.members(); ++m) {
        const Motion& one = facts.motion(m);
        const bool still = facts.frames() == 1;  // it shows its past alone, which is the chart's
        for (std::size_t k = 0; k < (still ? 1 : one.surveyed()); ++k)
            see(still ? one.pose(0).theta : one.surveyed(k).theta);
    }
    if (is_force(channel)) return {0, high > 0 ? 1.02 * high : 1};
    if (!(low <= high)) return {0, 1};
    // A constant still needs an axis: a twentieth of it either way, or of one unit.
    const double least = channel.kind == ChannelKind::theta ? 1e-9 : 1e-12 * std::max(std::abs(low), std::abs(high));
    if (high - low <= least) {
        const double half = channel.kind == ChannelKind::theta || low == 0 ? 0.05 : 0.05 * std::abs(low);
        return {low - half, high + half};
    }
    return {low, high};
}

// The channel at a frame; NaN: it has no value there.
double reading(const FilmFacts& facts, int member, int frame, Channel channel) {
    const sim::Pose& pose = facts.pose(member, frame);
    if (channel.kind == ChannelKind::theta) return pose.theta;
    if (channel.kind == ChannelKind::theta_dot) return pose.theta_dot;
    if (is_force(channel)) return pose.nearest ? pose.nearest->force : kNan;
    if (channel.kind == ChannelKind::contact_x) return pose.nearest && pose.nearest->touching ? pose.nearest->x : kNan;
    const sim::Table& table = facts.motion(member).chart;
    const auto *t = column(table, {ChannelKind::t, 0}), *v = column(table, channel);
    return t && v ? value_at(*t, *v, pose.t) - zero_of(table, channel) : kNan;
}

// What curves of several channels, or motions, are told apart by.
Color curve_color(const FilmFacts& facts, Channel channel, std::size_t i, int member) {
    if (facts.members() > 1) return facts.member_color(member);
    return energy_color(*facts.palette, channel.kind).value_or(series_color(*facts.palette, i));
}

// The places of contact as dots.
void add_places(const FilmFacts& facts, ChartContent& c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int m = 0; m < facts.members(); ++m)
        for (const TraceSample& s : facts.samples[static_cast<std::size_t>(m)]) {
            low = std::min(low, s.x), high = std::max(high, s.x);
            if (s.t < c.time.low || s.t > c.time.high) continue;
            const Palette& p = *facts.palette;
            if (facts.members() > 1)
                c.dots.push_back({s.t, s.x, facts.member_color(m), mix(p.paper, facts.member_color(m), 0.25)});
            else
                c.dots.push_back({s.t, s.x, force_color(p, std::sqrt(s.force / facts.force_scale)),
                                  mix(p.paper, p.contact_faint, 0.9)});
        }
    const double length = facts.setup->problem.beam.length;
    if (!(low <= high)) {
        c.value = {0, length};
        return;
    }
    const double around = std::max(0.05 * (high - low), 1e-3 * length);
    c.value = {low - around, high + around};
}

// The curves of a strip's channels for every motion.
ChartContent strip_content(const FilmFacts& facts, const PanelSpec& spec) {
    const Channel first = spec.channels.front();
    const Palette& p = *facts.palette;
    ChartContent c = blank(facts, spec, facts.members() > 1 ? -1 : 0);
    const bool single = spec.channels.size() == 1;
    const bool dotted = first.kind == ChannelKind::contact_x && !spec.by_collision;
    c.words = single ? name_of(first).words : "";
    c.unit = unit_text(first, facts.setup->problem);
    for (std::size_t i = 0; i < spec.channels.size(); ++i) {
        std::string symbol = symbol_of(spec.channels[i]);
        if (!single && facts.members() == 1)
            symbol = colored(symbol, readable(p, curve_color(facts, spec.channels[i], i, 0)));
        c.symbol += fmt::format("{}{}", i > 0 ? ", " : "", symbol);
        for (int m = 0; m < facts.members(); ++m) {
            Curve curve = dotted ? Curve{} : curve_of(facts, m, spec.channels[i]);
            const bool contact = is_force(first) || first.kind == ChannelKind::contact_x;
            const bool alone = single && facts.members() == 1;
            curve.color = alone && contact ? p.contact : curve_color(facts, spec.channels[i], i, m);
            curve.faint = alone ? (contact ? p.contact_faint : p.motion_faint) : mix(p.paper, curve.color, 0.25);
            if (facts.members() > 1)
                curve.label = escape(facts.motion(m).label) + ":";  // "ω = 0: 12"
            else if (!single)
                curve.label = symbol_of(spec.channels[i]);
            // Colour alone does not tell curves apart for everybody.
            const std::size_t dashes = facts.members() > 1 ? static_cast<std::size_t>(m) : i;
            if (dashes % 3 == 1) curve.dash = {9, 4};
            if (dashes % 3 == 2) curve.dash = {3, 3};
            if (is_force(first)) curve.dash.clear();
            c.curves.push_back(std::move(curve));
        }
    }
    c.filled = single && is_force(first) && facts.members() == 1;
    if (is_force(first)) c.reading_unit = c.unit;
    c.value = range_of(facts, c.curves, first);
    if (single && dotted) add_places(facts, c);
    return c;
}

class StripPanel final : public ChartPanel {
  public:
    StripPanel(const FilmFacts& facts, const PanelSlot& slot)
        : ChartPanel(facts, strip_content(facts, slot.spec), slot.box), spec_(slot.spec) {}

  private:
    std::vector<double> readings(int frame) const override {
        std::vector<double> out;
        for (const Channel channel : spec_.channels)
            for (int m = 0; m < facts_.members(); ++m) out.push_back(reading(facts_, m, frame, channel));
        return out;
    }
    PanelSpec spec_;
};

// ---- a strip that turns from one collision to the next ------------------------------------------

// The channel during one collision, from a little before its first touch: t₀ is that touch. It stays until the next
// collision begins; before the first it shows that one's axes. All collisions share the axis of values.
class CollisionPanel final : public Panel {
    struct Shown final : State {
        std::optional<Chart> chart;
        std::size_t which = 0;
        Image past;              // the plot as it will be when the collision is over
        double until = 0;        // the picture's first column that shows no past
        std::vector<Box> texts;  // of the axes
    };

  public:
    CollisionPanel(const FilmFacts& facts, const PanelSlot& slot)
        : facts_(facts), spec_(slot.spec), box_(slot.box), plot_(plot_area(slot.box, facts.unit)) {
        for (const sim::Impact& i : facts.motion(0).impacts) {
            if (i.t_start > facts.span.high) break;
            const double end = std::min(i.t_end.value_or(facts.span.high), facts.span.high);
            if (spans_.empty() || i.collision != last_)
                spans_.push_back({i.t_start, end});
            else
                spans_.back().high = std::max(spans_.back().high, end);
            last_ = i.collision;
        }
        content_ = strip_content(facts, spec_);
        content_.marks.clear();
        curves_ = std::exchange(content_.curves, {});
    }

    void draw_ground(Canvas&) const override {}
    std::unique_ptr<State> make_state() const override { return std::make_unique<Shown>(); }
    int stage(int frame) const override { return static_cast<int>(shown(facts_.at(0, frame))); }
    Box growing() const override { return box_.inset(-8); }

    // The axes of a collision when it begins, then column by column what has been.
    void grow(Canvas& kept, const Image&, int frame, bool anew, State* state) const override {
        Shown& s = *static_cast<Shown*>(state);
        const double now = facts_.at(0, frame);
        const std::size_t which = shown(now);
        if (!s.chart || s.which != which) {
            s.chart.emplace(chart_of(which));
            s.which = which;
            s.past = Image();
        }
        const Box at = s.chart->past_box();
        if (anew) {
            s.texts.clear();
            kept.record = &s.texts;
            s.chart->draw_ground(kept, *facts_.palette);
            kept.record = nullptr;
            if (s.past.pixels.empty()) s.past = past_of(*s.chart, kept);
            s.until = at.x;
        }
        const double t = now - start(which);
        if (!(t > s.chart->time().low)) return;
        // Once it is over nothing moves any more.
        const double until =
            std::max(s.until, t > s.chart->time().high ? plot_.right() + 1 : double(s.chart->past_column(t)));
        kept.replace_part(s.past, static_cast<int>(at.x), static_cast<int>(at.y),
                          {s.until - at.x, 0, until - s.until, at.h});
        s.until = until;
    }

    void draw(Canvas& canvas, int frame, Style, State* state) const override {
        const Shown& s = *static_cast<const Shown*>(state);
        if (canvas.record) canvas.record->insert(canvas.record->end(), s.texts.begin(), s.texts.end());
        const sim::Pose& pose = facts_.pose(0, frame);
        const double t = pose.t - start(s.which);
        if (t < s.chart->time().low || t > s.chart->time().high) return;
        std::vector<double> readings;
        for (const Channel channel : spec_.channels) readings.push_back(reading(facts_, 0, frame, channel));
        s.chart->draw_moving(canvas, *facts_.palette, t, readings);
    }

  private:
    // The collision that has begun last.
    std::size_t shown(double t) const {
        std::size_t which = 0;
        while (which + 1 < spans_.size() && spans_[which + 1].low - margin(which + 1) <= t) ++which;
        return which;
    }
    double start(std::size_t which) const { return spans_.empty() ? 0 : spans_[which].low; }
    Image past_of(const Chart& chart, const Canvas& ground) const {
        Image image = ground.image();
        Canvas canvas(image, ground.fonts());
        chart.draw_past(canvas);
        const Box at = chart.past_box();
        Image plot(static_cast<int>(at.w), static_cast<int>(at.h));
        Canvas(plot, ground.fonts()).replace_part(image, static_cast<int>(-at.x), static_cast<int>(-at.y), at);
        return plot;
    }
    double margin(std::size_t which) const { return 0.15 * std::max(spans_[which].high - spans_[which].low, 1e-4); }

    Chart chart_of(std::size_t which) const {
        ChartContent c = content_;
        if (spans_.empty()) {
            c.time = {0, 0.01};
        } else {
            // A contact that lasts is no collision any more: its first tenth of a second is.
            constexpr double kLongest = 0.1;  // [s]
            const Range& span = spans_[which];
            const double length = std::min(span.high - span.low, kLongest), m = std::min(margin(which), 0.01);
            c.time = {-m, length + m};
            // One that was over that when the film began, or the instant of a still was reached, is seen as it goes on.
            const double first = facts_.at(0, 0), shown_until = span.low + length + m;
            if (facts_.frames() == 1 && first > shown_until && first <= span.high)
                c.time = {first - kLongest - span.low, first - span.low};
            else if (facts_.span.low > shown_until && span.high > facts_.span.low)
                c.time = {facts_.span.low - span.low, std::min(span.high, facts_.span.high) - span.low};
            c.words = fmt::format("Collision {}, ", which + 1);
        }
        const Prefix prefix = prefix_for(c.time.high);
        c.time_unit = c.time.high < 1 ? prefix.factor : 1;
        c.time_label = fmt::format("{0} − {0}<sub>0</sub> / {1}s", math("t"), c.time.high < 1 ? prefix.symbol : "");
        const double t0 = start(which);
        for (const Curve& all : curves_) {
            Curve curve{{}, {}, all.color, all.faint, all.label, all.dash};
            const auto begin = std::ranges::lower_bound(all.t, t0 + c.time.low) - all.t.begin(),
                       end = std::ranges::upper_bound(all.t, t0 + c.time.high) - all.t.begin();
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                curve.t.push_back(all.t[i] - t0), curve.v.push_back(all.v[i]);
            c.curves.push_back(std::move(curve));
        }
        return Chart(std::move(c), box_, plot_, facts_.unit);
    }

    const FilmFacts& facts_;
    PanelSpec spec_;
    Box box_, plot_;
    std::vector<Range> spans_;
    int last_ = -1;
    ChartContent content_;
    std::vector<Curve> curves_;
};

// ---- the ledger --------------------------------------------------------------------------------

// T + (V − least V) + U + U_c + losses, one upon the other: together they are the energy of the start plus all
// work done by cam and drive, so the outline of the stack is what was supplied.
class EnergyPanel final : public ChartPanel {
  public:
    EnergyPanel(const FilmFacts& facts, const PanelSlot& slot)
        : ChartPanel(facts, content(facts, slot), slot.box),
          box_(slot.box),
          member_(std::min(slot.spec.member, facts.members() - 1)) {}

    void draw_ground(Canvas& canvas) const override {
        ChartPanel::draw_ground(canvas);
        legend(canvas);
    }
    void draw(Canvas& canvas, int frame, Style style, State* state) const override {
        ChartPanel::draw(canvas, frame, style, state);
        whose(canvas);
    }

  private:
    struct Part {
        const char* label;
        std::string symbol;  // where words find no room
        std::vector<ChannelKind> channels;
        Color color;
    };
    static std::vector<Part> parts(const FilmFacts& facts) {
        const Palette& p = *facts.palette;
        using K = ChannelKind;
        const auto part = [&](const char* label, std::string symbol, std::vector<K> channels) {
            const Color color = *energy_color(p, channels.front());
            return Part{label, std::move(symbol), std::move(channels), color};
        };
        return {part("potential", math("V"), {K::energy_potential}), part("kinetic", math("T"), {K::energy_kinetic}),
                part("bending", math("U"), {K::energy_elastic}),
                part("contact", math("U") + "<sub>c</sub>", {K::energy_contact}),
                part("lost", math("D"), {K::loss_structural, K::loss_contact, K::loss_friction})};
    }

    static ChartContent content(const FilmFacts& facts, const PanelSlot& slot) {
        const PanelSpec& spec = slot.spec;
        const int member = std::min(spec.member, facts.members() - 1);
        ChartContent c = blank(facts, spec, member);
        if (is_wide(facts, slot.box)) c.words = "Energy ";  // else the legend alone stands beside the symbol
        c.symbol = math("E");
        c.unit = "J";
        const sim::Table& table = facts.motion(member).chart;
        const auto* t = column(table, {ChannelKind::t, 0});
        if (!t) return c;
        c.band_times = *t;
        std::vector<double> base(t->size(), 0.0);
        double most = 0;
        for (const Part& part : parts(facts)) {
            Band band{base, base, part.color};
            for (ChannelKind kind : part.channels) {
                const auto* v = column(table, {kind, 0});
                if (!v || v->empty()) continue;
                const double zero = zero_of(table, {kind, 0});
                // Without a cam nothing is lost in a contact: its channels are empty.
                for (std::size_t i = 0; i < base.size(); ++i)
                    if (!std::isnan((*v)[i])) band.high[i] += std::max((*v)[i] - zero, 0.0);
            }
            base = band.high;
            for (double v : base)
                if (v > most) most = v;
            c.bands.push_back(std::move(band));
        }
        c.value = {0, most > 0 ? 1.02 * most : 1};
        return c;
    }

    static bool is_wide(const FilmFacts& facts, const Box& box) { return box.w > 600 * facts.unit; }

    // Beside the heading, closer and smaller where it would not find room; below it, whose energy this is.
    void legend(Canvas& canvas) const {
        const double u = facts_.unit;
        const Box plot = plot_area(box_, u);
        std::vector<Part> shown = parts(facts_);
        std::erase_if(shown, [&](const Part& part) { return !is_there(part); });
        const double first = plot.x +
                             canvas
                                 .measure(is_wide(facts_, box_) ? "Energy E / mJ" : "E / mJ",
                                          {.size = 21 * u, .weight = Weight::semibold})
                                 .w +
                             20 * u;
        struct Step {
            double size, swatch, gap;
            bool in_symbols = false;
        } chosen{};
        const auto words = [&](const Part& part) { return chosen.in_symbols ? part.symbol : std::string(part.label); };
        for (const Step step : {Step{16, 19, 16}, {16, 18, 9}, {14, 15, 8}, {16, 19, 12, true}, {16, 17, 6, true}}) {
            chosen = step;
            double end = first - step.gap * u;
            for (const Part& part : shown)
                end += (step.gap + step.swatch) * u + canvas.measure(words(part), {.size = step.size * u}).w;
            if (end <= box_.right()) break;
        }
        const TextStyle style{.size = chosen.size * u, .color = facts_.palette->muted};
        const double side = 0.8 * chosen.size * u;
        double x = first;
        for (const Part& part : shown) {
            const double w = canvas.measure(words(part), style).w;
            if (x + w + chosen.swatch * u > box_.right() + 1) break;
            canvas.rounded({x, box_.y + 26.5 * u - side, side, side}, 3 * u);
            canvas.fill(part.color);
            canvas.text({x + chosen.swatch * u, box_.y + 26 * u}, words(part), style);
            x += w + (chosen.swatch + chosen.gap) * u;
        }
    }
    // A rigid beam does not bend, impulses store nothing: a colour that is nowhere needs no name.
    bool is_there(const Part& part) const {
        const sim::Table& table = facts_.motion(member_).chart;
        return std::ranges::any_of(part.channels, [&](ChannelKind kind) {
            const auto* v = column(table, {kind, 0});
            const double zero = zero_of(table, {kind, 0});
            return v && std::ranges::any_of(*v, [&](double value) { return value > zero; });
        });
    }
    // Over the bands, which grow beneath it.
    void whose(Canvas& canvas) const {
        if (facts_.members() == 1) return;
        const double u = facts_.unit;
        const Box plot = plot_area(box_, u);
        canvas.text({plot.x + 10 * u, plot.y + 24 * u}, escape(canvas.drawable(facts_.motion(member_).label)),
                    {.size = 18 * u,
                     .color = facts_.palette->ink,
                     .weight = Weight::semibold,
                     .max_width = plot.w - 20 * u,
                     .halo = facts_.palette->paper});
    }
    std::vector<double> readings(int) const override { return {}; }
    Box box_;
    int member_;
};

}  // namespace

std::unique_ptr<Panel> make_strip_panel(const FilmFacts& facts, const PanelSlot& slot) {
    if (slot.spec.by_collision && facts.members() == 1 && facts.setup->problem.cam)
        return std::make_unique<CollisionPanel>(facts, slot);
    return std::make_unique<StripPanel>(facts, slot);
}
std::unique_ptr<Panel> make_energy_panel(const FilmFacts& facts, const PanelSlot& slot) {
    return std::make_unique<EnergyPanel>(facts, slot);
}

}  // namespace beamcam::render
