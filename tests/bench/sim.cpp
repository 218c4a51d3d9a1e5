// Run time against error of one second of the default scene, beamcam's integrators and the yardstick side by side: 2, 8
// and 20 modes, cam speeds 0, 1 and 5 rad/s, θ at 1000 instants to 1e-4, 1e-6 and 1e-8 of each program's own tight
// reference, and the instants of the impacts but not their peaks. Every method runs at the loosest tolerance of a
// ladder from which on it keeps that error. Same process, same flags, repeats interleaved, medians. Prints the table;
// --csv FILE writes the numbers under a line that names the machine.
//
//   bench_sim [--modes 2,8,20] [--speeds 0,1,5] [--repeats 5] [--csv FILE]
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
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

std::vector<double> instants() {
    std::vector<double> times;
    for (int k = 1; k <= 1000; ++k) times.push_back(k * 1e-3);
    return times;
}

sim::Problem scene(int modes, double speed) {
    sim::Problem problem;
    problem.beam.modes = modes;
    problem.cam->speed = speed;
    return problem;
}

Method beamcam_by(sim::Problem problem, sim::Method method) {
    problem.solver.method = method;
    return [problem](double rtol) mutable {
        problem.solver.rtol = rtol;
        problem.solver.atol = 1e-3 * rtol;
        sim::Request request;
        request.tables.push_back({instants(), {{sim::ChannelKind::theta, 0}}});
        request.impact_peaks = false;  // which the yardstick does not look for either
        const sim::Result result = sim::simulate(problem, request);
        return Answer{result.tables[0].values[0], result.counters.steps, result.counters.rhs_evaluations,
                      static_cast<long>(result.impacts.size())};
    };
}

Method yardstick(const sim::Problem& problem) {
    return [problem](double rtol) {
        const bench::YardstickRun run = bench::run_yardstick(problem, rtol, 1e-3 * rtol, instants());
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
std::vector<Point> choose(const Method& method, const std::vector<double>& reference,
                          const std::vector<double>& targets, double tightest) {
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

std::vector<double> numbers(const char* text) {
    std::vector<double> out;
    for (char* end = nullptr; *text; text = *end ? end + 1 : end) out.push_back(std::strtod(text, &end));
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<double> modes{2, 8, 20}, speeds{0, 1, 5};
    const std::vector<double> targets{1e-4, 1e-6, 1e-8};
    int repeats = 5;
    std::FILE* csv = nullptr;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--modes")) modes = numbers(argv[i + 1]);
        if (!std::strcmp(argv[i], "--speeds")) speeds = numbers(argv[i + 1]);
        if (!std::strcmp(argv[i], "--repeats")) repeats = std::atoi(argv[i + 1]);
        if (!std::strcmp(argv[i], "--csv")) csv = std::fopen(argv[i + 1], "w");
    }
    fmt::print("{}\n", machine());
    if (csv) fmt::print(csv, "{}\nmodes,speed,target,method,rtol,error,ms,steps,rhs,impacts\n", machine());
    fmt::print("modes speed  error | method               rtol     error       ms    steps      rhs impacts | ratio\n");
    for (const double n : modes)
        for (const double speed : speeds) {
            struct Entry {
                std::string name;
                Method method;
                std::vector<double> reference;
                double tightest;
                std::vector<Point> points;
            };
            const sim::Problem problem = scene(static_cast<int>(n), speed);
            std::vector<Entry> entries;
            entries.push_back({"yardstick", yardstick(problem), {}, 1e-11, {}});
            if (n == 2) {
                sim::Problem clamped = problem;
                clamped.beam.basis = sim::Basis::cantilever;
                entries.push_back({"yardstick-cantilever", yardstick(clamped), {}, 1e-11, {}});
            }
            entries.push_back({"auto", beamcam_by(problem, sim::Method::automatic), {}, 1e-12, {}});
            entries.push_back({"rk8", beamcam_by(problem, sim::Method::rk8), {}, 1e-11, {}});
            const std::vector<double> own = beamcam_by(problem, sim::Method::rk8)(1e-12).theta;
            for (Entry& e : entries) {
                e.reference = e.name.starts_with("yardstick") ? e.method(1e-12).theta : own;
                e.points = choose(e.method, e.reference, targets, e.tightest);
            }
            for (std::size_t t = 0; t < targets.size(); ++t) {
                std::vector<std::vector<double>> times(entries.size());
                for (int r = 0; r < repeats; ++r)
                    for (std::size_t e = 0; e < entries.size(); ++e) {
                        if (entries[e].points[t].rtol == 0) continue;
                        const int inner = entries[e].name == "auto" ? 5 : 1;
                        for (int k = 0; k < inner; ++k)
                            times[e].push_back(milliseconds(entries[e].method, entries[e].points[t].rtol));
                    }
                double base = 0;
                for (std::size_t e = 0; e < entries.size(); ++e) {
                    const Point& p = entries[e].points[t];
                    if (p.rtol == 0) {
                        fmt::print("{:5} {:5} {:6.0e} | {:20} not reached\n", n, speed, targets[t], entries[e].name);
                        continue;
                    }
                    const double ms = median(times[e]);
                    if (e == 0) base = ms;
                    fmt::print("{:5} {:5} {:6.0e} | {:20} {:.0e} {:9.1e} {:8.3f} {:8} {:8} {:7} | {:.1f}\n", n, speed,
                               targets[t], entries[e].name, p.rtol, p.error, ms, p.answer.steps, p.answer.rhs,
                               p.answer.impacts, base / ms);
                    if (csv)
                        fmt::print(csv, "{},{},{:.0e},{},{:.3e},{:.3e},{:.4f},{},{},{}\n", n, speed, targets[t],
                                   entries[e].name, p.rtol, p.error, ms, p.answer.steps, p.answer.rhs,
                                   p.answer.impacts);
                }
                std::fflush(stdout);
            }
        }
    if (csv) std::fclose(csv);
}
