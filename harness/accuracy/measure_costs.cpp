#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/costs.hpp"
#include "harness/machine/machine.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/support/process_clock.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

constexpr std::array sizes_measured{2'000, 40'000, 400'000};

/// The least of how long it takes, of several times while that costs little.
template <class Run> double shortest(const Run& run) {
    constexpr double enough = 0.03;
    constexpr int most = 7;
    double least = std::numeric_limits<double>::infinity();
    double all = 0;
    for (int turn = 0; turn < most && all < enough * (turn < 2 ? most : 1); ++turn) {
        const double seconds = run();
        least = std::min(least, seconds);
        all += seconds;
    }
    return least;
}

/// Discs apart from each other in no order, as runs come to, of one speed that makes them fly `flown` radii
/// in a unit of time. In a lattice each cell would hold as many, which takes half the time.
Scene measured_scene(int count, double area_fraction, double flown) {
    return generate({.count = count,
                     .side = std::sqrt(count * std::numbers::pi / area_fraction),
                     .radius = 1,
                     .steps = 1,
                     .least_velocity = flown,
                     .largest_velocity = flown,
                     .seed = 4711,
                     .placement = Placement::random,
                     .isotropic = true});
}

struct Timed {
    Work work;
    double set_up = 0; ///< seconds
    double run = 0;    ///< seconds of what comes then
};

/// A step, or a unit of time, after the first, which is also the first to touch its memory.
Timed timed(const Variant& variant, const Scene& scene) {
    const bool exact = variant.engine == Engine::event_driven;
    Timed result{.work = exact ? work_of_events(scene) : work_of_step(variant, scene)};
    result.set_up = std::numeric_limits<double>::infinity();
    result.run = shortest([&] {
        const double before = process_seconds();
        const auto simulation = variant.simulate(scene, {});
        const double ready = process_seconds();
        simulation->step();
        const double begun = process_seconds();
        const Tally tally = simulation->step();
        const double ended = process_seconds();
        result.set_up = std::min(result.set_up, ready - before);
        result.work.collisions = static_cast<double>(tally.pair_resolves + tally.wall_resolves);
        return ended - begun;
    });
    return result;
}

/// Of three measurements what a unit of each kind of work takes: where nearly nothing is near and collides;
/// where much is near and little collides; where much collides. Not below 0, where noise would have it so.
UnitCosts fitted(const Timed& dilute, const Timed& dense, const Timed& colliding) {
    UnitCosts found;
    Work& each = found.seconds;
    each.moved = dilute.run / dilute.work.moved;
    for (int round = 0; round < 20; ++round) { // they enter each other's equations by little
        const auto rest = [](double seconds, double work) {
            return std::max(seconds, 0.0) / std::max(work, 1.0);
        };
        each.collisions =
            rest(colliding.run - each.moved * colliding.work.moved - each.near * colliding.work.near,
                 colliding.work.collisions);
        each.near =
            dense.work.near > 0
                ? rest(dense.run - each.moved * dense.work.moved - each.collisions * dense.work.collisions,
                       dense.work.near)
                : 0;
        each.moved =
            rest(dilute.run - each.near * dilute.work.near - each.collisions * dilute.work.collisions,
                 dilute.work.moved);
    }
    return found;
}

/// Of the event-driven simulation. A crossing looks into three cells where a collision looks twice into nine,
/// and both change the queue: it is taken for four tenths of a collision, since a measurement of both at once
/// would leave to noise which of them takes how much.
UnitCosts fitted_events(const Timed& dilute, const Timed& colliding) {
    constexpr double of_a_collision = 0.4;
    const auto events = [](const Work& work) { return work.collisions + of_a_collision * work.moved; };
    UnitCosts found;
    Work& each = found.seconds;
    for (int round = 0; round < 20; ++round) {
        each.collisions =
            std::max(colliding.run - each.near * colliding.work.near, 0.0) / events(colliding.work);
        each.near = std::max(dilute.run - each.collisions * events(dilute.work), 0.0) / dilute.work.near;
    }
    each.moved = of_a_collision * each.collisions;
    return found;
}

} // namespace

Costs measure_costs() {
    Costs costs{.machine = read_machine().cpu_model, .costs = {}};
    for (const int count : sizes_measured) {
        const Scene dilute = measured_scene(count, 0.02, 0.5);
        const Scene dense = measured_scene(count, 0.4, 0.01);
        const Scene colliding = measured_scene(count, 0.4, 0.5);
        for (const Method& method : methods_for(dilute)) {
            if (method.substeps != 1) {
                break;
            }
            const Variant& variant = *method.variant;
            const Timed much = timed(variant, colliding);
            UnitCosts found = variant.engine == Engine::event_driven
                                  ? fitted_events(timed(variant, dilute), much)
                                  : fitted(timed(variant, dilute), timed(variant, dense), much);
            found.discs = count;
            found.seconds.placed = much.set_up / count;
            costs.costs[std::string(variant.name)].push_back(found);
        }
    }
    return costs;
}

} // namespace carom
