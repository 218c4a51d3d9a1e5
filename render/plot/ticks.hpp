// Round numbers: steps of 1, 2 and 5 times a power of ten, for axes, scale bars and factors.
#pragma once

#include <string>
#include <vector>

namespace beamcam::render {

// 10ⁿ for |n| <= 300: exact for n = 0…22, and the nearest double for n = −22…−1.
double ten_to(int n);

// The largest of … 0.1, 0.2, 0.5, 1, 2, 5, 10 … that is <= value, or the smallest >= value. value > 0.
double round_down_125(double value);
double round_up_125(double value);

// Marks at multiples of a 1-2-5 step within [low, high] (rounding slack of 1e-9 steps), at most
// `most` of them; the step is the smallest that allows it. low < high, most >= 2.
struct Ticks {
    double step = 1;
    int decimals = 0;  // that distinguish neighbours
    std::vector<double> values;
};
Ticks ticks(double low, double high, int most);
Ticks multiples(double step, double low, double high);  // marks at all multiples within [low, high]
int decimals_of(double step);                           // that distinguish neighbours

struct Range {
    double low = 0, high = 1;
};

std::string fixed(double value, int decimals);  // with a true minus sign; never "−0"

// Three significant digits with an SI prefix: quantity(0.02, "m") is "20 mm"; a no-break space between.
std::string quantity(double value, const char* unit, int digits = 3);
// The SI prefix that suits values up to `largest`: its symbol and factor ("m", 1e-3).
struct Prefix {
    const char* symbol;
    double factor;
};
Prefix prefix_for(double largest);
// With a given prefix, for values beside each other.
std::string quantity(double value, Prefix prefix, const char* unit, int digits = 3);
// A changing value with three digits: "1.90 MN" after "2.95 MN"; zero is "0 N".
std::string reading(double value, Prefix prefix, const char* unit);

}  // namespace beamcam::render
