#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
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
#include "kernels/collide.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/registry.hpp"

// Every variant on random scenes of every kind, step by step, against the checker; in double the overlaps
// are counted anew.

namespace carom {
namespace {

using tests::same_bits;

constexpr int shards = 8;

/// A resolve may go on without end only where discs are wedged between opposite walls: it is given up early
/// at first, and only where nothing is wedged tried again with more patience.
constexpr int few_sweeps = 12;
const std::string endless = "the resolve does not end although nothing is wedged between walls";

/// The discs of a step before anything is resolved, and which overlap, found by looking at every pair.
struct Moved {
    double side;
    double radius;
    std::vector<Disc> discs;
    std::vector<OverlappingPair> overlaps;

    Moved(const Scene& scene, const std::vector<Disc>& before, double dt)
        : side(scene.side), radius(scene.radius), discs(before) {
        for (Disc& disc : discs) {
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
        }
        for (std::size_t i = 0; i < discs.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (overlap(discs[k], discs[i], 2 * radius * (2 * radius))) {
                    overlaps.push_back({static_cast<int>(k), static_cast<int>(i)});
                }
            }
        }
    }

    /// Does a group of overlapping discs reach from one wall to the one opposite?
    bool wedged() const {
        OverlapGroups groups(discs.size(), overlaps);
        std::vector<unsigned> walls(
            discs.size()); // which ones the group of that lowest disc touches, a bit each
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const Disc& disc = discs[i];
            walls[static_cast<std::size_t>(groups.lowest(static_cast<int>(i)))] |=
                (disc.x - radius <= 0 ? 1U : 0U) | (disc.x + radius >= side ? 2U : 0U) |
                (disc.y - radius <= 0 ? 4U : 0U) | (disc.y + radius >= side ? 8U : 0U);
        }
        return std::ranges::any_of(walls, [](unsigned one) { return (one & 3) == 3 || (one & 12) == 12; });
    }
};

/// The same with a little to spare, for a variant that rounds otherwise than this test.
bool nearly_wedged(Scene scene, const std::vector<Disc>& discs) {
    scene.radius *= 1 + 1e-4;
    return Moved(scene, discs, 0).wedged();
}

/// Runs one variant through one scene; the first thing that is wrong, or nothing. A float variant need not
/// agree with what this test computes in double: it answers to its checker alone.
std::optional<std::string> first_wrong(const Scene& scene, const Variant& variant, const Tuning& tuning) {
    const double dt = 1.0 / tuning.substeps;
    const Rounding rounding = rounding_of(variant.policies);
    const bool at_contact = variant.policies.impact == Impact::at_contact;
    const Checker checker(scene.side, scene.radius, dt, tuning.tolerance, rounding, variant.policies.impact);
    const auto collisions = collision_checker(scene, variant, tuning);
    const auto simulation =
        collisions ? variant.simulate_logged(scene, tuning, *collisions) : variant.simulate(scene, tuning);
    for (int step = 1; step <= scene.steps * tuning.substeps; ++step) {
        const std::vector<Disc> before = simulation->discs();
        const Moved moved(scene, before, dt);
        const Tally tally = simulation->step();
        const std::vector<Disc>& after = simulation->discs();
        const std::string where = "step " + std::to_string(step) + ": ";
        if (rounding.is_double() && tally.overlaps != std::ssize(moved.overlaps)) {
            return where + std::to_string(tally.overlaps) + " overlaps were found of " +
                   std::to_string(moved.overlaps.size());
        }
        if (!tally.settled) {
            const bool wedged =
                rounding.is_double() && !at_contact ? moved.wedged() : nearly_wedged(scene, after);
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
