// The cache of trajectories on disk: one file for each motion, named by its key (identity.hpp).
//
// An entry is written to a temporary file and renamed, so entries are always complete; a checksum detects later damage.
// Processes share the directory without locks. An unreadable entry counts as missing, and an entry that cannot be
// written is dropped: the cache makes runs faster, but never wrong, and never makes one fail.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/files/atomic_file.hpp"
#include "sim/observe/trajectory.hpp"

namespace beamcam::scenes {

// $BEAMCAM_CACHE_DIR, else beamcam in $XDG_CACHE_HOME, else ~/.cache/beamcam; else nullopt.
std::optional<std::filesystem::path> cache_directory();
// $BEAMCAM_CACHE_SIZE in MiB, else 1024 MiB [bytes]; 0 turns the cache off.
std::uintmax_t cache_limit();

class Cache {
  public:
    Cache(std::filesystem::path directory, std::uintmax_t limit) : directory_(std::move(directory)), limit_(limit) {}

    // End of the cached trajectory [s]. Reads only the trailer of the file.
    std::optional<double> reach(const std::string& key) const;
    // The numbers of a valid trajectory until at least `end`, else null. Marks the entry as used. The numbers remain
    // readable even if the entry is removed or replaced.
    std::shared_ptr<const sim::NumberSource> load(const std::string& key, double end) const;
    // Removes an entry.
    void drop(const std::string& key) const;

    // An entry that is being written. Errors are stored, not thrown.
    class Entry {
      public:
        Entry(const Cache& cache, std::string key);
        void add(std::span<const double> numbers);
        // Publishes the entry unless the cache has a longer one, then evicts the least recently used entries. `about`:
        // description for `ls`. False: not published, for the reason `why`.
        bool commit(double end, long steps, const std::string& about);
        const std::string& why() const { return why_; }
        bool too_large() const;

      private:
        void give_up(std::string reason);
        void attempt(const std::function<void()>& work);  // gives up if it throws

        const Cache& cache_;
        const std::string key_;
        std::string why_;
        std::unique_ptr<output::AtomicFile> file_;  // null: given up
        std::uint64_t count_ = 0;
        std::uint32_t sum_ = 0;
    };

    struct Kept {
        std::string key;
        std::string about;  // "first-order, 2 hub-beam modes"; empty: damaged or foreign
        double end = 0;     // [s]
        long steps = 0;
        std::uintmax_t size = 0;  // [bytes]
        std::filesystem::file_time_type used;
    };
    std::vector<Kept> list() const;  // most recently used first
    // Removes all entries; returns their number and bytes.
    std::pair<long, std::uintmax_t> clear() const;

    const std::filesystem::path& directory() const { return directory_; }
    std::uintmax_t limit() const { return limit_; }

  private:
    std::filesystem::path path_of(const std::string& key) const;
    void make_room(const std::string& newest) const;

    std::filesystem::path directory_;
    std::uintmax_t limit_;
};

}  // namespace beamcam::scenes
