#include "output/data/point_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>

#include "output/files/checksum.hpp"

namespace beamcam::output {
namespace {

constexpr std::string_view kMagic = "beamcam points 1\n";

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
    for (const std::vector<double>* numbers : {&p.samples, &p.state})
        text.append(reinterpret_cast<const char*>(numbers->data()), numbers->size() * sizeof(double));
    text += p.failure;
    head.checksum = crc32(0, text.data(), text.size());
    std::memcpy(text.data(), &head, sizeof head);
    return text;
}

std::uint64_t rest_of(const Head& head) { return (head.samples + head.state) * sizeof(double) + head.failure; }

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
    throw IoError(fmt::format("{}: {} ({})", file.string(), what, std::strerror(errno)));
}

}  // namespace

PointStore::PointStore(std::filesystem::path file, std::uint64_t points, const std::string& identity)
    : file_(std::move(file)), places_(points, 0), numbers_(points, 0) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(file_, "cannot be made");
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw IoError(file_.string() + ": another beamcam is making these points");
    open_again(std::string(kMagic) + identity + "\n");
}

PointStore::~PointStore() {
    if (descriptor_ >= 0) close(descriptor_);
}

void PointStore::open_again(const std::string& head) {
    struct stat facts {};
    if (fstat(descriptor_, &facts) != 0) fail(file_, "cannot be read");
    const auto size = static_cast<std::uint64_t>(facts.st_size);
    const bool same = size >= head.size() && text_at(0, head.size()) == head;
    end_ = head.size();
    if (!same) {
        const std::string magic = text_at(0, std::min<std::uint64_t>(size, kMagic.size()));
        if (!kMagic.starts_with(magic))
            throw IoError(file_.string() + ": points would be kept here, but this file is not beamcam's; move it away");
        dropped_others_ = size > head.size();
        if (ftruncate(descriptor_, 0) != 0 ||
            pwrite(descriptor_, head.data(), head.size(), 0) != static_cast<ssize_t>(head.size()))
            fail(file_, "cannot be written");
        return;
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
        if (!has(found.point)) ++count_;
        places_[found.point] = end_;
        numbers_[found.point] = static_cast<std::uint32_t>(found.samples);
        end_ += whole;
    }
    if (end_ < size && ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) fail(file_, "cannot be written");
}

std::string PointStore::text_at(std::uint64_t at, std::size_t size) const {
    std::string text(size, '\0');
    for (std::size_t done = 0; done < size;) {
        const ssize_t got = pread(descriptor_, text.data() + done, size - done, static_cast<off_t>(at + done));
        if (got <= 0) fail(file_, "cannot be read");
        done += static_cast<std::size_t>(got);
    }
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
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t put =
            pwrite(descriptor_, text.data() + done, text.size() - done, static_cast<off_t>(end_ + done));
        if (put <= 0) fail(file_, "cannot be written");
        done += static_cast<std::size_t>(put);
    }
    if (!has(point.point)) ++count_;
    places_[point.point] = end_;
    numbers_[point.point] = static_cast<std::uint32_t>(point.samples.size());
    end_ += text.size();
}

void PointStore::remove() { std::filesystem::remove(file_); }

}  // namespace beamcam::output
