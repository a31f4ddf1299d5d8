#include "harness/accuracy/choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

std::optional<Tried> cheapest_below(std::span<const Tried> tried, double bound, int units) {
    std::optional<Tried> cheapest;
    for (const Tried& one : tried) {
        const bool reaches = one.largest_error() <= bound;
        if (reaches && (!cheapest || one.cost(units) < cheapest->cost(units))) {
            cheapest = one;
        }
    }
    return cheapest;
}

const Tried& most_exact(std::span<const Tried> tried) {
    return *std::ranges::min_element(tried, {}, &Tried::largest_error);
}

double margin_of_rate(double counted, double share, bool beginning) {
    if (beginning && share >= 1) {
        return 0;
    }
    if (counted <= 0) {
        return std::numeric_limits<double>::infinity();
    }
    const double in_rest = beginning ? counted * (1 - share) / share : counted / share;
    const double open = beginning ? 1 - share : 1;
    return 2 * open * std::sqrt(2 / counted + 2 / in_rest);
}

} // namespace carom
