// A numerical constant of sim/ as a variable that campaign_constants perturbs.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace beamcam::sim {

struct Constant {
    std::string file, name;
    std::variant<double*, int*, long*, std::size_t*> value;
};

inline std::vector<Constant>& all_constants() {
    static std::vector<Constant> all;
    return all;
}

// Lists the variable of a constant.
template <class T>
T& variable(const char* file, const char* name, T value) {
    T* const place = new T(value);  // it lives as long as the program
    all_constants().push_back({file, name, place});
    return *place;
}

}  // namespace beamcam::sim
