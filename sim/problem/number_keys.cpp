#include "sim/problem/number_keys.hpp"

#include <cmath>
#include <functional>

#include "sim/problem/keys.hpp"

namespace beamcam::sim {
namespace {

// Visits every number that has a meaning, with its path.
class NumberWalk final : public NumberVisitor {
  public:
    using Found = std::function<void(NumberKey, const std::function<bool(double)>& set)>;
    explicit NumberWalk(Found found) : found_(std::move(found)) {}

    void number(const Key& key, std::optional<double>& value, const Unit& unit, const Range&, const char*,
                const char*) override {
        if (!key.written) return;
        found_({path(key), unit.resolved(), false, value.value_or(std::nan(""))},
               [&value](double to) { return value = to, true; });
    }
    void numbers(const Key& key, std::vector<double>& values, const Unit& unit, const Range&, const Length& length,
                 const char*) override {
        for (std::size_t i = 0; i < values.size(); ++i)
            found_({path(key) + "." + std::to_string(i), unit.resolved(), false, values[i]},
                   [&values, i](double to) { return values[i] = to, true; });
        if (length.or_one_number)
            found_({path(key), unit.resolved(), false, values.size() == 1 ? values.front() : std::nan("")},
                   [&values](double to) { return values.assign(1, to), true; });
    }
    void integer(const Key& key, std::optional<int>& value, int min, int max, const char*) override {
        found_({path(key), {}, true, value ? *value : std::nan("")}, [&value, min, max](double to) {
            if (std::floor(to) != to || to < min || to > max) return false;
            value = static_cast<int>(to);
            return true;
        });
    }

  private:
    Found found_;
};

}  // namespace

std::vector<NumberKey> number_keys(const Problem& problem) {
    Problem copy = problem;
    std::vector<NumberKey> keys;
    NumberWalk walk([&keys](NumberKey key, const auto&) { keys.push_back(std::move(key)); });
    visit(walk, copy);
    return keys;
}

std::optional<NumberKey> number_key(const Problem& problem, std::string_view path) {
    for (NumberKey& key : number_keys(problem))
        if (key.path == path) return std::move(key);
    return std::nullopt;
}

bool set_number(Problem& problem, std::string_view path, double value) {
    bool done = false;
    NumberWalk walk([&](const NumberKey& key, const auto& set) {
        if (key.path == path) done = set(value);
    });
    visit(walk, problem);
    return done;
}

}  // namespace beamcam::sim
