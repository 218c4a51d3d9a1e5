// Trajectories kept on disk between runs, each a file named after the motion it is of (identity.hpp).
//
// An entry is written beside its place and renamed into it, so that there is never half of one; a
// checksum tells one that was damaged later. Processes share the directory without locks. Whatever is
// wrong with it, an entry that cannot be read is none and one that cannot be written is not kept:
// the cache makes runs faster, never wrong, and never fails one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/observe/trajectory.hpp"

namespace beamcam::scenes {

// $BEAMCAM_CACHE_DIR, else beamcam in $XDG_CACHE_HOME, else ~/.cache/beamcam; nothing without any of them.
std::optional<std::filesystem::path> cache_directory();
// $BEAMCAM_CACHE_SIZE in MiB, else 1024 [bytes]; 0 keeps nothing.
std::uintmax_t cache_limit();

class Cache {
  public:
    Cache(std::filesystem::path directory, std::uintmax_t limit) : directory_(std::move(directory)), limit_(limit) {}

    // How far the kept trajectory goes [s]. Reads its last few bytes only.
    std::optional<double> reach(const std::string& key) const;
    // Its numbers, if it goes to `end` and is whole; null otherwise. Marks it as used. They stay readable, piece by
    // piece, even when the entry is removed or replaced.
    std::shared_ptr<const sim::NumberSource> load(const std::string& key, double end) const;
    // Of no use after all.
    void drop(const std::string& key) const;

    // An entry that is being written. Errors are remembered, not thrown.
    class Entry {
      public:
        Entry(Entry&&) noexcept;
        ~Entry();
        void add(std::span<const double> numbers);
        // Puts it in its place, unless a longer one stands there, and makes room by removing those used
        // longest ago. `about`: what `ls` prints. False: not kept, for the reason `why`.
        bool commit(double end, long steps, const std::string& about);
        const std::string& why() const;

      private:
        friend class Cache;
        struct Impl;
        explicit Entry(std::unique_ptr<Impl> impl);
        std::unique_ptr<Impl> impl_;
    };
    Entry begin(const std::string& key) const;

    struct Kept {
        std::string key;
        std::string about;  // "first-order, 2 hub-beam modes"; empty: damaged or foreign
        double end = 0;     // [s]
        long steps = 0;
        std::uintmax_t size = 0;  // [bytes]
        std::filesystem::file_time_type used;
    };
    std::vector<Kept> list() const;  // the last used first
    // Removes every entry; how many, and how many bytes.
    std::pair<long, std::uintmax_t> clear() const;

    const std::filesystem::path& directory() const { return directory_; }
    std::uintmax_t limit() const { return limit_; }

  private:
    std::filesystem::path path_of(const std::string& key) const;

    std::filesystem::path directory_;
    std::uintmax_t limit_;
};

}  // namespace beamcam::scenes
