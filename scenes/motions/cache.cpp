#include "scenes/motions/cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "output/files/digest.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* kEnding = ".trajectory";
constexpr std::uintmax_t kMiB = 1 << 20;
constexpr std::uintmax_t kDefaultLimit = 1024 * kMiB;
constexpr std::chrono::hours kAbandoned{1};  // age of an unfinished file whose process must be dead

// Follows the numbers of an entry.
struct Trailer {
    char magic[16];
    char key[64];
    char about[128];  // text, padded with zeros
    double end;       // [s]
    std::int64_t steps;
    std::uint64_t count;    // of numbers
    std::uint32_t numbers;  // their checksum
    std::uint32_t trailer;  // checksum of the fields above
};
constexpr char kMagic[16] = {'b', 'e', 'a', 'm', 'c', 'a', 'm', ' ', 'm', 'o', 't', 'i', 'o', 'n', ' ', '1'};

std::uint32_t checksum(const Trailer& t) { return output::crc32(0, &t, offsetof(Trailer, trailer)); }

// The trailer, if it has this key and the right count of numbers.
std::optional<Trailer> read_trailer(const output::Descriptor& file, const std::string& key) {
    const std::uint64_t size = file.size();
    Trailer t;
    if (size < sizeof t || file.read_at(size - sizeof t, &t, sizeof t) != sizeof t) return std::nullopt;
    const bool fine = std::memcmp(t.magic, kMagic, sizeof kMagic) == 0 && key.size() == sizeof t.key &&
                      std::memcmp(t.key, key.data(), sizeof t.key) == 0 && t.trailer == checksum(t) &&
                      t.count == (size - sizeof t) / sizeof(double) && (size - sizeof t) % sizeof(double) == 0 &&
                      std::isfinite(t.end);
    return fine ? std::optional(t) : std::nullopt;
}

const char* variable(const char* name) {
    const char* value = std::getenv(name);
    return value && *value ? value : nullptr;
}

bool is_entry(const fs::directory_entry& file) {
    std::error_code error;
    return file.path().extension() == kEnding && file.is_regular_file(error);
}

// Removes the unfinished files of killed processes.
void remove_abandoned(const fs::path& directory) {
    std::error_code error;
    const auto now = fs::file_time_type::clock::now();
    for (const fs::directory_entry& file : fs::directory_iterator(directory, error)) {
        if (file.path().extension() != ".part" || file.path().filename().string().find(kEnding) == std::string::npos)
            continue;
        const auto touched = file.last_write_time(error);
        if (!error && now - touched > kAbandoned) fs::remove(file.path(), error);
    }
}

}  // namespace

std::optional<fs::path> cache_directory() {
    if (const char* own = variable("BEAMCAM_CACHE_DIR")) return fs::path(own);
    // The XDG Base Directory Specification says to ignore relative paths.
    if (const char* base = variable("XDG_CACHE_HOME"); base && fs::path(base).is_absolute())
        return fs::path(base) / "beamcam";
    if (const char* home = variable("HOME"); home && fs::path(home).is_absolute())
        return fs::path(home) / ".cache" / "beamcam";
    return std::nullopt;
}

std::uintmax_t cache_limit() {
    const char* text = variable("BEAMCAM_CACHE_SIZE");
    const auto mib = output::number_in<std::uintmax_t>(text ? text : "");
    return mib && *mib < (std::uintmax_t{1} << 40) ? *mib * kMiB : kDefaultLimit;
}

fs::path Cache::path_of(const std::string& key) const { return directory_ / (key + kEnding); }

std::optional<double> Cache::reach(const std::string& key) const {
    const auto trailer = read_trailer(output::Descriptor(path_of(key), O_RDONLY), key);
    return trailer ? std::optional(trailer->end) : std::nullopt;
}

namespace {

// The numbers of an entry with a correct checksum.
class EntryNumbers final : public sim::NumberSource {
  public:
    EntryNumbers(output::Descriptor file, std::uint64_t count) : file_(std::move(file)), count_(count) {}
    std::uint64_t size() const override { return count_; }
    void read(std::uint64_t from, std::span<double> into) const override {
        const auto size = static_cast<std::ptrdiff_t>(into.size_bytes());
        if (file_.read_at(from * sizeof(double), into.data(), into.size_bytes()) != size)
            throw std::invalid_argument("a kept trajectory became shorter while it was read");
    }

  private:
    output::Descriptor file_;
    std::uint64_t count_;
};

std::uint32_t checksum(const sim::NumberSource& numbers) {
    std::uint32_t sum = 0;
    std::vector<double> piece(std::size_t{1} << 15);
    for (std::uint64_t from = 0; from < numbers.size(); from += piece.size()) {
        piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), numbers.size() - from)));
        numbers.read(from, piece);
        sum = output::crc32(sum, piece.data(), piece.size() * sizeof(double));
    }
    return sum;
}

}  // namespace

