#include "output/image/picture_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "output/image/png_reader.hpp"

namespace beamcam::output {

namespace {

namespace fs = std::filesystem;

// "frame-9" before "frame-10".
std::vector<fs::path> sorted(std::vector<fs::path> files) {
    std::ranges::sort(files, [](const fs::path& a, const fs::path& b) { return strverscmp(a.c_str(), b.c_str()) < 0; });
    return files;
}

std::vector<fs::path> entries_of(const fs::path& directory) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
        files.push_back(it->path());
    if (error) throw read_error(directory, error.value());
    return files;
}

std::vector<fs::path> pictures_in(const fs::path& directory) {
    std::vector<fs::path> files = entries_of(directory);
    std::erase_if(files, [](const fs::path& file) {
        return file.extension() != ".png" || file.filename().string().starts_with(".");
    });
    if (files.empty()) throw IoError("there are no .png files in " + directory.string());
    return sorted(std::move(files));
}

std::vector<fs::path> sequence(const fs::path& pattern) {
    const NumberedName name(pattern.filename().string());
    const fs::path folder = pattern.parent_path();
    std::vector<fs::path> files = entries_of(folder.empty() ? fs::path(".") : folder);
    std::erase_if(files, [&](const fs::path& file) { return !name.number_in(file.filename().string()); });
    if (files.empty()) throw IoError("there are no files " + pattern.string());
    for (fs::path& file : files) file = folder / file.filename();
    return sorted(std::move(files));
}

}  // namespace

NumberedName::NumberedName(std::string_view pattern)
    : before(pattern.substr(0, pattern.find('#'))), after(pattern.substr(pattern.find_last_of('#') + 1)) {}

std::optional<std::string_view> NumberedName::number_in(std::string_view file) const {
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
        return std::nullopt;
    file.remove_prefix(before.size());
    file.remove_suffix(after.size());
    return file.find_first_not_of("0123456789") == file.npos ? std::optional(file) : std::nullopt;
}

std::vector<fs::path> picture_files(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) return pictures_in(path);
    if (!fs::exists(status) && path.filename().string().find('#') != std::string::npos) return sequence(path);
    if (!fs::exists(status)) throw read_error(path, error ? error.value() : ENOENT);
    if (!fs::is_regular_file(status)) throw IoError("cannot read " + path.string() + ": it is a device or a pipe");
    if (access(path.c_str(), R_OK) != 0) throw read_error(path, errno);
    if (fs::is_empty(path, error)) throw IoError("cannot read " + path.string() + ": the file is empty");
    if (!is_png(path))
        throw IoError("cannot read " + path.string() +
                      ": it is not a PNG file; ffmpeg -i FILM name-%04d.png gives the "
                      "pictures of a film");
    return {path};
}

}  // namespace beamcam::output
