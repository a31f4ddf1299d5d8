#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "collide.hpp"
#include "contacts.hpp"
#include "grid.hpp"
#include "policies.hpp"
#include "scene.hpp"
#include "storage.hpp"
#include "tally.hpp"
#include "threads/own_lines.hpp"

namespace carom {

/// What is known of the overlaps, by `Policies::overlaps`.
template <Overlaps overlaps, class Real> struct OverlapsOf;

template <class Real> struct OverlapsOf<Overlaps::lists, Real> {
    std::vector<std::vector<int>>
        overlaps; ///< for each disc those it overlaps; each pair stands in both lists
    std::vector<unsigned char> overlaps_wall; ///< of each disc, whether it overlaps one

    OverlapsOf(const Grid& /*grid*/, int count)
        : overlaps(static_cast<std::size_t>(count)), overlaps_wall(static_cast<std::size_t>(count)) {}
};

template <class Real> struct OverlapsOf<Overlaps::contacts, Real> {
    OwnVector<Strip<Real>> strips;
    UntouchedVector<ActiveSegments::Beside> segments_of_disc;
    ActiveSegments active;
    UntouchedVector<EarliestCollision<Real>> earliest; ///< Impact::at_contact: of each disc
    UntouchedVector<int> changed_in; ///< ditto: of each disc the last sweep in which it collided; -1 before

    OverlapsOf(const Grid& grid, int count)
        : strips(static_cast<std::size_t>(grid.strip_count(strip_height(Order::strips)))),
          segments_of_disc(static_cast<std::size_t>(count)), active(grid.boxes_per_side()) {}
};

/// Root of the mean squared speed of the discs.
inline double usual_speed(const Scene& scene) {
    double sum = 0;
    for (const Disc& disc : scene.discs) {
        sum += disc.vx * disc.vx + disc.vy * disc.vy;
    }
    return std::sqrt(sum / static_cast<double>(std::max(scene.discs.size(), std::size_t{1})));
}

/// What a simulation knows between its phases.
template <Policies policies = Policies{}>
struct State : DiscsOf<policies.storage, RealOf<policies.precision>>,
               OverlapsOf<policies.overlaps, RealOf<policies.precision>> {
    using Real = RealOf<policies.precision>;
    using Discs = DiscsOf<policies.storage, Real>;

    Real side;
    Real radius;
    Real speed; ///< Impact::at_contact: root of the mean squared speed, which collisions keep; else 0
    int steps_flown = 0; ///< ditto: since the start, two at most
    Grid grid;

    /// Built on as many threads as will step it.
    explicit State(const Scene& scene, int threads = 1)
        : State(scene,
                Grid(scene.side, widest_search_radius(scene.radius), static_cast<int>(scene.discs.size()),
                     policies.box_side,
                     policies.box_side == BoxSide::wide ? rest_of(policies.order) : Rest::own_box),
                threads) {}

    /// Goes back to the start of the scene it was built of, on as many threads, and keeps its memory. All
    /// else that it holds each step writes before it reads it.
    void restart(const Scene& scene, int threads) {
        Discs::place(scene, threads);
        steps_flown = 0;
    }

    BasicDisc<Real>& disc(int i) { return this->discs[static_cast<std::size_t>(i)]; }
    const BasicDisc<Real>& disc(int i) const { return this->discs[static_cast<std::size_t>(i)]; }
    int count() const { return static_cast<int>(this->discs.size()); }
    Real reach_squared() const { return (2 * radius) * (2 * radius); }

    /// Discs whose centres are within twice this at the end of a step of dt are looked at.
    /// Impact::at_contact: also those between which a typical way lies, that of a disc in the step, but an
    /// eighth of their own size at most. They may have met and parted again, or a collision may move them
    /// together.
    Real search_radius(Real dt) const {
        return policies.impact == Impact::at_contact
                   ? std::min(radius + speed * dt / 2, static_cast<Real>(widest_search_radius(radius)))
                   : radius;
    }

    decltype(auto) discs_in(int row, int column) const {
        return Discs::discs_in_box(grid.box_of(row, column));
    }

    bool is_empty(int row, int column) const {
        const auto& discs = discs_in(row, column);
        return discs.begin() == discs.end();
    }

  private:
    static double widest_search_radius(double radius) {
        return policies.impact == Impact::at_contact ? radius * (1 + 0x1p-3) : radius;
    }

    State(const Scene& scene, const Grid& its_grid, int threads)
        : Discs(scene, its_grid, threads),
          OverlapsOf<policies.overlaps, Real>(its_grid, static_cast<int>(scene.discs.size())),
          side(static_cast<Real>(scene.side)), radius(static_cast<Real>(scene.radius)),
          speed(policies.impact == Impact::at_contact ? static_cast<Real>(usual_speed(scene)) : 0),
          grid(its_grid) {
        assert(scene.discs.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
    }
};

template <Policies policies> using StripOf = Strip<RealOf<policies.precision>>;
template <Policies policies> using ApproachToleranceOf = ApproachTolerance<RealOf<policies.precision>>;

/// The discs in double, disc i at index i.
template <Policies policies> std::vector<Disc> discs_by_number(const State<policies>& state) {
    std::vector<Disc> discs(state.discs.size());
    for (int i = 0; i < state.count(); ++i) {
        discs[static_cast<std::size_t>(state.number(i))] = disc_cast<double>(state.disc(i));
    }
    return discs;
}

} // namespace carom
