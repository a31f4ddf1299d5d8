#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "policies.hpp"
#include "scene.hpp"

namespace carom {

/// Do the two discs overlap or touch? |d|^2 <= (2r)^2 with d = p2 - p1; `reach_squared` is (2r)^2.
template <class Real = double>
bool overlap(const BasicDisc<Real>& first, const BasicDisc<Real>& second,
             std::type_identity_t<Real> reach_squared) {
    const Real dx = second.x - first.x;
    const Real dy = second.y - first.y;
    return dx * dx + dy * dy <= reach_squared;
}

/// Decides whether an overlapping pair approaches: (v2 - v1).d < -tolerance.
///
/// relative: tolerance = c |d| sqrt(|v1|^2 + |v2|^2) with c = 64 machine epsilons. After a resolve the
/// computed approach differs from zero by the rounding of the velocities themselves, a few epsilons of
/// |v||d|; an approach below that can be neither seen nor removed. Measuring against |v2 - v1||d| alone would
/// not bound it: where two fast discs move almost together, their difference is all rounding. Scaling lengths
/// or times by a power of two changes no decision. published: tolerance = 1e-7 (length^2 per time), whatever
/// the units.
template <class Real = double> struct ApproachTolerance {
    Real relative;
    Real absolute;
    Real sure; ///< see surely_counts

    explicit ApproachTolerance(Tolerance tolerance)
        : relative(tolerance == Tolerance::relative ? 64 * std::numeric_limits<Real>::epsilon() : 0),
          absolute(tolerance == Tolerance::published ? static_cast<Real>(1e-7) : 0),
          sure(tolerance == Tolerance::relative ? 2 * (relative * relative)
                                                : std::numeric_limits<Real>::infinity()) {}

    /// `approach` is (v2 - v1).d; `distance_squared` is |d|^2, `speed_squared` |v1|^2 + |v2|^2.
    bool counts(Real approach, Real distance_squared, Real speed_squared) const {
        return approach < -absolute &&
               (relative == 0 || approach < -relative * std::sqrt(distance_squared * speed_squared));
    }

    /// Does an approach below 0 surely count, whatever the rounding? `scale` is |d|^2 (|v1|^2 + |v2|^2). It
    /// spares nearly every pair the root; where it is false, `counts` decides.
    bool surely_counts(Real approach, Real scale) const { return approach * approach > sure * scale; }
};

/// Centres closer than this, squared, are coincident: |d|^2 has too few bits left to give a normal.
template <class Real>
inline constexpr Real coincident_squared =
    std::numeric_limits<Real>::min() / std::numeric_limits<Real>::epsilon();

/// Both components of a vector in one register. Loaded and stored together: a processor waits where it must
/// put together what was stored apart.
template <class Real> struct BothComponents {
    using Register [[gnu::vector_size(2 * sizeof(Real))]] = Real;
    static constexpr std::size_t position_offset = offsetof(BasicDisc<Real>, x);
    static constexpr std::size_t velocity_offset = offsetof(BasicDisc<Real>, vx);
    static_assert(offsetof(BasicDisc<Real>, y) == position_offset + sizeof(Real));
    static_assert(offsetof(BasicDisc<Real>, vy) == velocity_offset + sizeof(Real));

    static Register load(const std::array<Real, 2>& vector) {
        Register both;
        std::memcpy(&both, vector.data(), sizeof both);
        return both;
    }
    static Register load_position(const BasicDisc<Real>& disc) { return load_at<position_offset>(disc); }
    static Register load_velocity(const BasicDisc<Real>& disc) { return load_at<velocity_offset>(disc); }
    static void store_velocity(Register both, BasicDisc<Real>& disc) {
        std::memcpy(reinterpret_cast<unsigned char*>(&disc) + velocity_offset, &both, sizeof both);
    }
    static Real sum(Register both) { return both[0] + both[1]; }

  private:
    template <std::size_t offset> static Register load_at(const BasicDisc<Real>& disc) {
        static_assert(offset % sizeof(Register) == 0 && alignof(BasicDisc<Real>) % sizeof(Register) == 0);
        Register both;
        const auto* const bytes = reinterpret_cast<const unsigned char*>(&disc) + offset;
        std::memcpy(&both, std::assume_aligned<sizeof(Register)>(bytes), sizeof both);
        return both;
    }
};

/// A disc whose collisions with others are being resolved. Its velocity stays in a register until it is
/// stored.
template <class Real> struct DiscInRegisters {
    using Both = BothComponents<Real>;
    typename Both::Register position;
    typename Both::Register velocity;

    explicit DiscInRegisters(const BasicDisc<Real>& disc)
        : position(Both::load_position(disc)), velocity(Both::load_velocity(disc)) {}

    void store_velocity(BasicDisc<Real>& disc) const { Both::store_velocity(velocity, disc); }
};

/// Resolves an overlapping pair if it collides; returns whether it did.
///
/// Equal masses, elastic, frictionless: the impulse acts along d and conserves momentum, so v1' = v1 + s d
/// and v2' = v2 - s d. Energy |v1'|^2 + |v2'|^2 = |v1|^2 + |v2|^2 leaves s = 0 or s = ((v2 - v1).d) / |d|^2:
/// the normal components are exchanged (Landau and Lifshitz, Mechanics, section 17). Coincident centres have
/// no normal and are not colliding.
template <class Real>
[[gnu::always_inline]] inline bool resolve_pair(DiscInRegisters<Real>& first, BasicDisc<Real>& second,
                                                const ApproachTolerance<Real>& approaching) {
    using Both = BothComponents<Real>;
    const auto distance = Both::load_position(second) - first.position;
    const auto velocity2 = Both::load_velocity(second);
    const Real approach = Both::sum((velocity2 - first.velocity) * distance);
    if (!(approach < 0)) {
        return false;
    }
    const Real distance_squared = Both::sum(distance * distance);
    const Real speed_squared = Both::sum(first.velocity * first.velocity + velocity2 * velocity2);
    if (distance_squared < coincident_squared<Real> ||
        (!approaching.surely_counts(approach, distance_squared * speed_squared) &&
         !approaching.counts(approach, distance_squared, speed_squared))) {
        return false;
    }
    const auto impulse = approach / distance_squared * distance;
    first.velocity = first.velocity + impulse;
    Both::store_velocity(velocity2 - impulse, second);
    return true;
}

/// The same for two discs in memory.
template <class Real>
[[gnu::always_inline]] inline bool resolve_pair(BasicDisc<Real>& first, BasicDisc<Real>& second,
                                                const ApproachTolerance<Real>& approaching) {
    DiscInRegisters<Real> in_registers(first);
    const bool resolved = resolve_pair(in_registers, second, approaching);
    if (resolved) {
        in_registers.store_velocity(first);
    }
    return resolved;
}

/// The terms of (v2 - v1).n, which are to be added.
template <class Real>
[[gnu::always_inline]] inline auto approach_by_component(const std::array<Real, 2>& normal,
                                                         const BasicDisc<Real>& first,
                                                         const BasicDisc<Real>& second) {
    using Both = BothComponents<Real>;
    return (Both::load_velocity(second) - Both::load_velocity(first)) * Both::load(normal);
}

/// (v2 - v1).n
template <class Real>
[[gnu::always_inline]] inline Real approach_along(const std::array<Real, 2>& normal,
                                                  const BasicDisc<Real>& first,
                                                  const BasicDisc<Real>& second) {
    return BothComponents<Real>::sum(approach_by_component(normal, first, second));
}

/// As resolve_pair, for a pair whose unit normal n = d / |d| is known: then s d = ((v2 - v1).n) n.
template <class Real>
[[gnu::always_inline]] inline bool resolve_along(const std::array<Real, 2>& normal, BasicDisc<Real>& first,
                                                 BasicDisc<Real>& second,
                                                 const ApproachTolerance<Real>& approaching) {
    using Both = BothComponents<Real>;
    const Real approach = approach_along(normal, first, second);
    if (!(approach < 0)) {
        return false;
    }
    const auto velocity1 = Both::load_velocity(first);
    const auto velocity2 = Both::load_velocity(second);
    const Real speed_squared = Both::sum(velocity1 * velocity1 + velocity2 * velocity2);
    if (!approaching.surely_counts(approach, speed_squared)) [[unlikely]] {
        const Real distance =
            approaching.absolute > 0 ? std::hypot(second.x - first.x, second.y - first.y) : Real{1};
        if (!approaching.counts(approach * distance, distance * distance, speed_squared)) {
            return false;
        }
    }
    const auto impulse = approach * Both::load(normal);
    Both::store_velocity(velocity1 + impulse, first);
    Both::store_velocity(velocity2 - impulse, second);
    return true;
}

/// Does the disc overlap or touch a wall?
template <class Real = double>
bool overlaps_wall(const BasicDisc<Real>& disc, std::type_identity_t<Real> side,
                   std::type_identity_t<Real> radius) {
    return disc.x - radius <= 0 || disc.x + radius >= side || disc.y - radius <= 0 || disc.y + radius >= side;
}

/// A disc that moves into a wall that it overlaps moves away from each wall that it overlaps, at the same
/// speed; returns how many components of its velocity were turned.
template <class Real = double>
int resolve_walls(BasicDisc<Real>& disc, std::type_identity_t<Real> side, std::type_identity_t<Real> radius) {
    const auto is_low = [&](Real position) { return position - radius <= 0; };
    const auto is_high = [&](Real position) { return position + radius >= side; };
    const auto into_wall = [&](Real position, Real velocity) {
        return (is_low(position) && velocity < 0) || (is_high(position) && velocity > 0);
    };
    const int turned = into_wall(disc.x, disc.vx) + into_wall(disc.y, disc.vy);
    if (turned == 0) {
        return 0;
    }
    const auto turn_away = [&](Real position, Real& velocity) {
        // Wedged between two walls it is turned, as long as somebody goes on asking.
        if (is_low(position) && is_high(position)) {
            velocity = -velocity;
        } else if (is_low(position)) {
            velocity = std::abs(velocity);
        } else if (is_high(position)) {
            velocity = -std::abs(velocity);
        }
    };
    turn_away(disc.x, disc.vx);
    turn_away(disc.y, disc.vy);
    return turned;
}

} // namespace carom
