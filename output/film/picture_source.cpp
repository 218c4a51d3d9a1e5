#include "output/film/picture_source.hpp"

#include "output/image/picture_files.hpp"
#include "output/image/png_reader.hpp"

namespace beamcam::output {

namespace fs = std::filesystem;

PictureSource::PictureSource(const fs::path& path) : path_(path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::is_regular_file(status) || (png_kind(path) == PngKind::up_to_8_bits && path.extension() != ".apng")) {
        files_ = picture_files(path);
    } else {
        if (fs::is_empty(path, error)) throw IoError("cannot read " + path.string() + ": the file is empty");
        film_ = std::make_unique<VideoReader>(path);
    }
}

bool PictureSource::next(Raster& picture, std::string& name) {
    if (film_) {
        if (!film_->next(picture)) return false;
        name = path_.string();
        if (!film_->info().is_still()) name.append(1, '#').append(std::to_string(next_++));
        return true;
    }
    if (next_ == files_.size()) return false;
    name = files_[next_].string();
    picture = read_png(files_[next_++]);
    return true;
}

bool PictureSource::skip() {
    if (film_ ? !film_->skip() : next_ == files_.size()) return false;
    ++next_;
    return true;
}

}  // namespace beamcam::output