std::shared_ptr<const sim::NumberSource> Cache::load(const std::string& key, double end) const {
    output::Descriptor file(path_of(key), O_RDONLY);
    const auto trailer = read_trailer(file, key);
    if (!trailer || trailer->end < end) return nullptr;
    auto numbers = std::make_shared<EntryNumbers>(std::move(file), trailer->count);
    try {
        if (checksum(*numbers) != trailer->numbers) {
            drop(key);  // else it would block a valid one of the same length
            return nullptr;
        }
    } catch (const std::invalid_argument&) {  // truncated in the meantime
        return nullptr;
    }
    std::error_code ignored;
    fs::last_write_time(path_of(key), fs::file_time_type::clock::now(), ignored);
    return numbers;
}

void Cache::drop(const std::string& key) const {
    std::error_code ignored;
    fs::remove(path_of(key), ignored);
}

// ---- writing ---------------------------------------------------------------------------------------

Cache::Entry::Entry(const Cache& cache, std::string key) : cache_(cache), key_(std::move(key)) {
    attempt([&] {
        if (cache_.limit_ == 0) throw output::IoError("the cache is turned off");
        output::ensure_directory(cache_.directory_);
        file_ = std::make_unique<output::AtomicFile>(cache_.path_of(key_));
    });
}

void Cache::Entry::attempt(const std::function<void()>& work) try { work(); } catch (const std::exception& error) {
    give_up(error.what());
}

void Cache::Entry::give_up(std::string reason) {
    why_ = std::move(reason);
    file_.reset();
}

bool Cache::Entry::too_large() const { return count_ * sizeof(double) > cache_.limit_ / 2; }

void Cache::Entry::add(std::span<const double> numbers) {
    if (!file_) return;
    count_ += numbers.size();
    // A larger entry would evict nearly all others.
    if (too_large())
        return give_up(fmt::format("it is larger than half of the cache of {} MiB, which BEAMCAM_CACHE_SIZE enlarges",
                                   cache_.limit_ / kMiB));
    sum_ = output::crc32(sum_, numbers.data(), numbers.size_bytes());
    attempt([&] { file_->write(output::bytes_of(numbers)); });
}

bool Cache::Entry::commit(double end, long steps, const std::string& about) {
    if (!file_) return false;
    if (const auto other = cache_.reach(key_); other && *other >= end) {
        give_up("the cache has a longer one");
        return false;
    }
    Trailer t{};
    std::memcpy(t.magic, kMagic, sizeof kMagic);
    std::memcpy(t.key, key_.data(), std::min(key_.size(), sizeof t.key));
    std::memcpy(t.about, about.data(), std::min(about.size(), sizeof t.about - 1));
    t.end = end;
    t.steps = steps;
    t.count = count_;
    t.numbers = sum_;
    t.trailer = checksum(t);
    attempt([&] {
        file_->write(output::bytes_of(std::span(&t, 1)));
        // Without fsync: the checksum detects damage by a power failure.
        file_->commit(output::Durability::buffered);
    });
    if (!file_) return false;
    file_.reset();
    cache_.make_room(key_);
    return true;
}

void Cache::make_room(const std::string& newest) const {
    remove_abandoned(directory_);
    std::vector<Kept> all = list();
    std::uintmax_t bytes = 0;
    for (const Kept& kept : all) bytes += kept.size;
    while (bytes > limit_ && all.size() > 1) {
        if (all.back().key != newest) drop(all.back().key);
        bytes -= all.back().size;
        all.pop_back();
    }
}

// ---- housekeeping ----------------------------------------------------------------------------------

std::vector<Cache::Kept> Cache::list() const {
    std::vector<Kept> all;
    std::error_code error;
    for (const fs::directory_entry& file : fs::directory_iterator(directory_, error)) {
        if (!is_entry(file)) continue;
        Kept kept;
        kept.key = file.path().stem().string();
        kept.size = file.file_size(error);
        if (error) continue;  // removed in the meantime
        kept.used = file.last_write_time(error);
        if (const auto trailer = read_trailer(output::Descriptor(file.path(), O_RDONLY), kept.key)) {
            kept.about.assign(trailer->about, strnlen(trailer->about, sizeof trailer->about));
            kept.end = trailer->end;
            kept.steps = trailer->steps;
        }
        all.push_back(std::move(kept));
    }
    std::ranges::sort(all, [](const Kept& a, const Kept& b) { return a.used > b.used; });
    return all;
}

std::pair<long, std::uintmax_t> Cache::clear() const {
    long count = 0;
    std::uintmax_t bytes = 0;
    for (const Kept& kept : list()) {
        std::error_code error;
        if (!fs::remove(path_of(kept.key), error)) continue;
        ++count;
        bytes += kept.size;
    }
    return {count, bytes};
}

}  // namespace beamcam::scenes
