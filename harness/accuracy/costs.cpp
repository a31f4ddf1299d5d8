#include "harness/accuracy/costs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "kernels/grid.hpp"

namespace carom {
namespace {

/// Seconds at a size between two.
double between(const UnitCosts& small, const UnitCosts& large, double discs, const Work& work) {
    const auto sum = [&](const Work& each) {
        return each.placed * work.placed + each.moved * work.moved + each.near * work.near +
               each.collisions * work.collisions;
    };
    if (large.discs <= small.discs) {
        return sum(large.seconds);
    }
    const double share =
        std::clamp(std::log(discs / small.discs) / std::log(large.discs / small.discs), 0.0, 1.0);
    return (1 - share) * sum(small.seconds) + share * sum(large.seconds);
}

double seconds_by(const std::vector<UnitCosts>& sizes, double discs, const Work& work) {
    const auto larger = std::ranges::find_if(sizes, [&](const UnitCosts& one) { return one.discs >= discs; });
    if (larger == sizes.end()) {
        return between(sizes.back(), sizes.back(), discs, work);
    }
    return between(larger == sizes.begin() ? *larger : *(larger - 1), *larger, discs, work);
}

} // namespace

Work& Work::operator+=(const Work& more) {
    placed += more.placed;
    moved += more.moved;
    near += more.near;
    collisions += more.collisions;
    return *this;
}

Work operator*(double times, const Work& work) {
    return {times * work.placed, times * work.moved, times * work.near, times * work.collisions};
}

double Costs::seconds(const Variant& variant, double discs, const Work& work) const {
    if (const auto found = costs.find(std::string(variant.name)); found != costs.end()) {
        return seconds_by(found->second, discs, work);
    }
    double dearest = 0;
    for (const auto& [name, sizes] : costs) {
        dearest = std::max(dearest, seconds_by(sizes, discs, work));
    }
    return dearest;
}

Work work_of_step(const Variant& variant, const Scene& scene) {
    const auto count = static_cast<double>(scene.discs.size());
    const Grid grid(scene.side, scene.radius, static_cast<int>(scene.discs.size()),
                    variant.policies.box_side);
    std::vector<double> held(static_cast<std::size_t>(grid.box_count()), 0.0);
    for (const Disc& disc : scene.discs) {
        const int box = grid.box_of(grid.coordinate(disc.y), grid.coordinate(disc.x));
        ++held[static_cast<std::size_t>(box)];
    }
    double squares = 0;
    for (const double discs : held) {
        squares += discs * discs;
    }
    return {.moved = count, .near = 4.5 * squares}; // half of nine boxes
}

Work work_of_events(const Scene& scene) {
    const auto count = static_cast<double>(scene.discs.size());
    const double cell = std::max(2 * scene.radius, scene.side / std::sqrt(count + 1));
    double flown = 0;
    for (const Disc& disc : scene.discs) {
        flown += std::abs(disc.vx) + std::abs(disc.vy);
    }
    return {.moved = flown / cell, .near = count};
}

nlohmann::ordered_json costs_json(const Costs& costs) {
    auto variants = nlohmann::ordered_json::object();
    for (const auto& [name, sizes] : costs.costs) {
        auto& rows = variants[name] = nlohmann::ordered_json::array();
        for (const UnitCosts& one : sizes) {
            rows.push_back({{"discs", one.discs},
                            {"placed", one.seconds.placed},
                            {"moved", one.seconds.moved},
                            {"near", one.seconds.near},
                            {"collisions", one.seconds.collisions}});
        }
    }
    return {{"machine", costs.machine}, {"seconds", variants}};
}

} // namespace carom
