#pragma once

#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// What a method does to a scene, counted: the same on every machine and for any number of threads.
struct Work {
    double placed = 0;     ///< discs put in place at the start
    double moved = 0;      ///< discs times steps; of the event-driven simulation, crossings between cells
    double near = 0;       ///< pairs near enough to be looked at; of the event-driven simulation, discs times
                           ///< units of time, since each unit ends with every disc brought to one time
    double collisions = 0; ///< made

    Work& operator+=(const Work& more);
    friend Work operator*(double times, const Work& work);
};

/// Seconds that this work of a variant takes on one thread in a scene of so many discs, as on the machine on
/// which the costs of each kind of work were measured: by these the same is chosen every time, everywhere.
/// Between the sizes that were measured they lie along the logarithm of the size, beyond them as at the last.
double seconds_of(const Variant& variant, double discs, const Work& work);

/// The work of a step of a variant on that scene, without the collisions.
Work work_of_step(const Variant& variant, const Scene& scene);

/// The work of a unit of time of the event-driven simulation, without the collisions.
Work work_of_events(const Scene& scene);

} // namespace carom
