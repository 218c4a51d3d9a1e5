#include "sim/integrate/exponential_segment.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/integrate/lane_kernels.hpp"

namespace beamcam::sim {

template <class Visit>
void ExponentialSegment::each_number(Visit&& visit) {
    const auto numbers = [&](std::span<double> all) { visit(all); };
    const auto number = [&](double& one) { visit(std::span(&one, 1)); };
    const auto lanes = [&](std::span<Lanes> all) {
        static_assert(sizeof(Lanes) == kNodes * sizeof(double));
        if (!all.empty()) visit(std::span(&all[0][0], all.size() * kNodes));
    };
    for (double* one : {&h, &theta0, &p0, &boundary0}) number(*one);
    for (std::vector<double>* all : {&q0, &v0, &end}) numbers(*all);
    for (std::vector<Lanes>* all : {&q, &v, &f}) lanes(*all);
    lanes({&spin, 1});
    lanes({&push, 1});
    numbers(ledger0);
    const auto flag = [&](bool& on) {
        double value = on;
        number(value);
        on = value != 0;
    };
    flag(ledger_changes);
    if (ledger_changes) lanes(rate);
    flag(touching);
    if (!touching) return;
    for (auto* all : {&samples.t, &samples.gap, &samples.gap_rate, &samples.force, &samples.x}) numbers(*all);
    double ending = static_cast<int>(samples.ending);
    number(ending);
    samples.ending = static_cast<TouchSamples::Ending>(static_cast<int>(ending));
}

SegmentKind ExponentialSegment::numbers(std::vector<double>& out) const {
    // Only read, by this visitor.
    const_cast<ExponentialSegment*>(this)->each_number(
        [&](std::span<const double> all) { out.insert(out.end(), all.begin(), all.end()); });
    return SegmentKind::exponential;
}

void ExponentialSegment::load(double begin, double end_time, std::span<const double> numbers) {
    t0 = begin;
    t1 = end_time;
    each_number([&](std::span<double> all) {
        if (numbers.size() < all.size()) throw std::invalid_argument("a segment of the trajectory is too short");
        std::ranges::copy(numbers.first(all.size()), all.begin());
        numbers = numbers.subspan(all.size());
    });
    if (!numbers.empty()) throw std::invalid_argument("a segment of the trajectory is too long");
    changed();
}

namespace {

class StoredExponential final : public StoredSegment {
  public:
    explicit StoredExponential(const Problem& problem)
        : system_(problem), segment_(form(system_), system_.drive(), system_.size) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        t0 = begin;
        t1 = end;
        segment_.load(begin, end, numbers);
    }
    void value(double t, double* y) const override { segment_.value(t, y); }
    double coordinate(double t, std::size_t index, double* y) const override {
        return segment_.coordinate(t, index, y);
    }
    const MotionBounds* bounds() const override { return segment_.bounds(); }
    const ModalBounds* modal_bounds() const override { return segment_.modal_bounds(); }
    double balance_error() const override { return segment_.balance_error(); }
    SegmentKind numbers(std::vector<double>& out) const override { return segment_.numbers(out); }
    const TouchSamples* touch() const override { return segment_.touch(); }

  private:
    static std::shared_ptr<const ModalForm> form(System& system) {
        auto made = ModalForm::of(system);
        if (!made) throw std::invalid_argument("the trajectory does not belong to this problem");
        return made;
    }
    System system_;
    ExponentialSegment segment_;
};

}  // namespace

std::unique_ptr<StoredSegment> make_stored_exponential(const Problem& problem) {
    return std::make_unique<StoredExponential>(problem);
}

ExponentialSegment::ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law,
                                       int state_size)
    : form_(std::move(modal_form)), drive_(drive_law), n_(static_cast<std::size_t>(form_->n)) {
    controlled_ = static_cast<std::size_t>(state_size) - kLedgerSize;
    q0.resize(n_);
    v0.resize(n_);
    q.resize(n_);
    v.resize(n_);
    f.resize(n_);
    largest_.resize(n_);
    end.resize(static_cast<std::size_t>(state_size));
    const std::size_t groups = form_->groups.size();
    turned_.resize(groups * kNodes);
    taylor_.resize(groups * kNodes);
    begin_q_.resize(groups);
    begin_v_.resize(groups);
}

