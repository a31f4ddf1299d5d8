#include "harness/accuracy/choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "harness/verify/rounding.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/fastest.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

double sum_from(const std::vector<double>& amounts, int first) {
    return std::accumulate(amounts.begin() + first, amounts.end(), 0.0);
}

/// Every variant that may be the cheapest: the fastest with either impact, in either precision that holds the
/// scene. First those that reach a bound with fewer steps, since they say how far the others need to go.
std::vector<const Variant*> candidates(const Scene& scene) {
    std::vector<const Variant*> found;
    for (const Policies& base : {at_contact(ladder.back()), fastest_variant(scene).policies}) {
        for (const Precision precision : {Precision::double_, Precision::float_}) {
            Policies wanted = base;
            wanted.precision = precision;
            const auto variant = std::ranges::find(variants(), wanted, &Variant::policies);
            if (variant != variants().end() && holds(wanted, scene)) {
                found.push_back(&*variant);
            }
        }
    }
    return found;
}

} // namespace

std::vector<Method> methods_for(const Scene& scene) {
    constexpr int most_substeps = 64;
    const std::vector<const Variant*> fastest = candidates(scene);
    std::vector<Method> methods{{.variant = &event_driven()}};
    for (int substeps = 1; substeps <= most_substeps; substeps *= 2) {
        for (const Variant* variant : fastest) {
            methods.push_back({.variant = variant, .substeps = substeps});
        }
    }
    return methods;
}

std::optional<Tried> cheapest_below(std::span<const Tried> tried, double bound, int units) {
    constexpr double as_good_as_equal = 1.1;
    double least = std::numeric_limits<double>::infinity();
    for (const Tried& one : tried) {
        least = one.largest_error() <= bound ? std::min(least, one.cost(units)) : least;
    }
    std::optional<Tried> found;
    for (const Tried& one : tried) {
        const bool is_cheap = one.largest_error() <= bound && one.cost(units) <= as_good_as_equal * least;
        if (is_cheap && (!found || one.largest_error() < found->largest_error())) {
            found = one;
        }
    }
    return found;
}

const Tried& most_exact(std::span<const Tried> tried) {
    return *std::ranges::min_element(tried, {}, &Tried::largest_error);
}

Expected expected_average_error(const Amounts& amounts, int units, double times_more) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    const auto tried = static_cast<int>(amounts.exact.size());
    const int half = tried / 2;
    const double exact = sum_from(amounts.exact, 0);
    const double other = sum_from(amounts.other, 0);
    const double exact_late = sum_from(amounts.exact, half);
    const double other_late = sum_from(amounts.other, half);
    const double rest = static_cast<double>(units - tried) / (tried - half);
    const double exact_in_all = exact + rest * exact_late;
    const bool is_piece = times_more > 1;
    const bool is_known = tried == units && !is_piece;
    if (exact_in_all == 0 || (exact_late == 0 && !is_known)) {
        return {.error = other == 0 && is_known ? 0 : unbounded};
    }
    const double error = std::abs((other + rest * other_late) / exact_in_all - 1);
    if (is_known) {
        return {.error = error};
    }
    const double open = is_piece ? exact_in_all * times_more : rest * exact_late;
    const double share = is_piece ? 1 : open / exact_in_all;
    return {.error = error, .margin = 2 * share * std::sqrt(amounts.grain * (2 / exact_late + 2 / open))};
}

Expected expected_path_error(std::span<const double> squares, double moved, double whole_over_piece) {
    constexpr double unseen = 3;
    constexpr double discs_of_one = 3;
    if (squares.empty()) {
        return {.margin = std::numeric_limits<double>::infinity()};
    }
    const double count = static_cast<double>(squares.size()) / std::max(whole_over_piece, 1.0);
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    const double fourth_powers = std::inner_product(squares.begin(), squares.end(), squares.begin(), 0.0);
    const double error = std::sqrt(sum / count);
    const double most =
        std::sqrt((sum + 2 * std::sqrt(discs_of_one * fourth_powers) + unseen * moved) / count);
    return {.error = error, .margin = std::max(most - error, least_margin_of_piece * error)};
}

double moved_by_one_collision(const Scene& scene) {
    double speeds = 0;
    double cubes = 0;
    for (const Disc& disc : scene.discs) {
        const double speed = std::hypot(disc.vx, disc.vy) / scene.radius;
        speeds += speed;
        cubes += speed * speed * speed;
    }
    // Of three discs, and of the mean of t^2, a third, from a time that is as likely as any other.
    return speeds > 0 ? 2 * cubes / speeds : 0;
}

double grain_of_impulse(double impulse, double collisions) {
    return collisions > 0 ? 4 / std::numbers::pi * impulse / collisions : 0;
}

} // namespace carom
