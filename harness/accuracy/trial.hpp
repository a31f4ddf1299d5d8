#pragma once

#include <cstddef>
#include <vector>

#include "harness/accuracy/choice.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What came of trying methods on the beginning of a scene, or on a piece of it.
struct Trial {
    std::vector<Tried> tried; ///< never empty; the event-driven simulation is the first
    std::size_t discs = 0;    ///< of the scene or its piece
    bool whole_scene = false; ///< not a piece of it
    int units_of_time = 0;    ///< that each method ran
    double seconds = 0;       ///< that all of it took
};

/// Tries the methods for the scene until the cheapest of them with an error below `bound` is known: each
/// variant until its error is below the bound or it costs more than one that is. Each runs on the threads and
/// with the tolerance of `tuning`. No clock decides anything: what a method costs is its work, counted, at
/// the costs of costs.hpp, so that the same scene and bound choose the same on any machine and any threads.
///
/// Errors are against the event-driven simulation, as in error_measures.hpp: in double, its own in long
/// double. A scene of more than `largest_trial` discs is tried on the busiest of its pieces of that size. The
/// error of paths may be less there than in the run, by how much says expected_path_error. All of it costs
/// about a second at most. The discs must be apart at the start, and the scene have a unit of time. Throws
/// CheckError if the collisions of an instant do not come to an end.
Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound);

/// Discs of the largest scene that is tried as a whole. Averages need fewer, for longer.
constexpr std::size_t largest_trial(Measure measure) { return measure == Measure::path ? 20'000 : 4'000; }

} // namespace carom
