#include "output/data/point_store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "output/files/digest.hpp"

namespace beamcam::output {
namespace {

constexpr std::string_view kMagic = "beamcam points 1\n";
constexpr std::uint64_t kLongestHead = 1024;  // with the identity, a digest

// The header of a point in the file.
struct Head {
    std::uint64_t point, samples, state, failure;  // counts of numbers, of bytes
    std::int64_t kind, period;
    double impacts_per_period, exponent, exponent_error;
    std::uint64_t checksum;  // of all of it with 0 here
};

std::string text_of(const StoredPoint& p) {
    Head head{p.point,  p.samples.size(),     p.state.size(), p.failure.size(), p.kind,
              p.period, p.impacts_per_period, p.exponent,     p.exponent_error, 0};
    std::string text(reinterpret_cast<const char*>(&head), sizeof head);
    text.append(bytes_of(p.samples)).append(bytes_of(p.state)).append(p.failure);
    head.checksum = crc32(0, text.data(), text.size());
    std::memcpy(text.data(), &head, sizeof head);
    return text;
}

std::uint64_t rest_of(const Head& head) { return (head.samples + head.state) * sizeof(double) + head.failure; }

}  // namespace

PointStore::PointStore(std::filesystem::path file, std::uint64_t points, const std::string& identity, bool replace)
    : path_(std::move(file)), file_(path_, O_RDWR | O_CREAT), places_(points, 0), numbers_(points, 0) {
    if (!file_) throw write_error(path_, errno);
    if (!file_.try_lock() && errno == EWOULDBLOCK)
        throw IoError(path_.string() + ": another beamcam is making these points");
    open_again(std::string(kMagic) + identity + "\n", replace);
}

PointStore::~PointStore() {
    std::error_code ignored;
    if (count_ == 0 && file_) std::filesystem::remove(path_, ignored);
}

void PointStore::open_again(const std::string& head, bool replace) {
    const std::uint64_t size = file_.size();
    const bool same = size >= head.size() && text_at(0, head.size()) == head;
    end_ = head.size();
    if (!same) {
        const std::string other = text_at(0, std::min<std::uint64_t>(size, kLongestHead));
        if (!kMagic.starts_with(other.substr(0, kMagic.size())))
            throw IoError(path_.string() + ": points would be kept here, but this file is not beamcam's; move it away");
        const std::size_t end = other.find('\n', kMagic.size());
        if (end != other.npos && size > end + 1 && !replace)
            throw IoError(path_.string() +
                          ": has points of another sweep, or of another version of beamcam; --force discards them");
        if (ftruncate(file_.number(), 0) == 0 && file_.write_at(0, head)) return;
        const IoError error = write_error(path_, errno);
        remove();
        throw error;
    }
    while (end_ + sizeof(Head) <= size) {
        std::string text = text_at(end_, sizeof(Head));
        Head found;
        std::memcpy(&found, text.data(), sizeof found);
        const std::uint64_t most = (size - end_) / sizeof(double) + 1;
        if (found.point >= places_.size() || found.samples > most || found.state > most || found.failure > size) break;
        const std::uint64_t whole = sizeof(Head) + rest_of(found);
        if (end_ + whole > size) break;
        text = text_at(end_, whole);
        Head zeroed = found;
        zeroed.checksum = 0;
        std::memcpy(text.data(), &zeroed, sizeof zeroed);
        if (crc32(0, text.data(), text.size()) != found.checksum) break;
        place(found.point, found.samples, whole);
    }
    if (end_ < size && ftruncate(file_.number(), static_cast<off_t>(end_)) != 0) throw write_error(path_, errno);
}

// The point is at the end of the file, which grows by its size.
void PointStore::place(std::uint64_t point, std::uint64_t samples, std::uint64_t size) {
    if (!has(point)) ++count_;
    places_[point] = end_;
    numbers_[point] = static_cast<std::uint32_t>(samples);
    end_ += size;
}

std::string PointStore::text_at(std::uint64_t at, std::size_t size) const {
    std::string text(size, '\0');
    if (file_.read_at(at, text.data(), size) != static_cast<std::ptrdiff_t>(size)) throw read_error(path_, errno);
    return text;
}

StoredPoint PointStore::read(std::uint64_t point) const {
    const std::uint64_t at = places_[point];
    Head head;
    std::memcpy(&head, text_at(at, sizeof head).data(), sizeof head);
    const std::string rest = text_at(at + sizeof head, rest_of(head));
    StoredPoint out{head.point,
                    static_cast<int>(head.kind),
                    static_cast<int>(head.period),
                    head.impacts_per_period,
                    head.exponent,
                    head.exponent_error,
                    {},
                    {},
                    {}};
    const char* from = rest.data();
    for (const auto& [count, numbers] : {std::pair{head.samples, &out.samples}, std::pair{head.state, &out.state}}) {
        numbers->resize(count);
        if (count > 0) std::memcpy(numbers->data(), from, count * sizeof(double));
        from += count * sizeof(double);
    }
    out.failure.assign(from, head.failure);
    return out;
}

void PointStore::add(const StoredPoint& point) {
    const std::string text = text_of(point);
    const std::lock_guard lock(mutex_);
    if (!file_.write_at(end_, text)) throw write_error(path_, errno);
    place(point.point, point.samples.size(), text.size());
}

void PointStore::remove() { std::filesystem::remove(path_); }

}  // namespace beamcam::output
