// Errors as messages and exit codes.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <new>

#include "output/files/errors.hpp"
#include "output/film/video.hpp"
#include "render/base/error.hpp"
#include "render/base/limits.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/outputs/run.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {
namespace {

struct Failure {
    int code;
    std::string text;
    bool may_be_memory = true;  // a library may have failed because memory was short
};

template <class... Errors>
bool is_one_of(const std::exception& e) {
    return (dynamic_cast<const Errors*>(&e) || ...);
}

Failure failure_of(const std::exception& e) {
    const std::string text = e.what();
    try {
        std::rethrow_if_nested(e);
    } catch (const std::exception& first) {  // of the outputs that could not be written
        return {failure_of(first).code, text};
    }
    if (is_one_of<UsageError, NameClash>(e)) return {kUsage, text, false};
    if (is_one_of<SceneError>(e)) return {kBadScene, text, false};
    if (is_one_of<std::bad_alloc>(e)) return {kInputOutput, render::out_of_memory_message(), false};
    if (is_one_of<sim::Interrupted>(e)) return {kInterrupted, "interrupted; no output is half-written", false};
    if (is_one_of<output::UnsupportedOption, render::PictureError>(e)) return {kBadScene, text};
    if (const auto* solver = dynamic_cast<const sim::SolverError*>(&e))
        return {kSolverFailed, fmt::format("{} (reached {:.9g} s)", text, solver->last_time)};
    if (is_one_of<output::MissingCodec, render::MissingPart>(e)) return {kMissingPart, text};
    if (is_one_of<output::IoError>(e)) return {kInputOutput, text};
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&e))
        return {kInputOutput, output::io_error(*file).what()};
    return {kBug, fmt::format("internal error: {}; please report it with the scene and the command", text)};
}

}  // namespace

int report(const std::exception& error) {
    auto [code, text, may_be_memory] = failure_of(error);
    if (is_one_of<SceneError>(error)) {  // its messages begin with their places
        if (!text.empty()) output::print_message("{}{}", text, text.ends_with('\n') ? "" : "\n");
        return code;
    }
    if (may_be_memory && render::memory_limit()) {
        text += "; perhaps there was " + render::out_of_memory_message();
        if (code == kBug) code = kInputOutput;  // rather than one of the program
    }
    if (!text.empty()) output::print_message("beamcam: {}\n", text);
    return code;
}

int for_each_file(const std::vector<std::string>& files, const std::function<void(const std::string& file)>& work) {
    int first = kDone;
    for (const std::string& file : files) try {
            work(file);
        } catch (const sim::Interrupted&) {
            throw;
        } catch (const std::exception& error) {
            const int code = report(error);
            if (first == kDone) first = code;
        }
    return first;
}

}  // namespace beamcam::scenes
