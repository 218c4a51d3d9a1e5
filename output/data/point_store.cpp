#include "output/data/point_store.hpp"

#include <fcntl.h>
#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "output/files/numbers.hpp"

namespace beamcam::output {
namespace {

constexpr std::string_view kMagic = "beamcam points 2 ";
constexpr std::uint64_t kLongestLine = 1024;  // the first, with the identity

// The header of a point in the file.
struct Header {
    std::uint64_t point, samples, state, failure;  // counts of numbers, of bytes
    std::int64_t kind, period;
    double impacts_per_period, exponent, exponent_error;
    std::uint64_t checksum;  // of all of it with 0 here
};

std::uint64_t rest_of(const Header& header) {
    return (header.samples + header.state) * sizeof(double) + header.failure;
}

// Whether a sweep of this shape can have this point, in `size` bytes at most.
bool is_possible(const Header& header, const PointShape& shape, std::uint64_t size) {
    const std::uint64_t most =
        std::min<std::uint64_t>(size / sizeof(double), std::numeric_limits<std::uint32_t>::max());
    return header.point < shape.points && header.samples <= most && header.state <= most && header.failure <= size &&
           rest_of(header) <= size && header.samples % shape.columns == 0 && header.kind >= 0 &&
           header.kind < shape.classes && header.period >= 0 && header.period <= std::numeric_limits<int>::max();
}

}  // namespace

std::string text_of(const PointHead& head) {
    return std::string(kMagic) + head.identity + " " + std::to_string(head.description.size()) + "\n" +
           head.description;
}

std::string text_of(const StoredPoint& p) {
    Header header{p.point,  p.samples.size(),     p.state.size(), p.failure.size(), p.kind,
                  p.period, p.impacts_per_period, p.exponent,     p.exponent_error, 0};
    std::string text(reinterpret_cast<const char*>(&header), sizeof header);
    text.append(bytes_of(p.samples)).append(bytes_of(p.state)).append(p.failure);
    header.checksum = libdeflate_crc32(0, text.data(), text.size());
    std::memcpy(text.data(), &header, sizeof header);
    return text;
}

// ---- reading -----------------------------------------------------------------------------------

PointFile::PointFile(std::filesystem::path file, int flags) : path_(std::move(file)), file_(path_, flags) {}

PointFile::PointFile(std::filesystem::path file) : PointFile(std::move(file), O_RDONLY | O_NONBLOCK) {
    if (!file_) throw read_error(path_, errno);
    if (std::error_code error; !std::filesystem::is_regular_file(path_, error) || !read_head())
        throw IoError(path_.string() + ": not a part of a sweep; `beamcam sweep --shard I/N` writes parts");
}

bool PointFile::read_head() {
    const std::uint64_t size = file_.size();
    const std::string text = text_at(0, std::min(size, kLongestLine));
    const std::size_t end = text.find('\n'), space = text.find(' ', kMagic.size());
    if (!text.starts_with(kMagic) || end == text.npos || space == text.npos || space > end) return false;
    const auto described = number_in<std::uint64_t>(std::string_view(text).substr(space + 1, end - space - 1));
    if (!described || *described > size - (end + 1)) return false;
    head_ = {text.substr(kMagic.size(), space - kMagic.size()), text_at(end + 1, *described)};
    end_ = end + 1 + *described;
    return true;
}

void PointFile::find_points(const PointShape& shape) {
    index_points(shape);
    if (end_ < file_.size())
        throw IoError(path_.string() + ": this part is damaged or cut off; compute it again with --force");
}

void PointFile::index_points(const PointShape& shape) {
    places_.assign(shape.points, 0);
    numbers_.assign(shape.points, 0);
    for (const std::uint64_t size = file_.size(); end_ + sizeof(Header) <= size;) {
        std::string text = text_at(end_, sizeof(Header));
        Header found;
        std::memcpy(&found, text.data(), sizeof found);
        if (!is_possible(found, shape, size - end_ - sizeof(Header))) return;
        text = text_at(end_, sizeof(Header) + rest_of(found));
        Header zeroed = found;
        zeroed.checksum = 0;
        std::memcpy(text.data(), &zeroed, sizeof zeroed);
        if (libdeflate_crc32(0, text.data(), text.size()) != found.checksum) return;
        place(found.point, found.samples, text.size());
    }
}

// The point is at the end of the file, which grows by its size.
void PointFile::place(std::uint64_t point, std::uint64_t samples, std::uint64_t size) {
    if (!has(point)) ++count_;
    places_[point] = end_;
    numbers_[point] = static_cast<std::uint32_t>(samples);
    end_ += size;
}

std::string PointFile::text_at(std::uint64_t at, std::size_t size) const {
    std::string text(size, '\0');
    if (file_.read_at(at, text.data(), size) != static_cast<std::ptrdiff_t>(size)) throw read_error(path_, errno);
    return text;
}

StoredPoint PointFile::read(std::uint64_t point) const {
    const std::uint64_t at = places_[point];
    Header header;
    std::memcpy(&header, text_at(at, sizeof header).data(), sizeof header);
    // The file may have changed since it was indexed.
    if (header.point != point || header.samples != numbers_[point] || rest_of(header) > file_.size())
        throw IoError(path_.string() + ": another program changed the points");
    const std::string rest = text_at(at + sizeof header, rest_of(header));
    StoredPoint out{header.point,
                    static_cast<int>(header.kind),
                    static_cast<int>(header.period),
                    header.impacts_per_period,
                    header.exponent,
                    header.exponent_error,
                    {},
                    {},
                    {}};
    const char* from = rest.data();
    for (const auto& [count, numbers] :
         {std::pair{header.samples, &out.samples}, std::pair{header.state, &out.state}}) {
        numbers->resize(count);
        if (count > 0) std::memcpy(numbers->data(), from, count * sizeof(double));
        from += count * sizeof(double);
    }
    out.failure.assign(from, header.failure);
    return out;
}

// ---- growing -----------------------------------------------------------------------------------

PointStore::PointStore(std::filesystem::path file, const PointShape& shape, const PointHead& head, bool replace)
    : PointFile(std::move(file), O_RDWR | O_CREAT | O_NOFOLLOW) {
    if (!file_) throw write_error(path_, errno);
    if (!file_.try_lock() && errno == EWOULDBLOCK)
        throw IoError(path_.string() + ": another beamcam is making these points");
    const std::uint64_t size = file_.size();
    const bool whole = read_head();
    if (!whole && !std::string_view(text_of(head)).starts_with(text_at(0, std::min(size, kLongestLine))))
        throw IoError(path_.string() + ": points would be kept here, but this file is not beamcam's; move it away");
    if (whole && head_.identity != head.identity && size > end_ && !replace)
        throw IoError(path_.string() +
                      ": has points of another sweep, or of another version of beamcam; --force discards them");
    if (!whole || head_.identity != head.identity) begin(head);
    index_points(shape);
    if (end_ < file_.size() && ftruncate(file_.number(), static_cast<off_t>(end_)) != 0)
        throw write_error(path_, errno);
}

PointStore::~PointStore() {
    std::error_code ignored;
    if (count_ == 0 && file_) std::filesystem::remove(path_, ignored);
}

// Discards what the file holds.
void PointStore::begin(const PointHead& head) {
    head_ = head;
    const std::string text = text_of(head);
    end_ = text.size();
    if (ftruncate(file_.number(), 0) == 0 && file_.write_at(0, text)) return;
    const int error = errno;
    remove();
    throw write_error(path_, error);
}

void PointStore::add(const StoredPoint& point) {
    const std::string text = text_of(point);
    const std::lock_guard lock(mutex_);
    if (!file_.write_at(end_, text)) throw write_error(path_, errno);
    place(point.point, point.samples.size(), text.size());
}

void PointStore::remove() { std::filesystem::remove(path_); }

}  // namespace beamcam::output