double ExponentialSegment::spin_at(double p, const double* x) const {
    double quadratic = 0;
    for (std::size_t g = 0; g < form_->inertia_rows.size(); g += n_) {
        Lanes rows{};
        for (std::size_t j = 0; j < n_; ++j) rows += x[j] * form_->inertia_rows[g + j];
        const std::size_t first = g / n_ * kNodes;
        for (std::size_t i = first; i < std::min(n_, first + kNodes); ++i)
            quadratic += rows[static_cast<int>(i - first)] * x[i];
    }
    return p / (form_->J + quadratic);
}

// The forcing at the nodes, in lanes over eight modes.
void ExponentialSegment::turn() const {
    if (turned_known_) return;
    turned_known_ = true;
    for (std::size_t i = 0; i < n_; ++i)
        for (int l = 0; l < kNodes; ++l)
            turned_[i / kNodes * kNodes + static_cast<std::size_t>(l)][static_cast<int>(i % kNodes)] = f[i][l];
}

// Derivatives of the forcing at the start of the step or at a node, and where the modes are there.
void ExponentialSegment::expand(int at) const {
    if (expanded_ == at) return;
    expanded_ = at;
    turn();
    std::array<Lanes, kNodes> factors = Collocation::get().derive[static_cast<std::size_t>(at)];
    double inverse = 1;
    for (Lanes& factor : factors) {
        factor *= inverse;
        inverse /= h;
    }
    for (std::size_t g = 0; g < begin_q_.size(); ++g) {
        lane_kernels().combine(factors.data(), turned_.data() + g * kNodes, taylor_.data() + g * kNodes);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
            const int lane = static_cast<int>(i % kNodes);
            begin_q_[g][lane] = at == 0 ? q0[i] : q[i][at - 1];
            begin_v_[g][lane] = at == 0 ? v0[i] : v[i][at - 1];
        }
    }
}

// About the nearest node before t0 + sh; returns how long it lies back.
double ExponentialSegment::expand_before(double s) const {
    const Collocation& gauss = Collocation::get();
    int at = 0;
    while (at < kNodes && gauss.point[static_cast<std::size_t>(at) + 1] <= s) ++at;
    expand(at);
    return (s - gauss.point[static_cast<std::size_t>(at)]) * h;
}

void ExponentialSegment::evolve(std::size_t g, double tau, Lanes& x, Lanes& dx) const {
    Lanes r[kResponse];
    const OscillatorLanes& group = form_->groups[g];
    respond(group, tau, r);
    lane_kernels().evolve(group, r, taylor_.data() + g * kNodes, begin_q_[g], begin_v_[g], x, dx);
}

double ExponentialSegment::coordinate(double t, std::size_t index, double* y) const {
    if (!form_->by_arrays() || index == 0 || t == t1) return Segment::coordinate(t, index, y);
    const std::size_t mode = index - 1;
    Lanes x, dx;
    evolve(mode / kNodes, expand_before((t - t0) / h), x, dx);
    return x[static_cast<int>(mode % kNodes)];
}

void ExponentialSegment::value(double t, double* y) const {
    if (t == t1) {
        std::copy(end.begin(), end.end(), y);
        return;
    }
    const Collocation& gauss = Collocation::get();
    const double s = (t - t0) / h, tau = expand_before(s);
    double* rates = y + 1 + n_;
    for (std::size_t g = 0; g < begin_q_.size(); ++g) {
        Lanes x, dx;
        evolve(g, tau, x, dx);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
            y[1 + i] = x[static_cast<int>(i % kNodes)];
            rates[1 + i] = dx[static_cast<int>(i % kNodes)];
        }
    }
    Lanes weights;
    gauss.weights_to(s, weights);
    if (form_->prescribed) {
        const HubMotion hub = drive_.motion(t);
        y[0] = hub.angle;
        rates[0] = hub.rate;
    } else {
        y[0] = theta0 + h * sum(weights * spin);
        rates[0] = spin_at(p0 + h * sum(weights * push), y + 1);
    }
    for (std::size_t k = 2 * (n_ + 1); k < controlled_; ++k) y[k] = end[k];
    std::copy_n(ledger0, kLedgerSize, y + controlled_);
    if (ledger_changes) ledger_at(t, s, weights, y);
    form_->to_coordinates(y);
}

}  // namespace beamcam::sim
