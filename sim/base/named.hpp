// Enumerators and their names in scenes, tables and messages.
#pragma once

#include <span>

namespace beamcam::sim {

template <class Enum>
struct Named {
    Enum value;
    const char* name;
};

// The name of an enumerator, from the list of its type that `names` returns, in the order of the documentation.
template <class Enum>
requires requires(Enum value) { names(value); }
const char* name(Enum value) {
    for (const Named<Enum>& each : names(value))
        if (each.value == value) return each.name;
    return "?";
}

}  // namespace beamcam::sim
