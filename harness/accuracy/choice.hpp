#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// The error that a bound is put on, as error_measures.hpp has it.
enum class Measure {
    path,           ///< RMS distance to the exact paths after one unit of time, in radii
    collision_rate, ///< of the whole run, relative to that of the exact one
    pressure,       ///< on the walls over the whole run, likewise
};

/// One way to run a scene.
struct Method {
    const Variant* variant = nullptr;
    int substeps = 1;

    friend bool operator==(const Method&, const Method&) = default;
};

/// Everything that could be chosen for the scene, whether a trial comes to it or not: the event-driven
/// simulation; the fastest variant with collisions at the step's end and at contact, in double and in float,
/// each with 1, 2, 4 ... up to 64 substeps, all of them with few substeps before any with twice as many.
std::vector<Method> methods_for(const Scene& scene);

/// What a trial says of a method.
struct Tried {
    Method method;
    double error = 0;        ///< as measured in the trial
    double margin = 0;       ///< by which the error of the run may be larger
    double setting_up = 0;   ///< seconds, for the whole scene, by costs.hpp
    double unit_seconds = 0; ///< of a unit of time of the whole scene, likewise

    double largest_error() const { return error + margin; }

    /// Seconds of a run of so many units of time.
    double cost(int units) const { return setting_up + unit_seconds * units; }
};

/// Of those whose largest error is at most the bound the one that costs least for so many units of time;
/// empty if there is none. Costs within a tenth of the least are as good as equal: of those the most exact
/// one, then the first.
std::optional<Tried> cheapest_below(std::span<const Tried> tried, double bound, int units);

/// The one with the least of the largest errors. There must be one.
const Tried& most_exact(std::span<const Tried> tried);

/// What an average is made of, in each unit of time of a trial: of the exact simulation, and of another one
/// on the same scene. Collisions, or the momentum that the walls took up.
struct Amounts {
    std::vector<double> exact;
    std::vector<double> other;
    double grain = 1; ///< variance of an amount over its mean; 1 of events that know nothing of each other
};

/// A relative error that is expected, and by how much it may be larger.
struct Expected {
    double error = 0;
    double margin = 0;
};

/// The relative error of an average over `units` of time, of which `amounts` are the first, or, where these
/// are of a piece, over a scene with `times_more` of them. A step begins better than it goes on, since discs
/// that are apart at the start get into each other only then: what is still to come is taken to be as the
/// second half of what was tried.
///
/// The margin is twice the standard deviation of what is still to come beside that half. Amounts are taken
/// for independent, of variance `grain` times their mean. If the trial was the whole run nothing is open.
Expected expected_average_error(const Amounts& amounts, int units, double times_more = 1);

/// The error of paths over a scene, if the discs of a piece of it are off by so much: the squares of their
/// distances to the exact paths, in radii. `moved` is what these squares add up to after one collision that
/// was missed, or made in another order (moved_by_one_collision).
///
/// Few discs make most of such an error, since a collision out of order is rare and moves its discs far. A
/// piece may have none of them. So the margin covers twice the standard deviation of what was seen, the three
/// discs of such a collision moving together, and as many collisions that were not seen as a Poisson
/// distribution leaves possible where none is, three (95 %).
///
/// `whole_over_piece` is the mean square in the scene over that in the piece; one below 1 counts as 1. Of a
/// piece without discs the margin is infinite.
Expected expected_path_error(std::span<const double> squares, double moved, double whole_over_piece = 1);

/// The least share of an error in a piece by which it may be larger in the scene.
constexpr double least_margin_of_piece = 0.25;

/// What one collision that is missed or made in another order adds to the sum of squared distances to the
/// exact paths within a unit of time, in radii: three discs fly on with a velocity that is off by what two of
/// them differ in, from some time of the unit on. Fast discs collide more often in proportion.
double moved_by_one_collision(const Scene& scene);

/// The grain of the momentum that `collisions` with walls took up, `impulse` in all: its mean square over its
/// mean. Where velocities are distributed as in equilibrium those that arrive at a wall have <v^2> = 4/pi
/// <v>^2 (Maxwell 1860); where all discs are about as fast it is less.
double grain_of_impulse(double impulse, double collisions);

} // namespace carom
