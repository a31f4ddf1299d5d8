#include "harness/accuracy/choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace carom {
namespace {

double sum_from(const std::vector<std::int64_t>& counts, int first) {
    return static_cast<double>(std::accumulate(counts.begin() + first, counts.end(), std::int64_t{0}));
}

} // namespace

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

Expected expected_rate_error(const Counts& counts, int units, double times_larger) {
    const auto tried = static_cast<int>(counts.exact.size());
    const int half = tried / 2;
    const double exact = sum_from(counts.exact, 0);
    const double other = sum_from(counts.other, 0);
    const double exact_late = sum_from(counts.exact, half);
    const double other_late = sum_from(counts.other, half);
    const double rest = static_cast<double>(units - tried) / (tried - half);
    const double exact_in_all = exact + rest * exact_late;
    if (exact_in_all == 0) {
        return {.error = other == 0 ? 0 : std::numeric_limits<double>::infinity()};
    }
    const double error = std::abs((other + rest * other_late) / exact_in_all - 1);
    const bool is_piece = times_larger > 1;
    if (tried == units && !is_piece) {
        return {.error = error};
    }
    const double open = is_piece ? exact_in_all * times_larger : rest * exact_late;
    const double share = is_piece ? 1 : open / exact_in_all;
    return {.error = error, .margin = 2 * share * std::sqrt(2 / exact_late + 2 / open)};
}

} // namespace carom
