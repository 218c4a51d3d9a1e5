// Dormand and Prince's explicit Runge–Kutta method of order 8(5,3), with the continuous extension of
// order 7. Coefficients: Hairer, Nørsett & Wanner, "Solving Ordinary Differential Equations I",
// 2nd ed., II.5, II.6 and II.10 (DOP853). Step-size control as described there (IV.2 for "safety").
//
// The three extra stages of the continuous extension are computed only if a segment is looked into.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "sim/base/assert.hpp"
#include "sim/integrate/constants.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

// k[0] is f(t0), k[11] the twelfth stage, k[12] = f(t1), k[13…15] the extra stages.
constexpr int kStages = 12, kAll = 16;

struct TableauEntry {
    int stage;
    double a;
};
struct TableauRow {
    double c;
    int count;
    std::array<TableauEntry, 10> entries;
};

constexpr std::array<TableauRow, kAll> kRows{{
    {0, 0, {}},
    {0.526001519587677318785587544488e-01, 1, {{{0, 5.26001519587677318785587544488e-2}}}},
    {0.789002279381515978178381316732e-01,
     2,
     {{{0, 1.97250569845378994544595329183e-2}, {1, 5.91751709536136983633785987549e-2}}}},
    {0.118350341907227396726757197510e+00,
     2,
     {{{0, 2.95875854768068491816892993775e-2}, {2, 8.87627564304205475450678981324e-2}}}},
    {0.281649658092772603273242802490e+00,
     3,
     {{{0, 2.41365134159266685502369798665e-1},
       {2, -8.84549479328286085344864962717e-1},
       {3, 9.24834003261792003115737966543e-1}}}},
    {1.0 / 3.0,
     3,
     {{{0, 3.7037037037037037037037037037e-2},
       {3, 1.70828608729473871279604482173e-1},
       {4, 1.25467687566822425016691814123e-1}}}},
    {0.25,
     4,
     {{{0, 3.7109375e-2},
       {3, 1.70252211019544039314978060272e-1},
       {4, 6.02165389804559606850219397283e-2},
       {5, -1.7578125e-2}}}},
    {0.307692307692307692307692307692e+00,
     5,
     {{{0, 3.70920001185047927108779319836e-2},
       {3, 1.70383925712239993810214054705e-1},
       {4, 1.07262030446373284651809199168e-1},
       {5, -1.53194377486244017527936158236e-2},
       {6, 8.27378916381402288758473766002e-3}}}},
    {0.651282051282051282051282051282e+00,
     6,
     {{{0, 6.24110958716075717114429577812e-1},
       {3, -3.36089262944694129406857109825e0},
       {4, -8.68219346841726006818189891453e-1},
       {5, 2.75920996994467083049415600797e1},
       {6, 2.01540675504778934086186788979e1},
       {7, -4.34898841810699588477366255144e1}}}},
    {0.6,
     7,
     {{{0, 4.77662536438264365890433908527e-1},
       {3, -2.48811461997166764192642586468e0},
       {4, -5.90290826836842996371446475743e-1},
       {5, 2.12300514481811942347288949897e1},
       {6, 1.52792336328824235832596922938e1},
       {7, -3.32882109689848629194453265587e1},
       {8, -2.03312017085086261358222928593e-2}}}},
    {0.857142857142857142857142857142e+00,
     8,
     {{{0, -9.3714243008598732571704021658e-1},
       {3, 5.18637242884406370830023853209e0},
       {4, 1.09143734899672957818500254654e0},
       {5, -8.14978701074692612513997267357e0},
       {6, -1.85200656599969598641566180701e1},
       {7, 2.27394870993505042818970056734e1},
       {8, 2.49360555267965238987089396762e0},
       {9, -3.0467644718982195003823669022e0}}}},
    {1,
     9,
     {{{0, 2.27331014751653820792359768449e0},
       {3, -1.05344954667372501984066689879e1},
       {4, -2.00087205822486249909675718444e0},
       {5, -1.79589318631187989172765950534e1},
       {6, 2.79488845294199600508499808837e1},
       {7, -2.85899827713502369474065508674e0},
       {8, -8.87285693353062954433549289258e0},
       {9, 1.23605671757943030647266201528e1},
       {10, 6.43392746015763530355970484046e-1}}}},
    {1, 0, {}},
    {0.1,
     8,
     {{{0, 5.61675022830479523392909219681e-2},
       {6, 2.53500210216624811088794765333e-1},
       {7, -2.46239037470802489917441475441e-1},
       {8, -1.24191423263816360469010140626e-1},
       {9, 1.5329179827876569731206322685e-1},
       {10, 8.20105229563468988491666602057e-3},
       {11, 7.56789766054569976138603589584e-3},
       {12, -8.298e-3}}}},
    {0.2,
     8,
     {{{0, 3.18346481635021405060768473261e-2},
       {5, 2.83009096723667755288322961402e-2},
       {6, 5.35419883074385676223797384372e-2},
       {7, -5.49237485713909884646569340306e-2},
       {10, -1.08347328697249322858509316994e-4},
       {11, 3.82571090835658412954920192323e-4},
       {12, -3.40465008687404560802977114492e-4},
       {13, 1.41312443674632500278074618366e-1}}}},
    {0.777777777777777777777777777778e+00,
     8,
     {{{0, -4.28896301583791923408573538692e-1},
       {5, -4.69762141536116384314449447206e0},
       {6, 7.68342119606259904184240953878e0},
       {7, 4.06898981839711007970213554331e0},
       {8, 3.56727187455281109270669543021e-1},
       {12, -1.39902416515901462129418009734e-3},
       {13, 2.9475147891527723389556272149e0},
       {14, -9.15095847217987001081870387138e0}}}},
}};

