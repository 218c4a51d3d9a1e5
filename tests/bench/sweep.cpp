// The cost of a sweep: points by closed forms and by general integration, on one thread and on two; then its tables.
// bench_sweep [ROWS [FOLDER]]: rows of the tables (default 10⁷; 0: none), written to the folder (default: that of
// temporary files). Prints CSV: case,threads,points,turns,impacts,cpu_s,wall_s,us_per_impact,ms_per_second,peak_MiB,
// and table,rows,columns,cpu_s,wall_s,MB,peak_MiB. The peak is that of the program so far.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "scenes/format/reader.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/sweep/make_points.hpp"

using namespace beamcam;
namespace fs = std::filesystem;

namespace {

struct Stopwatch {
    std::clock_t cpu_from = std::clock();
    std::chrono::steady_clock::time_point from = std::chrono::steady_clock::now();
    double cpu() const { return static_cast<double>(std::clock() - cpu_from) / CLOCKS_PER_SEC; }
    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count(); }
};

double peak_mebibytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

// A scene of the paper's system over the speed of its cam; the sweep's seed is "same".
std::string swept(const char* beam, const char* contact, const char* range, const char* transient, const char* keep,
                  bool exponents = false) {
    return fmt::format(
        R"({{"beam": {}, "contact": {}, "cam": {{"eccentricity": "2 mm"}}, "initial": {{"angle": 0.5}},
            "sweep": {{"over": [{{"key": "cam.speed", {}}}], "transient": {{"cam_turns": {}}}, "keep": {{"cam_turns": {}}},
                       "exponents": {}}}}})",
        beam, contact, range, transient, keep, exponents);
}

void points(const char* name, const std::string& text, int threads, const fs::path& folder) {
    const scenes::Reading reading = scenes::read_scene({"benchmark", text, true});
    const scenes::SweepGrid grid(*reading.scene);
    output::PointStore store(folder / "points.part", shape_of(grid), head_of(grid, {}));
    scenes::Progress progress(scenes::ProgressStyle::none);
    const Stopwatch watch;
    make_points(grid, {}, threads, progress, store);
    const double cpu = watch.cpu(), wall = watch.wall();
    double turns = 0, impacts = 0, seconds = 0;
    for (std::uint64_t k = 0; k < grid.points(); ++k) {
        const sim::SampleSpan span = sample_span(grid.problem(k), grid.sampling());
        turns += static_cast<double>(span.to);
        seconds += span.t_to();
        // Impacts per turn of the transient as in a kept one.
        const double samples = static_cast<double>(store.numbers(k)) / sim::kSampleColumns;
        impacts += samples * static_cast<double>(span.to) / static_cast<double>(span.kept());
    }
    store.remove();
    fmt::print("{},{},{},{:.0f},{:.0f},{:.2f},{:.2f},{:.2f},{:.3f},{:.0f}\n", name, threads, grid.points(), turns,
               impacts, cpu, wall, 1e6 * cpu / impacts, 1e3 * cpu / seconds, peak_mebibytes());
    std::fflush(stdout);
}

// Numbers that compress as badly as those of a motion.
output::SweepData made_up(std::uint64_t rows) {
    constexpr std::uint64_t kRows = 1000;  // of a point
    output::SweepData data;
    data.axes = {{"cam.speed", "rad/s", std::vector<double>(std::max<std::uint64_t>(1, rows / kRows))}};
    for (std::size_t i = 0; i < data.axes[0].values.size(); ++i) data.axes[0].values[i] = static_cast<double>(i);
    for (int c = 1; c <= 8; ++c) data.columns.push_back({fmt::format("c{}", c), "rad", "Made up"});
    data.classes = {"periodic"};
    data.has = [](std::uint64_t) { return true; };
    data.rows = [](std::uint64_t) { return kRows; };
    data.read = [](std::uint64_t k) {
        output::StoredPoint p;
        p.point = k;
        p.samples.resize(8 * kRows);
        std::uint64_t state = k;
        for (double& value : p.samples) {
            state = state * 6364136223846793005 + 1442695040888963407;
            value = 0.4 + 0.01 * static_cast<double>(state >> 11) * 0x1p-53;
        }
        return p;
    };
    return data;
}

void table(const char* ending, std::uint64_t rows, const fs::path& folder) {
    const output::SweepData data = made_up(rows);
    const fs::path file = folder / (std::string("table") + ending);
    const Stopwatch watch;
    write_sweep(output::FileTarget(file), data);
    const double cpu = watch.cpu(), wall = watch.wall();
    fmt::print("{},{},8,{:.2f},{:.2f},{:.0f},{:.0f}\n", ending, data.rows_in_all(), cpu, wall,
               1e-6 * static_cast<double>(fs::file_size(file)), peak_mebibytes());
    std::fflush(stdout);
    fs::remove(file);
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint64_t rows = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
    const fs::path folder =
        fs::path(argc > 2 ? argv[2] : fs::temp_directory_path()) / fmt::format("bench-sweep-{}", getpid());
    fs::create_directory(folder);
    constexpr const char *kRigid = R"({"model": "rigid"})", *kTwoModes = R"({"model": "first-order", "modes": 2})",
                         *kEightModes = R"({"model": "first-order", "modes": 8})",
                         *kNewton = R"({"model": "restitution", "restitution": 0.5})",
                         *kCompliant = R"({"model": "compliant"})";
    fmt::print("case,threads,points,turns,impacts,cpu_s,wall_s,us_per_impact,ms_per_second,peak_MiB\n");
    const std::string rigid = swept(kRigid, kNewton, R"("from": 38, "to": 60, "count": 1000)", "450", "50");
    for (const int threads : {1, 2}) points("rigid with restitution", rigid, threads, folder);
    points("the same with 20 000 values", swept(kRigid, kNewton, R"("from": 38, "to": 60, "count": 20000)", "15", "10"),
           1, folder);
    const char* range = R"("from": 44, "to": 52, "count": 17)";
    for (const int threads : {1, 2})
        points("first order 2 modes compliant", swept(kTwoModes, kCompliant, range, "60", "10"), threads, folder);
    points("the same with exponents", swept(kTwoModes, kCompliant, range, "40", "30", true), 1, folder);
    points("first order 8 modes compliant", swept(kEightModes, kCompliant, range, "20", "10"), 1, folder);
    points("rigid compliant", swept(kRigid, kCompliant, range, "60", "10"), 1, folder);
    if (rows > 0) fmt::print("table,rows,columns,cpu_s,wall_s,MB,peak_MiB\n");
    for (const char* ending : {".nc", ".npz", ".csv"})
        if (rows > 0) table(ending, rows, folder);
    fs::remove_all(folder);
    return 0;
}
