#include "variants/least_memory.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/exact/flight.hpp"
#include "kernels/grid.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

/// Of a disc in steps: where it is, in sorted storage in the order before as well, and its list.
std::size_t bytes_per_disc(const Policies& policies) {
    const std::size_t disc =
        policies.precision == Precision::float_ ? sizeof(BasicDisc<float>) : sizeof(BasicDisc<double>);
    const std::size_t list = policies.overlaps == Overlaps::lists ? sizeof(std::vector<int>) : 0;
    return (policies.storage == Storage::sorted ? 2 : 1) * disc + list;
}

} // namespace

std::int64_t least_memory(const Variant& variant, const Scene& box, std::int64_t discs, int threads) {
    const auto bytes = [](std::int64_t count, std::size_t of_one) {
        return count * static_cast<std::int64_t>(of_one);
    };
    const std::int64_t at_end = bytes(discs, sizeof(Disc));
    if (variant.engine == Engine::event_driven) {
        const bool in_tiles = tiles_for(static_cast<std::size_t>(discs), threads).all() > 1;
        const std::size_t flights =
            (in_tiles ? 2 : 1) * sizeof(Flight<double>);                       // now, and at a window's begin
        return at_end + bytes(discs, flights + sizeof(std::array<double, 2>)); // and in the queue
    }
    constexpr std::size_t of_thread = 32 << 10; // stack and heap, as measured
    const Policies& policies = variant.policies;
    const Grid grid(box.side, box.radius, static_cast<int>(discs), policies.box_side);
    const bool sorted = policies.storage == Storage::sorted;
    return at_end + bytes(discs, bytes_per_disc(policies)) +
           bytes(grid.box_count(), sorted ? sizeof(int) : sizeof(std::vector<int>)) +
           bytes(threads, of_thread);
}

} // namespace carom
