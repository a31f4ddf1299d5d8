#include "harness/measure/turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>

namespace carom {

int count_rounds(std::span<const double> expected_seconds, int fewest_steps, double turn_seconds) {
    std::vector<double> sorted(expected_seconds.begin(), expected_seconds.end());
    const auto middle = sorted.begin() + std::ssize(sorted) / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double rounds = std::round(*middle / turn_seconds);
    return static_cast<int>(std::clamp(rounds, 1.0, std::max(1.0, std::floor(fewest_steps / 2.0))));
}

std::vector<std::vector<TurnTime>> take_turns(std::span<Contender* const> contenders, const TurnsPlan& plan) {
    std::mt19937_64 random(plan.seed);
    std::vector<std::vector<TurnTime>> turns(contenders.size());
    std::vector<std::size_t> order(contenders.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    int place = 0;
    const bool may_halve = std::ranges::all_of(
        contenders, [&plan](const Contender* one) { return one->steps() >= 2 * plan.rounds; });
    for (int run = 0; run < plan.runs; ++run) {
        const bool begins_with_half = may_halve && (plan.seed + static_cast<std::uint64_t>(run)) % 2 == 1;
        const auto steps_until = [&plan, begins_with_half](const Contender& one, int rounds_done) {
            const bool is_within = rounds_done > 0 && rounds_done < plan.rounds;
            const int halves = 2 * rounds_done - (begins_with_half && is_within ? 1 : 0);
            return static_cast<int>(std::int64_t{one.steps()} * halves / (2 * plan.rounds));
        };
        for (Contender* const one : contenders) {
            one->start();
        }
        for (int round = 0; round < plan.rounds; ++round) {
            std::ranges::shuffle(order, random);
            for (const std::size_t next : order) {
                Contender& one = *contenders[next];
                turns[next].push_back(one.advance(steps_until(one, round + 1) - steps_until(one, round)));
                turns[next].back().place = place++;
            }
        }
    }
    return turns;
}

} // namespace carom
