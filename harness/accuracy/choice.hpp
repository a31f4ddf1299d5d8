#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "harness/accuracy/error_measures.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// The error that a bound is put on.
enum class Measure {
    path,           ///< RMS distance to the exact paths after one unit of time, in radii
    collision_rate, ///< of the whole run, relative to that of the exact one
    pressure,       ///< on the walls over the whole run, likewise
};

/// That error of a run; infinity if it is not known.
double error_by(const ErrorMeasures& errors, Measure measure);

/// One way to run a scene.
struct Method {
    const Variant* variant = nullptr;
    int substeps = 1;

    friend bool operator==(const Method&, const Method&) = default;
};

/// What a trial says of a method.
struct TrialResult {
    Method method;
    double error = 0;  ///< as measured in the trial
    double margin = 0; ///< by which the error of the run may be larger; 0 if the trial leaves nothing open
    double unit_seconds = 0; ///< that a unit of time of the whole scene takes on one thread

    double largest_error() const { return error + margin; }
    friend bool operator==(const TrialResult&, const TrialResult&) = default;
};

/// What came of trying methods on the beginning of a scene, or on a piece of it.
struct Trial {
    std::vector<TrialResult> results; ///< never empty; the event-driven simulation is the first
    std::size_t discs = 0;            ///< of the scene or its piece
    bool whole_scene = false;         ///< not a piece of it
    int units_of_time = 0;            ///< that each method ran
    double seconds = 0;               ///< that all of it took
};

/// Tries the event-driven simulation, then the fastest variant with collisions at contact and at the step's
/// end, each with 1, 2, 4 ... up to 64 substeps until its error is below `bound` or it costs more than the
/// event-driven simulation. Each is measured as error_measures.hpp does it, on the threads and with the
/// tolerance of `tuning`. No clock decides: what a method costs is its work, counted, times what each kind of
/// work took once on one machine. So the same scene and bound choose the same on any machine and any threads.
///
/// A scene of more than `largest_trial` discs is tried on the busiest of its pieces of that size, and of a
/// long run no more than the beginning if an average is asked for. What that leaves open is the margin: a
/// quarter of the error at least, and
///  - of averages twice the standard deviation of the collisions of both simulations, taken for independent;
///  - of paths as many collisions more that are missed, or made in another order, as a Poisson distribution
///    leaves possible: three where none was seen (95 %). Few such discs make most of the error of paths, and
///    a piece may have none of them.
///
/// The discs must be apart at the start, and the scene have a unit of time. Throws CheckError if the
/// collisions of an instant do not come to an end.
Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound);

/// Discs of the largest scene that is tried as a whole. Averages need fewer, for longer.
constexpr std::size_t largest_trial(Measure measure) { return measure == Measure::path ? 20'000 : 4'000; }

/// Of those whose largest error is at most the bound the one that costs least; empty if there is none.
std::optional<TrialResult> cheapest_below(std::span<const TrialResult> results, double bound);

/// The one with the least of the largest errors. There must be one.
const TrialResult& most_exact(std::span<const TrialResult> results);

} // namespace carom