constexpr int kUsed[] = {0, 5, 6, 7, 8, 9, 10, 11};  // stages with weight in the solution
constexpr double kB[] = {5.42937341165687622380535766363e-2, 4.45031289275240888144113950566e0,
                         1.89151789931450038304281599044e0,  -5.8012039600105847814672114227e0,
                         3.1116436695781989440891606237e-1,  -1.52160949662516078556178806805e-1,
                         2.01365400804030348374776537501e-1, 4.47106157277725905176885569043e-2};
constexpr double kE5[] = {0.1312004499419488073250102996e-01,  -0.1225156446376204440720569753e+01,
                          -0.4957589496572501915214079952e+00, 0.1664377182454986536961530415e+01,
                          -0.3503288487499736816886487290e+00, 0.3341791187130174790297318841e+00,
                          0.8192320648511571246570742613e-01,  -0.2235530786388629525884427845e-01};
constexpr double kBhh0 = 0.244094488188976377952755905512e+00, kBhh8 = 0.733846688281611857341361741547e+00,
                 kBhh11 = 0.220588235294117647058823529412e-01;

// Continuous extension: rows 5…8 over the stages 0, 5…15.
constexpr int kDenseStages[] = {0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
constexpr double kD[4][12] = {
    {-0.84289382761090128651353491142e+01, 0.56671495351937776962531783590e+00, -0.30689499459498916912797304727e+01,
     0.23846676565120698287728149680e+01, 0.21170345824450282767155149946e+01, -0.87139158377797299206789907490e+00,
     0.22404374302607882758541771650e+01, 0.63157877876946881815570249290e+00, -0.88990336451333310820698117400e-01,
     0.18148505520854727256656404962e+02, -0.91946323924783554000451984436e+01, -0.44360363875948939664310572000e+01},
    {0.10427508642579134603413151009e+02, 0.24228349177525818288430175319e+03, 0.16520045171727028198505394887e+03,
     -0.37454675472269020279518312152e+03, -0.22113666853125306036270938578e+02, 0.77334326684722638389603898808e+01,
     -0.30674084731089398182061213626e+02, -0.93321305264302278729567221706e+01, 0.15697238121770843886131091075e+02,
     -0.31139403219565177677282850411e+02, -0.93529243588444783865713862664e+01, 0.35816841486394083752465898540e+02},
    {0.19985053242002433820987653617e+02, -0.38703730874935176555105901742e+03, -0.18917813819516756882830838328e+03,
     0.52780815920542364900561016686e+03, -0.11573902539959630126141871134e+02, 0.68812326946963000169666922661e+01,
     -0.10006050966910838403183860980e+01, 0.77771377980534432092869265740e+00, -0.27782057523535084065932004339e+01,
     -0.60196695231264120758267380846e+02, 0.84320405506677161018159903784e+02, 0.11992291136182789328035130030e+02},
    {-0.25693933462703749003312586129e+02, -0.15418974869023643374053993627e+03, -0.23152937917604549567536039109e+03,
     0.35763911791061412378285349910e+03, 0.93405324183624310003907691704e+02, -0.37458323136451633156875139351e+02,
     0.10409964950896230045147246184e+03, 0.29840293426660503123344363579e+02, -0.43533456590011143754432175058e+02,
     0.96324553959188282948394950600e+02, -0.39177261675615439165231486172e+02, -0.14972683625798562581422125276e+03},
};

constexpr std::size_t kDenseRows = 7;

// The continuous extension at the share s of the step: y out of its start and seven rows, each of n numbers.
template <class Row>
void extend(double s, std::size_t n, const double* start, const Row* rows, double* y) {
    const double r = 1 - s;
    for (std::size_t i = 0; i < n; ++i) {
        double v = rows[6][i] * s;
        v = (v + rows[5][i]) * r;
        v = (v + rows[4][i]) * s;
        v = (v + rows[3][i]) * r;
        v = (v + rows[2][i]) * s;
        v = (v + rows[1][i]) * r;
        v = (v + rows[0][i]) * s;
        y[i] = start[i] + v;
    }
}

// Start, end and the seven rows, one after the other.
class StoredRk8 final : public StoredSegment {
  public:
    explicit StoredRk8(int size) : n_(static_cast<std::size_t>(size)) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        if (numbers.size() != (2 + kDenseRows) * n_)
            throw std::invalid_argument("a segment of the trajectory has the wrong length");
        t0 = begin;
        t1 = end;
        start_ = numbers.data();
        for (std::size_t i = 0; i < kDenseRows; ++i) rows_[i] = numbers.data() + (2 + i) * n_;
    }
    void value(double t, double* y) const override {
        if (t == t1)
            std::copy_n(start_ + n_, n_, y);
        else
            extend((t - t0) / (t1 - t0), n_, start_, rows_.data(), y);
    }

  private:
    std::size_t n_;
    const double* start_ = nullptr;
    std::array<const double*, kDenseRows> rows_{};
};

