#include "harness/side_by_side/slices.hpp"

#include <algorithm>
#include <random>

namespace carom {
namespace {

/// Of a slice, until its program is known to stand still.
constexpr double most_of_a_slice = 0.1;
constexpr double most_longer = 50;
/// A single stop that takes long is chance.
constexpr double weight_of_one = 0.1;

} // namespace

std::vector<double> lengths_of_slices(const std::vector<Sliced>& all, double slice_seconds) {
    const Sliced least = std::ranges::min(all, {}, &Sliced::expected_seconds);
    if (!(least.expected_seconds > 0)) {
        return std::vector<double>(all.size(), slice_seconds);
    }
    const double rounds = std::max(1.0, least.expected_seconds / slice_seconds);
    std::vector<double> slices;
    for (const Sliced& one : all) {
        slices.push_back(one.expected_seconds / rounds);
    }
    return slices;
}

void take_slices(std::vector<Sliced>& all, double slice_seconds, std::uint64_t seed) {
    const std::vector<double> slices = lengths_of_slices(all, slice_seconds);
    std::vector<std::size_t> left;
    for (std::size_t k = 0; k < all.size(); ++k) {
        left.push_back(k);
    }
    std::mt19937_64 random(seed);
    double share = 0; ///< of a slice as it was asked for, until its program stands still
    while (!left.empty()) {
        std::ranges::shuffle(left, random);
        for (const std::size_t k : left) {
            Process& process = *all[k].process;
            const double before = process.wall_seconds();
            process.advance(
                left.size() == 1 ? 1e9 : slices[k] * std::clamp(share / most_of_a_slice, 1.0, most_longer));
            share += weight_of_one * (process.seconds_to_stop() / slices[k] - share);
            if (left.size() == 1 && all.size() > 1) {
                all[k].seconds_alone = std::max(0.0, process.wall_seconds() - before);
            }
        }
        std::erase_if(left, [&all](std::size_t k) { return all[k].process->has_ended(); });
    }
}

} // namespace carom
