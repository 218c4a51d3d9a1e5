#include "render/draw/formula.hpp"

#include <algorithm>
#include <array>

#include "render/draw/canvas.hpp"

namespace beamcam::render {
namespace {

// Characters that no markup has.
constexpr char kBegin = '\x01', kNext = '\x02', kEnd = '\x03';

std::string part(char kind, std::string_view first, std::string_view second) {
    std::string out{kBegin, kind};
    out.append(first) += kNext;
    out.append(second) += kEnd;
    return out;
}

// By the size of the letters: of scripts, of fractions, how far scripts are raised and lowered, how high the line of a
// fraction stands, what is left free beside lines, their width, and that of a root's sign.
constexpr double kSmall = 0.72, kOver = 0.64, kRaise = 0.36, kLower = 0.17, kAxis = 0.27, kGap = 0.09, kLine = 0.055,
                 kSign = 0.55;
constexpr double kApartAbove = 0.06, kApartBelow = 0.07;  // so much further are scripts of one letter that has both

}  // namespace

std::string fraction(std::string_view above, std::string_view below) { return part('f', above, below); }
std::string root(std::string_view inside) { return part('r', inside, {}); }
std::string scripts(std::string_view below, std::string_view above) { return part('s', below, above); }
std::string dotted(std::string_view letter, int dots) { return part('d', letter, std::string(std::size_t(dots), '.')); }

bool has_formula(std::string_view markup) { return markup.find(kBegin) != std::string_view::npos; }

std::vector<FormulaPart> formula_parts(std::string_view markup) {
    std::vector<FormulaPart> out;
    int depth = 0;
    std::string* into = nullptr;
    for (std::size_t i = 0; i < markup.size(); ++i) {
        const char c = markup[i];
        if (c == kBegin && ++depth == 1) {
            out.push_back({markup[++i], {}, {}});
            into = &out.back().first;
            continue;
        }
        if (c == kNext && depth == 1) {
            into = &out.back().second;
            continue;
        }
        if (c == kEnd && --depth == 0) {
            into = nullptr;
            continue;
        }
        if (!into) into = &out.emplace_back().first;
        *into += c;
    }
    return out;
}

Box Canvas::formula(Vec2 at, const std::string& markup, const TextStyle& style, bool draws) {
    const double size = style.size, gap = kGap * size;
    TextStyle plain = style, small = style;
    plain.align = small.align = HAlign::left;
    plain.max_width = small.max_width = 0;
    small.size = kSmall * size;
    Bounds ink;
    double x = 0;
    const auto put = [&](Vec2 p, const std::string& words, const TextStyle& how) {
        const Box box = measure(words, how);
        if (draws && !words.empty()) text({at.x + p.x, at.y + p.y}, words, how);
        if (box.h > 0) ink.add({p.x, p.y + box.y}), ink.add({p.x + box.w, p.y + box.bottom()});
        return box;
    };
    const auto rule = [&](std::vector<Vec2> points) {
        for (const Vec2& p : points) ink.add(p, kLine * size / 2);
        if (!draws) return;
        for (Vec2& p : points) p += at;
        polyline(points);
        stroke({style.color, kLine * size});
    };
    for (const FormulaPart& one : formula_parts(markup)) {
        if (one.kind == 's') {
            const bool both = !one.first.empty() && !one.second.empty();
            const Vec2 below{x, (kLower + (both ? kApartBelow : 0)) * size},
                above{x + 0.06 * size, -(kRaise + (both ? kApartAbove : 0)) * size};
            x += std::max(one.first.empty() ? 0 : put(below, one.first, small).w,
                          one.second.empty() ? 0 : 0.06 * size + put(above, one.second, small).w);
        } else if (one.kind == 'f') {
            small.size = kOver * size;
            const Box above = measure(one.first, small), below = measure(one.second, small);
            const double wide = std::max(above.w, below.w) + 2 * gap, axis = -kAxis * size;
            put({x + (wide - above.w) / 2, axis - gap - above.bottom()}, one.first, small);
            put({x + (wide - below.w) / 2, axis + gap - below.y}, one.second, small);
            rule({{x + gap / 2, axis}, {x + wide - gap / 2, axis}});
            x += wide;
            small.size = kSmall * size;
        } else if (one.kind == 'r') {
            const double sign = kSign * size;
            if (x > 0) x += gap;  // its sign begins low, where what is before it may end
            const Box inside = put({x + sign, 0}, one.first, plain);
            const double top = std::min(inside.y, -0.7 * size) - gap, bottom = std::max(inside.bottom(), 0.0);
            rule({{x, -0.3 * size},
                  {x + 0.3 * sign, -0.36 * size},
                  {x + 0.6 * sign, bottom},
                  {x + sign, top},
                  {x + sign + inside.w, top}});
            x += sign + inside.w + gap / 2;
        } else if (one.kind == 'd') {
            const Box letter = put({x, 0}, one.first, plain);
            const auto dots = static_cast<double>(one.second.size());
            for (double k = 0; k < dots; ++k) {
                const Vec2 dot{x + 0.58 * letter.w + (k - 0.5 * (dots - 1)) * 0.24 * size, letter.y - 0.14 * size};
                ink.add(dot, 0.07 * size);
                if (draws) circle(at + dot, 0.07 * size), fill(style.color);
            }
            x += letter.w;
        } else {
            if (style.max_width > 0) plain.max_width = std::max(size, style.max_width - x);
            x += put({x, 0}, one.first, plain).w;
        }
    }
    if (!(ink.x1 > ink.x0)) return {at.x, at.y, x, 0};
    return {at.x, at.y + ink.y0, x, ink.y1 - ink.y0};
}

}  // namespace beamcam::render
