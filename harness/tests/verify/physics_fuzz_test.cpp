#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/collisions/collision_checker.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/text.hpp"
#include "harness/tests/scenes/random_scenes.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/tests/all_pairs.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/registry.hpp"

// Every variant on random scenes of every kind, step by step, against the checker and, in double, against
// what any order must come to: the reference of all pairs is run on the discs whose collisions leave no
// choice of order.

namespace carom {
namespace {

using tests::same_bits;

constexpr int shards = 8;

/// A resolve may go on without end only where discs are wedged between opposite walls: it is given up early
/// at first, and only where nothing is wedged tried again with more patience.
constexpr int few_sweeps = 12;
const std::string endless = "the resolve does not end although nothing is wedged between walls";

Scene with_discs(const Scene& scene, std::vector<Disc> discs) {
    return {.side = scene.side, .radius = scene.radius, .steps = 1, .discs = std::move(discs)};
}

/// What holds of a step before anything is resolved, found by looking at every pair.
class Moved {
  public:
    Moved(const Scene& scene, const std::vector<Disc>& before, double dt)
        : radius_(scene.radius), discs(before) {
        for (Disc& disc : discs) {
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
        }
        group_.resize(discs.size());
        std::iota(group_.begin(), group_.end(), std::size_t{0});
        const double reach = 2 * radius_;
        for (std::size_t i = 0; i < discs.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (overlap(discs[k], discs[i], reach * reach)) {
                    ++overlaps;
                    group_[group_of(i)] = group_of(k);
                }
            }
        }
        look_at_walls(scene.side);
    }

    /// Groups whose collisions leave no choice of order: a disc that overlaps nothing but walls, a pair that
    /// overlaps nothing but each other.
    std::vector<std::vector<std::size_t>> without_choice() {
        std::vector<std::vector<std::size_t>> members(discs.size());
        for (std::size_t i = 0; i < discs.size(); ++i) {
            members[group_of(i)].push_back(i);
        }
        std::erase_if(members, [this](const auto& group) {
            return group.empty() || group.size() > 2 ||
                   (group.size() == 2 && walls_[group_of(group[0])] != 0);
        });
        return members;
    }

    /// Does a group of overlapping discs reach from one wall to the one opposite?
    bool wedged() const {
        return std::ranges::any_of(walls_,
                                   [](unsigned walls) { return (walls & 3) == 3 || (walls & 12) == 12; });
    }

  private:
    std::size_t group_of(std::size_t i) {
        while (group_[i] != i) {
            i = group_[i] = group_[group_[i]];
        }
        return i;
    }

    void look_at_walls(double side) {
        walls_.resize(discs.size());
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const Disc& disc = discs[i];
            walls_[group_of(i)] |= (disc.x - radius_ <= 0 ? 1u : 0u) | (disc.x + radius_ >= side ? 2u : 0u) |
                                   (disc.y - radius_ <= 0 ? 4u : 0u) | (disc.y + radius_ >= side ? 8u : 0u);
        }
    }

    double radius_;
    std::vector<std::size_t> group_;
    std::vector<unsigned> walls_; ///< which walls a group touches, a bit each

  public:
    std::vector<Disc> discs;
    std::int64_t overlaps = 0;
};

/// The same with a little to spare, for a variant that rounds otherwise than this test.
bool nearly_wedged(Scene scene, const std::vector<Disc>& discs) {
    scene.radius *= 1 + 1e-4;
    return Moved(scene, discs, 0).wedged();
}

/// What is wrong with a group whose collisions leave no choice, or nothing.
std::optional<std::string> against_reference(const Scene& scene, const std::vector<Disc>& before,
                                             const std::vector<Disc>& after,
                                             const std::vector<std::size_t>& group, const Variant& variant,
                                             const Tuning& tuning) {
    std::vector<Disc> alone;
    double speed = 0;
    for (const std::size_t i : group) {
        alone.push_back(before[i]);
        speed = std::max({speed, std::abs(before[i].vx), std::abs(before[i].vy)});
    }
    AllPairs reference(with_discs(scene, alone), variant.policies, tuning);
    reference.step();
    for (std::size_t k = 0; k < group.size(); ++k) {
        const Disc& expected = reference.discs()[k];
        const Disc& found = after[group[k]];
        const double difference =
            std::max(std::abs(found.vx - expected.vx), std::abs(found.vy - expected.vy));
        if (!(difference <= (group.size() == 1 ? 0 : 1e-12 * speed))) {
            return "disc " + std::to_string(group[k]) + " has velocity (" + number_text(found.vx) + ", " +
                   number_text(found.vy) + "), and by all pairs (" + number_text(expected.vx) + ", " +
                   number_text(expected.vy) + ")";
        }
    }
    return std::nullopt;
}

/// Runs one variant through one scene; the first thing that is wrong, or nothing. A float variant need not
/// agree with what all pairs and this test compute in double, nor one that collides at contact with what all
/// pairs do at the end of a step: they answer to their checker alone.
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
        Moved moved(scene, before, dt);
        const Tally tally = simulation->step();
        const std::vector<Disc>& after = simulation->discs();
        const std::string where = "step " + std::to_string(step) + ": ";
        if (rounding.is_double() && tally.overlaps != moved.overlaps) {
            return where + std::to_string(tally.overlaps) + " overlaps were found of " +
                   std::to_string(moved.overlaps);
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
        if (!rounding.is_double()) {
            continue;
        }
        if (!tally.changed() && !same_bits(after, moved.discs)) {
            return where + "nothing was resolved, and yet velocities changed";
        }
        if (at_contact) {
            continue;
        }
        for (const auto& group : moved.without_choice()) {
            if (const auto wrong = against_reference(scene, before, after, group, variant, tuning)) {
                return where + *wrong;
            }
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
