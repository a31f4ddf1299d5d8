#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/collisions/collision_checker.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/scenes/random_scenes.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/overlap_groups.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/registry.hpp"

// Every variant on random scenes of every kind, step by step, against the checker and, in double, against the
// overlaps that looking at all pairs finds.

namespace carom {
namespace {

using tests::same_bits;

constexpr int shards = 8;

/// A resolve may go on without end only where discs are wedged between opposite walls: it is given up early
/// at first, and only where nothing is wedged tried again with more patience.
constexpr int few_sweeps = 12;
const std::string endless = "the resolve does not end although nothing is wedged between walls";

/// What holds of a step before anything is resolved, found by looking at every pair.
struct Moved {
    std::vector<Disc> discs;
    std::int64_t overlaps = 0;
    bool wedged = false; ///< does a group of overlapping discs reach from one wall to the one opposite?

    Moved(const Scene& scene, const std::vector<Disc>& before, double dt) : discs(before) {
        const double radius = scene.radius;
        std::vector<OverlappingPair> pairs;
        for (int i = 0; i < static_cast<int>(discs.size()); ++i) {
            Disc& disc = discs[static_cast<std::size_t>(i)];
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
            for (int k = 0; k < i; ++k) {
                if (overlap(discs[static_cast<std::size_t>(k)], disc, (2 * radius) * (2 * radius))) {
                    pairs.push_back({k, i});
                }
            }
        }
        overlaps = static_cast<std::int64_t>(pairs.size());
        OverlapGroups groups(discs.size(), pairs);
        std::vector<unsigned> walls(discs.size());
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const Disc& disc = discs[i];
            unsigned& touched = walls[static_cast<std::size_t>(groups.lowest(static_cast<int>(i)))];
            touched |= (disc.x - radius <= 0 ? 1u : 0u) | (disc.x + radius >= scene.side ? 2u : 0u) |
                       (disc.y - radius <= 0 ? 4u : 0u) | (disc.y + radius >= scene.side ? 8u : 0u);
            wedged = wedged || (touched & 3) == 3 || (touched & 12) == 12;
        }
    }
};

/// The same with a little to spare, for a variant that rounds otherwise than this test.
bool nearly_wedged(Scene scene, const std::vector<Disc>& discs) {
    scene.radius *= 1 + 1e-4;
    return Moved(scene, discs, 0).wedged;
}

/// Runs one variant through one scene; the first thing that is wrong, or nothing. A float variant need not
/// agree with what this test computes in double: it answers to its checker alone.
std::optional<std::string> first_wrong(const Scene& scene, const Variant& variant, const Tuning& tuning) {
    const double dt = 1.0 / tuning.substeps;
    const Rounding rounding = rounding_of(variant.policies);
    const bool at_contact = variant.policies.impact == Impact::at_contact;
    const Checker checker(scene.side, scene.radius, dt, tuning.tolerance, rounding, variant.policies.impact);
    const auto collisions = collision_checker(scene, variant, tuning);
    const auto simulation = collisions ? variant.simulate_logged(scene, tuning, collisions->log())
                                       : variant.simulate(scene, tuning);
    for (int step = 1; step <= scene.steps * tuning.substeps; ++step) {
        const std::vector<Disc> before = simulation->discs();
        const Moved moved(scene, before, dt);
        const Tally tally = simulation->step();
        const std::vector<Disc>& after = simulation->discs();
        const std::string where = "step " + std::to_string(step) + ": ";
        if (rounding.is_double() && tally.overlaps != moved.overlaps) {
            return where + std::to_string(tally.overlaps) + " overlaps were found of " +
                   std::to_string(moved.overlaps);
        }
        if (!tally.settled) {
            const bool wedged =
                rounding.is_double() && !at_contact ? moved.wedged : nearly_wedged(scene, after);
            return wedged ? std::nullopt : std::optional(where + endless);
        }
        if (const auto violation = checker.step(before, after)) {
            return where + *violation;
        }
        if (const auto violation = collisions ? collisions->step(before, after) : std::nullopt) {
            return where + *violation;
        }
        if (rounding.is_double() && !tally.changed() && !same_bits(after, moved.discs)) {
            return where + "nothing was resolved, and yet velocities changed";
        }
    }
    return std::nullopt;
}

/// The same, giving every resolve the time that it needs.
std::optional<std::string> first_wrong_in_the_end(const Scene& scene, const Variant& variant, Tuning tuning) {
    auto wrong = first_wrong(scene, variant, tuning);
    if (!wrong || !wrong->ends_with(endless)) {
        return wrong;
    }
    tuning.sweep_limit = Tuning{}.sweep_limit;
    return first_wrong(scene, variant, tuning);
}

Tuning awkward_tuning(std::uint64_t seed) {
    tests::Random random(~seed);
    return {.threads = 1 + random.below(4),
            .find_chunk = 1 + random.below(9),
            .resolve_chunk = 1 + random.below(9),
            .substeps = 1 + random.below(2),
            .sweep_limit = few_sweeps};
}

class PhysicsFuzz : public testing::TestWithParam<int> {};

TEST_P(PhysicsFuzz, EveryVariantIsRightOnRandomScenes) {
    for (auto seed = static_cast<std::uint64_t>(GetParam()); seed < tests::fuzz_scenes(); seed += shards) {
        const Scene scene = tests::awkward_scene(seed);
        const Tuning tuning = awkward_tuning(seed);
        for (const Variant& variant : variants()) {
            if (!holds(variant.policies, scene)) {
                continue;
            }
            if (const auto wrong = first_wrong_in_the_end(scene, variant, tuning)) {
                FAIL() << "scene " << seed << ", variant " << variant.name << ", " << tuning.threads
                       << " threads, chunks of " << tuning.find_chunk << " and " << tuning.resolve_chunk
                       << ", " << tuning.substeps << " substeps, " << *wrong << "\n"
                       << scene_text(scene);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shards, PhysicsFuzz, testing::Range(0, shards));

} // namespace
} // namespace carom
