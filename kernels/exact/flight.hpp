#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// A disc in free flight since its last collision, and the collision that it has foreseen. In double it fills
/// one cache line of most processors, 64 bytes: nothing else is asked of a disc that is near another one.
template <class Real> struct alignas(64) Flight {
    static constexpr int nobody = -1;

    Real x = 0;
    Real y = 0;
    Real vx = 0;
    Real vy = 0;
    Real time = 0;                                               ///< of its last collision, at x and y
    Real collision_time = std::numeric_limits<Real>::infinity(); ///< of the next collision foreseen
    int partner = nobody;                                        ///< of the next collision: a disc or a wall
    std::uint32_t partner_age = 0;                               ///< the partner's age when it was foreseen
    std::uint32_t age = 0;                                       ///< collisions so far
    int cell = 0;                                                ///< of EventCells

    /// The number that orders collisions of one instant beside that of the disc itself: of its partner, of a
    /// wall the disc's own.
    int ranks_as(int disc) const { return partner >= 0 ? partner : disc; }

    void move_to(Real now) {
        const Real elapsed = now - time;
        x += vx * elapsed;
        y += vy * elapsed;
        time = now;
    }
};

/// The flights of a scene's discs at the start, in place of those that are there.
template <class Real> void begin_flights(const Scene& scene, std::vector<Flight<Real>>& flights) {
    flights.clear();
    for (const Disc& disc : scene.discs) {
        flights.push_back({.x = static_cast<Real>(disc.x),
                           .y = static_cast<Real>(disc.y),
                           .vx = static_cast<Real>(disc.vx),
                           .vy = static_cast<Real>(disc.vy)});
    }
}

} // namespace carom
