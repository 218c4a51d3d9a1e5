// Run time against error of one second of the default scene, beamcam's integrators and the yardstick side by side: 2, 8
// and 20 modes, cam speeds 0, 1 and 5 rad/s, θ at 1000 instants to 1e-4, 1e-6 and 1e-8 of each program's own tight
// reference, and the instants of the impacts but not their peaks. Then the other models with two shapes, without the
// yardstick, up to 0.4 s, as long as the motion does not depend on rounding. Every method runs at the loosest tolerance
// of a ladder from which on it keeps that error. Same process, same flags, repeats interleaved, medians. Prints the
// table; --csv FILE writes the numbers under a line that names the machine.
//
//   bench_sim [--modes 2,8,20] [--speeds 0,1,5] [--models zeroth-order,second-order,exact] [--repeats 5] [--csv FILE]
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "sim/run/simulate.hpp"
#include "tests/bench/yardstick.hpp"

using namespace beamcam;

namespace {

struct Answer {
    std::vector<double> theta;
    long steps = 0, rhs = 0, impacts = 0;
};
using Method = std::function<Answer(double rtol)>;

struct Point {
    double rtol = 0, error = 0;
    Answer answer;
};

struct Scene {
    sim::Problem problem;
    std::vector<double> times;  // of θ [s]
};

Scene scene(sim::ModelKind model, int modes, double speed, int samples) {
    Scene out;
    out.problem.beam.model = model;
    out.problem.beam.modes = modes;
    out.problem.cam->speed = speed;
    for (int k = 1; k <= samples; ++k) out.times.push_back(k * 1e-3);
    return out;
}

Method beamcam_by(Scene scene, sim::Method method) {
    scene.problem.solver.method = method;
    return [scene](double rtol) mutable {
        sim::Problem& problem = scene.problem;
        problem.solver.rtol = rtol;
        problem.solver.atol = 1e-3 * rtol;
        sim::Request request;
        request.tables.push_back({scene.times, {{sim::ChannelKind::theta, 0}}});
        request.impact_peaks = false;  // which the yardstick does not look for either
        const sim::Result result = sim::simulate(problem, request);
        return Answer{result.tables[0].values[0], result.counters.steps, result.counters.rhs_evaluations,
                      static_cast<long>(result.impacts.size())};
    };
}

Method yardstick(const Scene& scene) {
    return [scene](double rtol) {
        const bench::YardstickRun run = bench::run_yardstick(scene.problem, rtol, 1e-3 * rtol, scene.times);
        return Answer{run.theta, run.steps, run.rhs, run.impacts};
    };
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return INFINITY;  // it gave up
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::fabs(a[i] - b[i]));
    return worst;
}

// Time of the processor, so that a busy machine disturbs little.
double clock_now() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}
double milliseconds(const Method& method, double rtol) {
    const double start = clock_now();
    method(rtol);
    return clock_now() - start;
}

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

// Loosest tolerance from which on every tighter one keeps the error, for each target; rtol 0 where none does.
std::vector<Point> choose(const Method& method, const std::vector<double>& reference, std::span<const double> targets,
                          double tightest) {
    std::vector<Point> ladder, chosen(targets.size());
    for (int k = 4;; ++k) {
        const double rtol = std::pow(10, -0.5 * k);
        if (rtol < 0.99 * tightest) break;
        Point point{rtol, 0, {}};
        try {
            point.answer = method(rtol);
            point.error = difference(point.answer.theta, reference);
        } catch (const std::exception&) {
            point.error = INFINITY;
        }
        ladder.push_back(point);
        if (point.error < 0.1 * targets.back()) break;
    }
    for (std::size_t i = 0; i < targets.size(); ++i)
        for (std::size_t k = ladder.size(); k-- > 0 && ladder[k].error <= targets[i];) chosen[i] = ladder[k];
    return chosen;
}

std::string machine() {
    std::ifstream info("/proc/cpuinfo");
    std::string line, cpu = "unknown";
    while (std::getline(info, line))
        if (line.rfind("model name", 0) == 0) {
            cpu = line.substr(line.find(':') + 2);
            break;
        }
    std::string isa = "baseline";
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) isa = "avx2";
    if (__builtin_cpu_supports("avx512f")) isa = "avx512f";
#endif
    return fmt::format("# machine: {}, vectors {}, compiler {}", cpu, isa, __VERSION__);
}

struct Options {
    std::vector<double> modes{2, 8, 20}, speeds{0, 1, 5};
    std::string models = "zeroth-order,second-order,exact";
    int repeats = 5;
    std::FILE* csv = nullptr;
};

std::vector<double> numbers(const char* text) {
    std::vector<double> out;
    for (char* end = nullptr; *text; text = *end ? end + 1 : end) out.push_back(std::strtod(text, &end));
    return out;
}

