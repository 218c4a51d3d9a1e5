// Arithmetic of premultiplied pixels, two channels at once, with the roundings of Cairo and pixman.
#pragma once

#include <algorithm>
#include <cstdint>

#include "render/draw/color.hpp"

namespace beamcam::render {

// Rounding term, added before a product is divided by 255.
constexpr std::uint32_t kCairoHalf = 0x7f, kPixmanHalf = 0x80;

// Each channel times b/255.
inline std::uint32_t times(std::uint32_t pixel, std::uint32_t b, std::uint32_t half) {
    constexpr std::uint32_t kPairs = 0x00ff00ff;  // two channels of a pixel, with room above each
    const auto two = [&](std::uint32_t pair) {
        const std::uint32_t t = pair * b + half * 0x00010001U;
        return ((t + ((t >> 8) & kPairs)) >> 8) & kPairs;
    };
    return two(pixel & kPairs) | two(pixel >> 8 & kPairs) << 8;
}

// Saturated sum of the channels.
inline std::uint32_t sum(std::uint32_t p, std::uint32_t q) {
    constexpr std::uint32_t kPairs = 0x00ff00ff;
    const auto two = [](std::uint32_t a, std::uint32_t b) {
        std::uint32_t t = a + b;
        t |= 0x01000100U - ((t >> 8) & kPairs);
        return t & kPairs;
    };
    return two(p & kPairs, q & kPairs) | two(p >> 8 & kPairs, q >> 8 & kPairs) << 8;
}

// An opaque colour over a pixel of which it covers part/255.
inline std::uint32_t over(std::uint32_t ink, std::uint32_t part, std::uint32_t below) {
    return part == 255 ? ink : sum(times(ink, part, kCairoHalf), times(below, 255 - part, kCairoHalf));
}

// Premultiplied, through 16 bits a channel as Cairo does it.
inline std::uint32_t pixel_of(const Color& c) {
    constexpr double kHalf = 0.5;  // before truncation: rounds
    const auto channel = [](double share) {
        return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * 65535.0 + kHalf) >> 8;
    };
    return channel(c.a) << 24 | channel(c.r * c.a) << 16 | channel(c.g * c.a) << 8 | channel(c.b * c.a);
}

}  // namespace beamcam::render
