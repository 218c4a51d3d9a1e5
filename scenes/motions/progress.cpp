#include "scenes/motions/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace beamcam::scenes {
namespace {

// Shortest time between two updates.
constexpr double kBarInterval = 0.1, kPlainInterval = 5, kJsonInterval = 0.5;  // [s]

std::string clock_text(double seconds) {
    const long s = std::lround(std::ceil(seconds));
    if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string count_text(double value, const std::string& unit) {
    return unit == "s" ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
}

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value && std::string_view(value) != "0" && std::string_view(value) != "false";
}

}  // namespace

ProgressStyle resolve(ProgressStyle style) {
    if (style != ProgressStyle::automatic) return style;
    const char* term = std::getenv("TERM");
    const bool dumb = !term || std::string_view(term) == "dumb";
    return isatty(STDERR_FILENO) && !dumb && !is_set("CI") ? ProgressStyle::bar : ProgressStyle::plain;
}

void Progress::begin(std::string stage, std::optional<double> total, std::string unit) {
    end();
    const std::lock_guard lock(mutex_);
    stage_ = std::move(stage);
    unit_ = std::move(unit);
    total_ = total;
    done_ = 0;
    open_ = true;
    started_ = shown_ = Clock::now();
}

bool Progress::reach(double done) {
    const std::lock_guard lock(mutex_);
    const bool goes_on = !output::interrupted();
    if (!open_ || style_ == ProgressStyle::none) return goes_on;
    done_ = std::max(done_, done);
    const double since = std::chrono::duration<double>(Clock::now() - shown_).count();
    const double interval = style_ == ProgressStyle::bar    ? kBarInterval
                            : style_ == ProgressStyle::json ? kJsonInterval
                                                            : kPlainInterval;
    if (since >= interval) show(done_, false);
    return goes_on;
}

void Progress::end() {
    const std::lock_guard lock(mutex_);
    if (!open_) return;
    open_ = false;
    // A log omits short stages; programs get all of them.
    if (style_ == ProgressStyle::json || line_is_open_) show(done_, true);
    if (line_is_open_) std::fputc('\n', out_);
    line_is_open_ = false;
    std::fflush(out_);
}

void Progress::show(double done, bool last) {
    shown_ = Clock::now();
    const double elapsed = std::chrono::duration<double>(shown_ - started_).count();
    switch (style_) {
        case ProgressStyle::automatic:
        case ProgressStyle::none:
            break;
        case ProgressStyle::bar:
            show_bar(done, elapsed, last);
            break;
        case ProgressStyle::plain:
            show_plain(done, elapsed);
            break;
        case ProgressStyle::json:
            show_json(done, elapsed, last);
            break;
    }
    std::fflush(out_);
}

std::string Progress::amount(double done) const {
    const std::string of = total_ ? "/" + count_text(*total_, unit_) : "";
    return count_text(done, unit_) + of + " " + unit_;
}

std::optional<double> Progress::left(double done, double elapsed) const {
    if (!total_ || done <= 0) return std::nullopt;
    return elapsed * std::max(0.0, *total_ - done) / done;
}

void Progress::show_bar(double done, double elapsed, bool last) {
    constexpr int kCells = 24;
    std::string line = fmt::format("\r\x1b[K{:<9} ", stage_);
    if (total_) {
        const double share = *total_ > 0 ? std::clamp(done / *total_, 0.0, 1.0) : 1;
        const int filled = static_cast<int>(share * kCells);
        line += fmt::format("[{:=<{}}{:<{}}] ", "", filled, "", kCells - filled);
    }
    line += amount(done);
    if (elapsed > 0 && done > 0) line += fmt::format("  {:.3g}/s", done / elapsed);
    if (last)
        line += fmt::format("  in {}", clock_text(elapsed));
    else if (const auto seconds = left(done, elapsed))
        line += fmt::format("  {} left", clock_text(*seconds));
    std::fputs(line.c_str(), out_);
    line_is_open_ = true;
}

void Progress::show_plain(double done, double elapsed) {
    const auto seconds = left(done, elapsed);
    std::fputs(fmt::format("{}: {} ({:.3g}/s{})\n", stage_, amount(done), elapsed > 0 ? done / elapsed : 0,
                           seconds ? fmt::format(", {} left", clock_text(*seconds)) : "")
                   .c_str(),
               out_);
}

void Progress::show_json(double done, double elapsed, bool last) {
    const auto number = [](const char* form, std::optional<double> value) {
        return value ? fmt::format(fmt::runtime(form), *value) : "null";
    };
    std::fputs(
        fmt::format("{{\"stage\":\"{}\",\"done\":{:g},\"total\":{},\"unit\":\"{}\",\"elapsed\":{:.3f},\"left\":{},"
                    "\"finished\":{}}}\n",
                    stage_, done, number("{:g}", total_), unit_, elapsed, number("{:.3f}", left(done, elapsed)), last)
            .c_str(),
        out_);
}

}  // namespace beamcam::scenes