class Rk8 final : public Integrator, private Segment {
  public:
    Rk8(Ode& ode, double rtol, double atol)
        : ode_(ode), rtol_(rtol), atol_(atol), n_(static_cast<std::size_t>(ode.size)) {
        for (auto& k : k_) k.assign(n_, 0);
        for (auto& c : dense_) c.assign(n_, 0);
        y_.assign(n_, 0);
        end_.assign(n_, 0);
        work_.assign(n_, 0);
    }

    void start(double t, const double* y) override {
        std::copy_n(y, n_, end_.begin());
        t1 = t;
        evaluate(t, end_.data(), k_[12].data());
        next_ = limited(initial_step());
    }

    const Segment& step() override {
        t0 = t1;
        y_ = end_;
        k_[0] = k_[12];
        accept(false);
        ++counters.steps;
        return *this;
    }

    const Segment& shorten(double at) override {
        BEAMCAM_ASSERT(at > t0);  // an event that the step just missed may lie a little beyond it
        // Exactly the step that would have been taken with this size. The longer one may have passed the test by
        // chance.
        const double error = advance(at - t0);
        if (error > 1) {
            reject(at - t0, error);
            accept(true);
            return *this;
        }
        arrive(at);
        return *this;
    }

    void value(double t, double* y) const override {
        if (t == t1) {
            std::copy(end_.begin(), end_.end(), y);
            return;
        }
        if (!dense_known_) const_cast<Rk8*>(this)->build_dense();
        extend((t - t0) / (t1 - t0), n_, y_.data(), dense_.data(), y);
    }

    SegmentKind numbers(std::vector<double>& out) const override {
        if (!dense_known_) const_cast<Rk8*>(this)->build_dense();
        out.insert(out.end(), y_.begin(), y_.end());
        out.insert(out.end(), end_.begin(), end_.end());
        for (const std::vector<double>& row : dense_) out.insert(out.end(), row.begin(), row.end());
        return SegmentKind::rk8;
    }

  private:
    // Tries steps from (t0, y_) until one keeps to the tolerance.
    void accept(bool rejected) {
        double error = std::numeric_limits<double>::infinity();
        for (;;) {
            double h = next_;
            const bool to_stop = t0 + 1.01 * h >= stop_;
            if (to_stop) h = stop_ - t0;
            if (!(std::fabs(h) > 4e-16 * std::max(std::fabs(t0), 1e-300)) || !std::isfinite(h))
                throw StepFailure(vanished(std::isfinite(error)));
            error = advance(h);
            if (error <= 1) {
                const double factor =
                    error == 0 ? kRk8Growth : std::clamp(kRk8Safety * std::pow(error, -0.125), kRk8Shrink, kRk8Growth);
                if (!to_stop || h * factor < next_) next_ = h * (rejected ? std::min(factor, 1.0) : factor);
                break;
            }
            reject(h, error);
            rejected = true;
        }
        arrive(t1);
    }
    void reject(double h, double error) {
        next_ = h * (std::isfinite(error) ? std::max(kRk8Safety * std::pow(error, -0.125), kRk8Shrink) : 0.1);
        ++counters.rejected;
    }
    void arrive(double t) {
        t1 = t;
        dense_known_ = false;
        evaluate(t1, end_.data(), k_[12].data());
    }

