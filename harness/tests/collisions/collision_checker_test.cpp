#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/collisions/collision_checker.hpp"
#include "harness/collisions/path_checker.hpp"
#include "harness/tests/scenes/gas.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/registry.hpp"

// What goes through the collisions that a run tells. Bugs planted into the kernel itself: mutants/.

namespace carom::told_collisions {
namespace {

/// Keeps what it is told.
class Kept final : public CollisionLog<double> {
  public:
    void collided(const Collision<double>& collision) override { all.push_back(collision); }

    std::vector<Collision<double>> all;
};

/// The second is hit by the first at time 1 and leaves for the wall, which it meets at time 8.
const Scene pair{.side = 20, .radius = 1, .steps = 9, .discs = {{9, 10, 1, 0}, {12, 10, 0, 0}}};

std::vector<Collision<double>> told_of_pair() {
    Kept kept;
    EventDriven<double, CollisionLog<double>&> simulation(pair, kept);
    EXPECT_TRUE(simulation.advance(9));
    EXPECT_EQ(kept.all.size(), 2u);
    return kept.all;
}

/// What the checker says of a list, and of a state at the end that follows from it.
std::string said_of(const std::vector<Collision<double>>& told, double time = 9) {
    PathChecker checker(pair);
    // One more: a collision with a disc that is not there may be told.
    std::vector<Path> paths{{pair.discs[0], 0}, {pair.discs[1], 0}, {}};
    for (const Collision<double>& one : told) {
        checker.collided(one);
        paths[static_cast<std::size_t>(one.first)] = {one.first_after, one.time};
        paths[static_cast<std::size_t>(one.second)] = {one.second_after, one.time};
    }
    return checker.violation_at(time, {paths[0].at(time), paths[1].at(time)}).value_or("nothing");
}

void says(const char* part, const std::vector<Collision<double>>& told) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, part, said_of(told));
}

TEST(PathChecker, PassesWhatIsRight) { EXPECT_EQ(said_of(told_of_pair()), "nothing"); }

TEST(PathChecker, CatchesWhatIsPlanted) {
    const auto right = told_of_pair();
    const auto changed = [&](std::size_t which, auto change) {
        auto told = right;
        change(told[which]);
        return told;
    };
    says("is told after one of time", {right[0], changed(1, [](auto& one) { one.time = 0.5; })[1]});
    says("its path leads to", changed(0, [](auto& one) { one.first_after.y += 1e-9; }));
    says("do not keep their momentum", changed(0, [](auto& one) { one.first_after.vx = 1e-9; }));
    says("do not keep their energy", changed(0, [](auto& one) {
             one.first_after.vx = -1e-9;
             one.second_after.vx = 1 + 1e-9;
         }));
    says("do not exchange what they have along the line of centres", changed(0, [](auto& one) {
             one.first_after = {one.first_after.x, one.first_after.y, 0.5, 0.5};
             one.second_after = {one.second_after.x, one.second_after.y, 0.5, -0.5};
         }));
    says("by a wall", changed(1, [](auto& one) { one.first_after.vy = 0.1; }));
    says("come 2 too near each other, without a collision", {});
    says("beyond a wall, which did not turn it", {right[0]});
}

TEST(PathChecker, CatchesACollisionOfADiscThatIsNotThere) {
    PathChecker checker(pair);
    auto told = told_of_pair()[0];
    told.second = 2;
    checker.collided(told);
    EXPECT_EQ(checker.violation_so_far(), "a collision of discs 0 and 2 is told, of 2");
}

TEST(PathChecker, CatchesACollisionBeforeTheDiscsMeetOrAfter) {
    for (const double late : {-1e-9, 1e-9}) {
        auto told = told_of_pair();
        told.resize(1);
        told[0].time += late;
        told[0].first_after.x += late;
        says(late < 0 ? "collide while they are 1e-09 apart" : "collide when they are 1e-09 too near", told);
    }
}

TEST(PathChecker, CatchesAStateThatIsNotWhereThePathsLead) {
    PathChecker checker(pair);
    EXPECT_EQ(checker.violation_at(0.5, {{9.5, 10, 1, 0}, {12, 10, 0, 0}}), std::nullopt);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "its path leads to",
                        checker.violation_at(0.75, {{9.75, 10.001, 1, 0}, {12, 10, 0, 0}}).value_or(""));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "its last collision left it",
                        checker.violation_at(0.75, {{9.75, 10, 1.001, 0}, {12, 10, 0, 0}}).value_or(""));
}

TEST(ToldCollisions, ChangeNoBitOfWhatIsSimulated) {
    const Scene scene = tests::gas(400, 46, 8, 0.1, 1, 51);
    int variants_that_tell = 0;
    std::vector<Variant> all(variants().begin(), variants().end());
    all.push_back(event_driven());
    for (const Variant& variant : all) {
        EXPECT_EQ(variant.simulate_logged != nullptr,
                  variant.engine == Engine::event_driven || variant.policies.impact == Impact::at_contact);
        if (variant.simulate_logged == nullptr) {
            continue;
        }
        ++variants_that_tell;
        const Tuning tuning{.threads = 3};
        Kept kept;
        // A mutex of its own is the checker's: on one thread none is needed here.
        const auto told = variant.simulate_logged(scene, {}, kept);
        const auto checker = collision_checker(scene, variant, tuning);
        const auto checked = variant.simulate_logged(scene, tuning, *checker);
        const auto untold = variant.simulate(scene, tuning);
        std::int64_t collisions = 0;
        for (int step = 0; step < scene.steps; ++step) {
            collisions += untold->step().pair_resolves;
            told->step();
            checked->step();
            EXPECT_TRUE(tests::same_bits(told->discs(), untold->discs())) << variant.name;
            EXPECT_TRUE(tests::same_bits(checked->discs(), untold->discs())) << variant.name;
        }
        EXPECT_GT(kept.all.size(), 100u) << variant.name;
        EXPECT_GT(collisions, 100) << variant.name;
    }
    EXPECT_EQ(variants_that_tell, 3);
}

} // namespace
} // namespace carom::told_collisions
