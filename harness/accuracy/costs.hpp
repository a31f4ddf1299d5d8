#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

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

/// Seconds that a unit of each kind of work takes on one thread, in a scene of so many discs.
struct UnitCosts {
    double discs = 0;
    Work seconds;
};

/// What work costs on a machine. Measured once and kept, so that what is chosen by it is the same every time.
class Costs {
  public:
    std::string machine;                                 ///< its processor
    std::map<std::string, std::vector<UnitCosts>> costs; ///< of each variant, by rising number of discs

    /// Seconds of that work of a variant in a scene of so many discs: between the sizes that were measured
    /// along the logarithm of the size, beyond them as at the last. A variant that was not measured costs
    /// what the dearest does.
    double seconds(const Variant& variant, double discs, const Work& work) const;
};

/// The work of a step of a variant on that scene, without the collisions.
Work work_of_step(const Variant& variant, const Scene& scene);

/// The work of a unit of time of the event-driven simulation, without the collisions.
Work work_of_events(const Scene& scene);

/// Measures the costs on scenes of its own, in some three seconds. Whatever else runs can only lengthen a
/// measurement, so that of several the shortest holds.
Costs measure_costs();

/// Where the costs of this machine are kept: in $XDG_CACHE_HOME, else in ~/.cache. Empty without either.
std::filesystem::path costs_file();

/// The costs that are kept for this machine, if there are any.
std::optional<Costs> kept_costs();

/// Those that are kept. If there are none they are measured and kept; where they cannot be kept, typical ones
/// hold, so that the same is chosen every time, and a note says so.
Costs costs_of_machine();

/// Of some machine.
Costs typical_costs();

nlohmann::ordered_json costs_json(const Costs& costs);

} // namespace carom
