#include "sim/integrate/nodal_matrix.hpp"

#include <cmath>
#include <utility>

namespace beamcam::sim {

bool solve_dense(NodalMatrix& a, std::span<Lanes> all) {
    int order[kNodes];
    for (int k = 0; k < kNodes; ++k) order[k] = k;
    for (int c = 0; c < kNodes; ++c) {
        Lanes& column = a[static_cast<std::size_t>(c)];
        int best = c;
        for (int r = c + 1; r < kNodes; ++r)
            if (std::fabs(column[order[r]]) > std::fabs(column[order[best]])) best = r;
        std::swap(order[c], order[best]);
        const int pivot = order[c];
        if (!(std::fabs(column[pivot]) > 0)) return false;
        Lanes factor = column / column[pivot];
        for (int r = 0; r <= c; ++r) factor[order[r]] = 0;
        for (int j = c + 1; j < kNodes; ++j) {
            Lanes& other = a[static_cast<std::size_t>(j)];
            other -= factor * other[pivot];
        }
        for (Lanes& b : all) b -= factor * b[pivot];
    }
    for (Lanes& b : all) {
        Lanes x{};
        for (int c = kNodes - 1; c >= 0; --c) {
            const Lanes& column = a[static_cast<std::size_t>(c)];
            x[c] = b[order[c]] / column[order[c]];
            b -= x[c] * column;
        }
        b = x;
    }
    return true;
}

}  // namespace beamcam::sim
