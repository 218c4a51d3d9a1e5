#include "output/image/picture_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "output/image/png_reader.hpp"

namespace beamcam::output {

namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::vector<fs::path> sorted(std::vector<fs::path> files) {
    std::ranges::sort(files,
                      [](const fs::path& a, const fs::path& b) { return natural_order(a.string(), b.string()); });
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

// Does "fall-0012.png" belong to "fall-####.png"?
bool belongs(const std::string& name, const std::string& before, const std::string& after) {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
        return false;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(before.size()),
                       name.end() - static_cast<std::ptrdiff_t>(after.size()), is_digit);
}

std::vector<fs::path> sequence(const fs::path& pattern) {
    const std::string name = pattern.filename().string();
    const std::string before = name.substr(0, name.find('#')), after = name.substr(name.find_last_of('#') + 1);
    const fs::path folder = pattern.parent_path();
    std::vector<fs::path> files = entries_of(folder.empty() ? fs::path(".") : folder);
    std::erase_if(files, [&](const fs::path& file) { return !belongs(file.filename().string(), before, after); });
    if (files.empty()) throw IoError("there are no files " + pattern.string());
    for (fs::path& file : files) file = folder / file.filename();
    return sorted(std::move(files));
}

}  // namespace

bool natural_order(const std::string& a, const std::string& b) {
    std::size_t i = 0, k = 0;
    while (i < a.size() && k < b.size()) {
        if (!is_digit(a[i]) || !is_digit(b[k])) {
            if (a[i] != b[k]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[k]);
            ++i, ++k;
            continue;
        }
        const auto number = [](const std::string& text, std::size_t& at) {
            while (at < text.size() && text[at] == '0') ++at;
            const std::size_t begin = at;
            while (at < text.size() && is_digit(text[at])) ++at;
            return text.substr(begin, at - begin);
        };
        const std::string m = number(a, i), n = number(b, k);
        if (m.size() != n.size()) return m.size() < n.size();
        if (m != n) return m < n;
    }
    if (i < a.size() || k < b.size()) return k < b.size();
    return a < b;  // equal but for leading zeros
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
