#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// How far a run is from the reference at one time.
struct DistanceAt {
    int time;            ///< from the start, in units of time
    double rms_distance; ///< root of the mean squared distance of the discs to theirs, in units of r
};

/// A run beside the event-driven reference of the same scene.
struct AgainstReference {
    std::vector<DistanceAt> trajectory;      ///< at times 1, 2, 4, 8 ... and S
    std::optional<int> time_to_tenth_radius; ///< first unit of time at whose end the distance is above 0.1 r
    double collision_rate = 0;               ///< pair collisions of the reference per disc and unit of time
    double pressure = 0;                     ///< on the reference's walls
    double speed_distance = 0;               ///< see kolmogorov_smirnov_distance
};

/// How wrong a run is, by every measure, all of them from one run of all S steps.
struct ErrorMeasures {
    std::optional<double> energy_drift;   ///< (E_end - E_start) / E_start; empty if nothing moves
    std::optional<double> momentum_drift; ///< see MomentumBalance; empty if nothing moves
    double penetration_worst = 0;         ///< 2 - |d| / r of pairs that were apart at the start, at any step
    double penetration_mean = 0; ///< over all such overlaps at the end of all steps; 0 if there are none
    std::int64_t unresolved_pairs = 0;    ///< pairs and walls left colliding, summed over the units of time
    int discs_outside = 0;                ///< centres outside [0, L]^2 at the end
    std::optional<double> collision_rate; ///< pairs resolved per disc and unit of time; empty without either
    std::optional<double> pressure;       ///< momentum that the walls took up per length of wall and time
    std::string pressure_reason;          ///< why there is none
    std::optional<AgainstReference> reference;
    std::string reference_reason; ///< why there is none
    std::vector<Disc> discs;      ///< the final state
};

/// Most collisions that the reference of one run may take: under half a minute or so.
inline constexpr std::int64_t most_reference_collisions = 20'000'000;

/// Runs the scene once, with the reference alongside, and measures every step. Takes several times as long as
/// the run itself: nothing to be timed. The event-driven simulation is compared with itself in long double,
/// and its penetration is that at the ends of units of time. Throws CheckError if a resolve does not end.
ErrorMeasures measure_errors(const Scene& scene, const Variant& variant, const Tuning& tuning,
                             std::int64_t most_collisions = most_reference_collisions);

/// The measures as the field `errors` of a record (record.schema.json).
nlohmann::ordered_json error_measures_json(const ErrorMeasures& measures);

/// The largest difference between the shares of the two samples below any value (Kolmogorov 1933, Smirnov
/// 1939): 0 for the same distribution, 1 for one that lies wholly above the other. Values closer than 1e-6 of
/// the largest count as one, so that rounding does not part a few equal ones. 0 if a sample is empty.
double kolmogorov_smirnov_distance(std::vector<double> one, std::vector<double> two);

} // namespace carom