    void evaluate(double t, const double* y, double* dy) {
        ode_.rhs(t, y, dy);
        ++counters.rhs;
    }

    void stage(int index, double h) {
        const TableauRow& row = kRows[static_cast<std::size_t>(index)];
        work_ = y_;
        for (int e = 0; e < row.count; ++e) {
            const TableauEntry& entry = row.entries[static_cast<std::size_t>(e)];
            const double a = h * entry.a;
            const double* k = k_[static_cast<std::size_t>(entry.stage)].data();
            for (std::size_t i = 0; i < n_; ++i) work_[i] += a * k[i];
        }
        evaluate(t0 + row.c * h, work_.data(), k_[static_cast<std::size_t>(index)].data());
    }

    // end_ ← solution at t0 + h; returns the error in units of the tolerance.
    double advance(double h) {
        t1 = t0 + h;
        for (int i = 1; i < kStages; ++i) stage(i, h);
        double error5 = 0, error3 = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            double sum = 0, e5 = 0;
            for (std::size_t j = 0; j < std::size(kUsed); ++j) {
                const double k = k_[static_cast<std::size_t>(kUsed[j])][i];
                sum += kB[j] * k;
                e5 += kE5[j] * k;
            }
            end_[i] = y_[i] + h * sum;
            if (i >= static_cast<std::size_t>(ode_.controlled)) continue;
            const double e3 = sum - kBhh0 * k_[0][i] - kBhh8 * k_[8][i] - kBhh11 * k_[11][i];
            const double scale = atol_ + rtol_ * std::max(std::fabs(y_[i]), std::fabs(end_[i]));
            error5 += (e5 / scale) * (e5 / scale);
            error3 += (e3 / scale) * (e3 / scale);
        }
        double denominator = error5 + 0.01 * error3;
        if (denominator <= 0) denominator = 1;
        const double error = std::fabs(h) * error5 / std::sqrt(ode_.controlled * denominator);
        return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    }

    void build_dense() {
        dense_known_ = true;
        const double h = t1 - t0;
        for (int i = 13; i < kAll; ++i) stage(i, h);
        for (std::size_t i = 0; i < n_; ++i) {
            const double difference = end_[i] - y_[i], bend = h * k_[0][i] - difference;
            dense_[0][i] = difference;
            dense_[1][i] = bend;
            dense_[2][i] = difference - h * k_[12][i] - bend;
            for (std::size_t row = 0; row < 4; ++row) {
                double sum = 0;
                for (std::size_t j = 0; j < std::size(kDenseStages); ++j)
                    sum += kD[row][j] * k_[static_cast<std::size_t>(kDenseStages[j])][i];
                dense_[3 + row][i] = h * sum;
            }
        }
    }

    // Book, II.4: a step for which an Euler step moves y by about 1 % of its tolerance-weighted size.
    double initial_step() {
        double size = 0, slope = 0;
        const auto scale = [&](std::size_t i) { return atol_ + rtol_ * std::fabs(end_[i]); };
        for (std::size_t i = 0; i < static_cast<std::size_t>(ode_.controlled); ++i) {
            size += std::pow(end_[i] / scale(i), 2);
            slope += std::pow(k_[12][i] / scale(i), 2);
        }
        double h = size < 1e-10 || slope < 1e-10 ? 1e-6 : 0.01 * std::sqrt(size / slope);
        for (std::size_t i = 0; i < n_; ++i) work_[i] = end_[i] + h * k_[12][i];
        evaluate(t1 + h, work_.data(), k_[1].data());
        double bend = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(ode_.controlled); ++i)
            bend += std::pow((k_[1][i] - k_[12][i]) / scale(i), 2);
        bend = std::sqrt(bend) / h;
        const double steepest = std::max(bend, std::sqrt(slope));
        const double second = steepest <= 1e-15 ? std::max(1e-6, h * 1e-3) : std::pow(0.01 / steepest, 0.125);
        return std::min(100 * h, second);
    }

    Ode& ode_;
    double rtol_, atol_;
    std::size_t n_;
    std::array<std::vector<double>, kAll> k_;
    std::array<std::vector<double>, kDenseRows> dense_;
    std::vector<double> y_, end_, work_;
    double next_ = 0;
    bool dense_known_ = false;
};

}  // namespace

std::unique_ptr<Integrator> make_rk8(Ode& ode, double rtol, double atol) {
    return std::make_unique<Rk8>(ode, rtol, atol);
}

std::unique_ptr<StoredSegment> make_stored_rk8(int size) { return std::make_unique<StoredRk8>(size); }

}  // namespace beamcam::sim
