#include "sim/beam/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/beam/table_smoothing.hpp"

namespace beamcam::sim {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

// Second derivatives of the natural cubic spline through (t, y) (Thomas algorithm).
std::vector<double> natural_spline(const std::vector<double>& t, const std::vector<double>& y) {
    const std::size_t n = t.size();
    std::vector<double> m(n, 0), upper(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double left = t[i] - t[i - 1], right = t[i + 1] - t[i];
        const double rhs = 6 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left);
        const double pivot = 2 * (left + right) - left * upper[i - 1];
        upper[i] = right / pivot;
        m[i] = (rhs - left * m[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 1;) m[i] -= upper[i] * m[i + 1];
    return m;
}

std::size_t interval(const std::vector<double>& t, double at) {
    const auto after = std::upper_bound(t.begin() + 1, t.end() - 1, at);
    return static_cast<std::size_t>(after - t.begin()) - 1;
}

// θ̇ = (Ω/T)(s − sin(ks)/k), k = 2π/T, at the time s after the spin-up began (S22).
HubMotion spun_up(const SpinUp& law, double s) {
    const double T = law.duration, k = 2 * std::numbers::pi / T, slope = law.speed / T;
    if (s <= 0) return {};
    if (s >= T) return {law.speed * (s - 0.5 * T), law.speed, 0};
    return {slope * (0.5 * s * s - (1 - std::cos(k * s)) / (k * k)), slope * (s - std::sin(k * s) / k),
            slope * (1 - std::cos(k * s))};
}

}  // namespace

Drive later(const Drive& drive, double t) {
    Drive out = drive;
    const auto move = [t](std::vector<double>& times) {
        for (double& each : times) each -= t;
    };
    std::visit(Overloaded{[&](HarmonicTorque& law) {
                              const double turns = law.frequency * t;
                              law.phase += 2 * std::numbers::pi * (turns - std::floor(turns));
                          },
                          [&](TorqueTable& law) { move(law.t); }, [&](AngleTable& law) { move(law.t); },
                          [&](SpinUp& law) { law.start -= t; }, [](auto&) {}},
               out);
    return out;
}

DriveLaw::DriveLaw(const Drive& drive, double start_angle)
    : drive_(drive), start_(start_angle), prescribed_(is_prescribed(drive)) {
    has_torque_ = !prescribed_ && !std::holds_alternative<FreeDrive>(drive);
    if (const auto* law = std::get_if<SpinUp>(&drive)) kinks_ = {law->start, law->start + law->duration};
    if (const auto* law = std::get_if<TorqueTable>(&drive)) kinks_ = law->t;
    if (auto* law = std::get_if<AngleTable>(&drive_)) {
        const double error = law->smooth.value_or(table_step(law->theta).value_or(0) / std::sqrt(12.0));
        law->theta = smoothed(law->t, law->theta, error);
        kinks_ = law->t;
        spline_ = natural_spline(law->t, law->theta);
    }
    std::erase_if(kinks_, [](double t) { return !(t > 0); });
}

double DriveLaw::torque(double t) const {
    return std::visit(Overloaded{[&](const ConstantTorque& law) { return law.value; },
                                 [&](const HarmonicTorque& law) {
                                     return law.amplitude *
                                            std::sin(2 * std::numbers::pi * law.frequency * t + law.phase);
                                 },
                                 [&](const TorqueTable& law) {
                                     if (t <= law.t.front()) return law.torque.front();
                                     if (t >= law.t.back()) return law.torque.back();
                                     const std::size_t i = interval(law.t, t);
                                     const double s = (t - law.t[i]) / (law.t[i + 1] - law.t[i]);
                                     return law.torque[i] + s * (law.torque[i + 1] - law.torque[i]);
                                 },
                                 [](const auto&) { return 0.0; }},
                      drive_);
}

HubMotion DriveLaw::motion(double t) const {
    return std::visit(
        Overloaded{
            [&](const ConstantSpeed& law) {
                return HubMotion{start_ + law.speed * t, law.speed, 0};
            },
            [&](const SpinUp& law) {
                HubMotion m = spun_up(law, t - law.start);
                m.angle += start_ - spun_up(law, -law.start).angle;
                return m;
            },
            [&](const AngleTable& law) {
                const double at = std::clamp(t, law.t.front(), law.t.back());
                const std::size_t i = interval(law.t, at);
                const double h = law.t[i + 1] - law.t[i], b = (at - law.t[i]) / h, a = 1 - b;
                const double ma = spline_[i], mb = spline_[i + 1];
                HubMotion m;
                m.angle =
                    a * law.theta[i] + b * law.theta[i + 1] + ((a * a * a - a) * ma + (b * b * b - b) * mb) * h * h / 6;
                m.rate = (law.theta[i + 1] - law.theta[i]) / h + ((1 - 3 * a * a) * ma + (3 * b * b - 1) * mb) * h / 6;
                m.acceleration = a * ma + b * mb;
                m.angle += m.rate * (t - at);  // outside the table: constant speed, as the natural spline has there
                return m;
            },
            [](const auto&) { return HubMotion{}; }},
        drive_);
}

}  // namespace beamcam::sim