Options options_of(int argc, char** argv) {
    Options out;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--modes")) out.modes = numbers(argv[i + 1]);
        if (!std::strcmp(argv[i], "--speeds")) out.speeds = numbers(argv[i + 1]);
        if (!std::strcmp(argv[i], "--models")) out.models = argv[i + 1];
        if (!std::strcmp(argv[i], "--repeats")) out.repeats = std::atoi(argv[i + 1]);
        if (!std::strcmp(argv[i], "--csv")) out.csv = std::fopen(argv[i + 1], "w");
    }
    return out;
}

struct Entry {
    std::string name;
    Method method;
    double tightest;            // tolerance of its ladder
    std::vector<Point> points;  // for each target
};

constexpr double kTargets[] = {1e-4, 1e-6, 1e-8};

std::vector<Entry> entries_of(const Scene& scene) {
    const sim::Beam& beam = scene.problem.beam;
    std::vector<Entry> out;
    if (beam.model == sim::ModelKind::first_order) out.push_back({"yardstick", yardstick(scene), 1e-11, {}});
    if (beam.model == sim::ModelKind::first_order && beam.modes == 2) {
        Scene clamped = scene;
        clamped.problem.beam.basis = sim::Basis::cantilever;
        out.push_back({"yardstick-cantilever", yardstick(clamped), 1e-11, {}});
    }
    out.push_back({"auto", beamcam_by(scene, sim::Method::automatic), 1e-12, {}});
    out.push_back({"rk8", beamcam_by(scene, sim::Method::rk8), 1e-11, {}});
    const std::vector<double> own = beamcam_by(scene, sim::Method::rk8)(1e-12).theta;
    for (Entry& e : out)
        e.points =
            choose(e.method, e.name.starts_with("yardstick") ? e.method(1e-12).theta : own, kTargets, e.tightest);
    return out;
}

// Milliseconds of each entry at its tolerance for a target; 0 where it does not reach it.
std::vector<double> medians(const std::vector<Entry>& entries, std::size_t target, int repeats) {
    std::vector<std::vector<double>> times(entries.size());
    for (int r = 0; r < repeats; ++r)
        for (std::size_t e = 0; e < entries.size(); ++e) {
            if (entries[e].points[target].rtol == 0) continue;
            const int inner = entries[e].name == "auto" ? 5 : 1;
            for (int k = 0; k < inner; ++k)
                times[e].push_back(milliseconds(entries[e].method, entries[e].points[target].rtol));
        }
    std::vector<double> out;
    for (const std::vector<double>& each : times) out.push_back(each.empty() ? 0 : median(each));
    return out;
}

// The ratios are those to the yardstick, or else to rk8.
void compare(const Scene& scene, const Options& options) {
    const sim::Problem& p = scene.problem;
    const std::vector<Entry> entries = entries_of(scene);
    for (std::size_t t = 0; t < std::size(kTargets); ++t) {
        const std::vector<double> ms = medians(entries, t, options.repeats);
        const double base = entries.front().name == "yardstick" ? ms.front() : ms.back();
        for (std::size_t e = 0; e < entries.size(); ++e) {
            const Point& point = entries[e].points[t];
            fmt::print("{:12} {:5} {:5} {:6.0e} | {:20} ", name(p.beam.model), p.beam.modes, p.cam->speed, kTargets[t],
                       entries[e].name);
            if (point.rtol == 0) {
                fmt::print("not reached\n");
                continue;
            }
            const Answer& a = point.answer;
            fmt::print("{:.0e} {:9.1e} {:8.3f} {:8} {:8} {:7} | {:.1f}\n", point.rtol, point.error, ms[e], a.steps,
                       a.rhs, a.impacts, base / ms[e]);
            if (options.csv)
                fmt::print(options.csv, "{},{},{},{:.0e},{},{:.3e},{:.3e},{:.4f},{},{},{}\n", name(p.beam.model),
                           p.beam.modes, p.cam->speed, kTargets[t], entries[e].name, point.rtol, point.error, ms[e],
                           a.steps, a.rhs, a.impacts);
        }
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const Options options = options_of(argc, argv);
    fmt::print("{}\n", machine());
    if (options.csv)
        fmt::print(options.csv, "{}\nmodel,modes,speed,target,method,rtol,error,ms,steps,rhs,impacts\n", machine());
    fmt::print(
        "model        modes speed  error | method               rtol     error       ms    steps      rhs impacts | "
        "ratio\n");
    for (const double modes : options.modes)
        for (const double speed : options.speeds)
            compare(scene(sim::ModelKind::first_order, static_cast<int>(modes), speed, 1000), options);
    for (const auto& model : names(sim::ModelKind{}))
        if (("," + options.models + ",").find(fmt::format(",{},", model.name)) != std::string::npos)
            compare(scene(model.value, 2, 1, 400), options);
    if (options.csv) std::fclose(options.csv);
}
