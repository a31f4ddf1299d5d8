#pragma once

#include <optional>
#include <span>

#include "variants/registry.hpp"

namespace carom {

/// The error that a bound is put on, as error_measures.hpp has it.
enum class Measure {
    path,           ///< RMS distance to the exact paths after one unit of time, in radii
    collision_rate, ///< of the whole run, relative to that of the exact one
};

/// One way to run a scene.
struct Method {
    const Variant* variant = nullptr;
    int substeps = 1;
};

/// What a trial says of a method.
struct Tried {
    Method method;
    double error = 0;        ///< as measured in the trial
    double margin = 0;       ///< by which the error of the run may be larger
    double setting_up = 0;   ///< seconds, for the whole scene
    double unit_seconds = 0; ///< of a unit of time of the whole scene

    double largest_error() const { return error + margin; }

    /// Seconds of a run of so many units of time.
    double cost(int units) const { return setting_up + unit_seconds * units; }
};

/// Of those whose largest error is at most the bound the one that costs least for so many units of time, of
/// equal cost the first; empty if there is none.
std::optional<Tried> cheapest_below(std::span<const Tried> tried, double bound, int units);

/// The one with the least of the largest errors. There must be one.
const Tried& most_exact(std::span<const Tried> tried);

/// Twice the standard deviation of the difference between the relative errors of a rate of collisions in a
/// run and in a trial of it, in which the exact simulation made `counted` collisions: the trial is the first
/// `share` of the run (0 < share <= 1), or, if not `beginning`, something else as large as that.
///
/// Counts of collisions are taken for independent, of variance equal to their mean: of the exact and of the
/// other simulation, in the trial and in the rest of the run. A trial of the whole run leaves nothing open.
double margin_of_rate(double counted, double share, bool beginning);

} // namespace carom
