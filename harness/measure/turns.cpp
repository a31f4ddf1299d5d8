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
    return static_cast<int>(std::clamp(rounds, 1.0, std::max(1.0, static_cast<double>(fewest_steps))));
}

std::vector<std::vector<double>> take_turns(std::span<Contender* const> contenders, int rounds,
                                            std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> seconds(contenders.size());
    std::vector<std::size_t> order(contenders.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (int round = 0; round < rounds; ++round) {
        std::ranges::shuffle(order, random);
        for (const std::size_t next : order) {
            const auto steps_until = [&](int rounds_done) {
                return static_cast<int>(std::int64_t{contenders[next]->steps()} * rounds_done / rounds);
            };
            seconds[next].push_back(contenders[next]->advance(steps_until(round + 1) - steps_until(round)));
        }
    }
    return seconds;
}

} // namespace carom
