#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// Equal, and not 0 and -0.
template <class Real> bool same_bits(Real one, Real other) {
    return one == other && std::signbit(one) == std::signbit(other);
}

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

    /// Who else has part in the next collision: its partner, of a wall the disc itself.
    int beside(int disc) const { return partner >= 0 ? partner : disc; }

    /// Does it fly the same way since the same collision, to the bit?
    bool is_as(const Flight& other) const {
        return same_bits(x, other.x) && same_bits(y, other.y) && same_bits(vx, other.vx) &&
               same_bits(vy, other.vy) && same_bits(time, other.time);
    }

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
