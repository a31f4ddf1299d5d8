#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/energy_drift.hpp"
#include "harness/tests/verify/hard_cases.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::checked_run;
using tests::same_bits;
using tests::scene_of;

class HardCases : public testing::TestWithParam<Variant> {
  protected:
    static double epsilon() { return rounding_of(GetParam().policies).epsilon(); }
    static bool in_double() { return rounding_of(GetParam().policies).is_double(); }
    static bool at_contact() { return GetParam().policies.impact == Impact::at_contact; }

    static carom::Run run(const Scene& scene, const Tuning& tuning = {}, const OnStep& on_step = nullptr) {
        return checked_run(GetParam(), scene, tuning, on_step);
    }
    static std::vector<Disc> after(int steps, Scene scene, const Tuning& tuning = {}) {
        scene.steps = steps;
        return run(scene, tuning).discs;
    }
};

/// The checker looks at every step: each ends, moves every disc by v dt, leaves nothing colliding, keeps what
/// is to be kept, and yields finite numbers.
TEST_P(HardCases, PassesTheCheckerAtEveryStep) {
    for (const auto& [name, description, make] : hard_cases()) {
        if (name == "drift" || name == "far_coordinates") {
            continue; // in hard_cases_slow_test.cpp
        }
        SCOPED_TRACE(name);
        const Scene scene = make();
        const carom::Run done = run(scene);
        run(scene, {.threads = 2, .substeps = 4});
        EXPECT_NEAR(energy_drift(scene, done.discs).value_or(0), 0, 1e3 * epsilon());
    }
}

/// Head-on, equal discs exchange their velocities: of five, one moves at a time.
TEST_P(HardCases, CradleHasOneDiscMovingAtATime) {
    const Scene scene = scene_of("cradle");
    run(scene, {}, [](int, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        int moving = 0;
        for (const Disc& disc : discs) {
            const double speed = std::hypot(disc.vx, disc.vy);
            moving += speed > 0.125;
            EXPECT_NEAR(speed, speed > 0.125 ? 0.25 : 0, 16 * epsilon());
        }
        EXPECT_EQ(moving, 1);
    });
}

/// The gaps are 1/8 and 1/16 three times, the way to the far wall 59/16, the speed 1/4: every collision falls
/// on a multiple of 1/4, where a step of 1/4 ends, with the discs touching. There stepping is exact.
TEST_P(HardCases, CradleIsExactWhereStepsEndAtItsCollisions) {
    const Scene scene = scene_of("cradle");
    EventDriven<double> reference(scene);
    run(scene, {.substeps = 4}, [&](int time, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        ASSERT_TRUE(reference.advance(time));
        EXPECT_LE(tests::largest_distance(discs, reference.discs()), 64 * epsilon()) << time;
    });
    EXPECT_GT(reference.pair_collisions(), 8);
}

/// In steps of 1 a blow is seen, and passed on, once a step: after 1, 2, 3 and 4 instead of 1/2, 3/4, 1 and
/// 5/4. At contact all of them are made, in the step in which they happen.
TEST_P(HardCases, CradlePassesTheBlowOnOnceAStep) {
    const Scene scene = scene_of("cradle");
    if (at_contact()) {
        EventDriven<double> reference(scene);
        run(scene, {}, [&](int time, const Simulation& simulation) {
            ASSERT_TRUE(reference.advance(time));
            EXPECT_LE(tests::largest_distance(simulation.discs(), reference.discs()), 64 * epsilon()) << time;
        });
        return;
    }
    run(scene, {}, [](int time, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        if (time <= 4) {
            EXPECT_NEAR(discs[static_cast<std::size_t>(time)].vx, 0.25, 16 * epsilon()) << time;
        }
    });
}

/// All numbers are small integers and every touch falls on the end of a step.
TEST_P(HardCases, CornerIsExact) {
    const Scene scene = scene_of("corner");
    EventDriven<double> reference(scene);
    const carom::Run done = run(scene, {}, [&](int time, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        ASSERT_TRUE(reference.advance(time));
        EXPECT_TRUE(same_bits(discs, reference.discs())) << time;
    });
    EXPECT_EQ(done.work.wall_resolves, 6) << "at the times 3, 11 and 19";
}

/// The blow goes through the resting disc to the wall and back: the striker returns with its speed, the
/// pinned disc stays.
TEST_P(HardCases, PinnedDiscStaysAndTheStrikerReturns) {
    const std::vector<Disc> discs = after(1, scene_of("pinned"));
    const double tolerance = 16 * epsilon();
    EXPECT_NEAR(std::hypot(discs[0].vx, discs[0].vy), 0, tolerance);
    EXPECT_NEAR(discs[1].vx, 1, tolerance);
    EXPECT_NEAR(discs[1].vy, 0, tolerance);
    EXPECT_NEAR(std::hypot(discs[2].vx, discs[2].vy), 0, tolerance);
    EXPECT_NEAR(discs[3].vx, 0.75, tolerance);
    EXPECT_NEAR(discs[3].vy, 0.75, tolerance);
}

/// How far the rack is from its mirror image at the axis y = 32.
double asymmetry(const std::vector<Disc>& discs) {
    double largest = 0;
    std::size_t i = 1;
    for (std::size_t row = 0; row < 5; i += ++row) {
        for (std::size_t k = 0; k <= row; ++k) {
            const Disc& one = discs[i + k];
            const Disc& image = discs[i + row - k];
            largest = std::max(largest, std::hypot(one.x - image.x, one.y + image.y - 64));
        }
    }
    return largest;
}

/// Symmetric to the last bit up to the blow, which a step notices at time 11 and which comes before; from
/// then on no order keeps the symmetry, since it resolves one of the two discs behind the apex first.
TEST_P(HardCases, RackBreakLosesItsSymmetry) {
    const Scene scene = scene_of("rack_break");
    const carom::Run done = run(scene, {}, [](int time, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        if (time <= (at_contact() ? 10 : 11)) {
            EXPECT_EQ(asymmetry(discs), 0) << time;
        }
    });
    EXPECT_GT(asymmetry(done.discs), 0.1);
    RecordProperty("asymmetry", std::to_string(asymmetry(done.discs)));
}

/// At distances (4, +-3) the normals are (4/5, +-3/5); at contact, 6 apart, (sqrt(3)/2, +-1/2). Of the
/// striker's speed v the disc resolved first gets nx along its normal, which leaves the striker ny^2 and -+nx
/// ny; the other one gets 2 nx ny^2 of v along its own. The equal shares that symmetry asks for never come
/// about: both contacts are of the same moment, and one is made first.
TEST_P(HardCases, ThreeBodyContactIsResolvedOneAfterTheOther) {
    const std::vector<Disc> discs = after(1, scene_of("three_body"));
    const double speed = 4;
    const double tolerance = 16 * epsilon();
    const bool upper_first = discs[2].vy > std::abs(discs[1].vy);
    const Disc& first = discs[upper_first ? 2 : 1];
    const Disc& second = discs[upper_first ? 1 : 2];
    const double up = upper_first ? 1 : -1;
    const double nx = at_contact() ? std::sqrt(3) / 2 : 0.8;
    const double ny = at_contact() ? 0.5 : 0.6;
    const double second_share = 2 * nx * ny * ny;
    EXPECT_NEAR(first.vx, nx * nx * speed, tolerance);
    EXPECT_NEAR(first.vy, nx * ny * speed * up, tolerance);
    EXPECT_NEAR(second.vx, second_share * nx * speed, tolerance);
    EXPECT_NEAR(second.vy, -second_share * ny * speed * up, tolerance);
    EXPECT_NEAR(discs[0].vx, (ny * ny - second_share * nx) * speed, tolerance);
    EXPECT_NEAR(discs[0].vy, (second_share * ny - nx * ny) * speed * up, tolerance);
    RecordProperty("first", upper_first ? "upper" : "lower");
}

/// Without a normal there is no collision: all fly straight on, also the pair that the reference, which sees
/// it approach, turns back.
TEST_P(HardCases, CoincidentDiscsFlyThroughEachOther) {
    const Scene scene = scene_of("coincident");
    const carom::Run done = run(scene);
    EXPECT_EQ(done.work.pair_resolves, 0);
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        const Disc& start = scene.discs[i];
        EXPECT_TRUE(same_bits(done.discs[i], {start.x + start.vx * scene.steps,
                                              start.y + start.vy * scene.steps, start.vx, start.vy}))
            << i;
    }
}

/// The normals of the first two pairs are exact: (1, 0) and (1, -1) / sqrt(2); so is the third. The square of
/// the fourth distance is 0. A float holds neither 5 + 2^-40 nor 2^-480: all are coincident in float.
TEST_P(HardCases, NearlyCoincidentDiscsExchangeTheirNormalComponents) {
    const Scene scene = scene_of("nearly_coincident");
    const std::vector<Disc> discs = after(1, scene);
    const auto velocity = [&discs](std::size_t i) { return Disc{0, 0, discs[i].vx, discs[i].vy}; };
    if (!in_double()) {
        EXPECT_EQ(velocity(0), (Disc{0, 0, 0, 0}));
        EXPECT_EQ(velocity(1), (Disc{0, 0, -1, 0}));
        EXPECT_EQ(velocity(3), (Disc{0, 0, -1, 0}));
        return;
    }
    EXPECT_EQ(velocity(0), (Disc{0, 0, -1, 0}));
    EXPECT_EQ(velocity(1), (Disc{0, 0, 0, 0}));
    for (const std::size_t i :
         {std::size_t{2}, std::size_t{3}}) { // a unit normal rounds once more than d / |d|^2 does
        EXPECT_NEAR(discs[i].vx, -0.5, 0x1p-51);
        EXPECT_NEAR(discs[i].vy, i == 2 ? 0.5 : -0.5, 0x1p-51);
    }
    EXPECT_EQ(velocity(4), (Disc{0, 0, 0, 0}));
    EXPECT_EQ(velocity(5), (Disc{0, 0, 0x1p-480, 0}));
    EXPECT_EQ(velocity(6), (Disc{0, 0, 0x1p-1071, 0}));
    EXPECT_EQ(velocity(7), (Disc{0, 0, 0, 0}));
}

/// At a distance d along x before the closest approach the speed of approach is v d / 2r, and v d / 2r along
/// y is what both get: 2^-27 for d = 2^-27, v = 1/2, 2r = 1/2. At contact, the root of 2^-53 before it, they
/// get the root of 2^-53.
TEST_P(HardCases, GrazingDiscsAreTurnedByARootOfARounding) {
    const Scene scene = scene_of("grazing");
    const std::vector<Disc> discs = after(1, scene);
    for (std::size_t i = 0; i < discs.size(); i += 2) {
        EXPECT_LE(std::abs(discs[i].vy), 0.5 * std::sqrt(8 * epsilon())) << i;
        EXPECT_NEAR(discs[i].vy + discs[i + 1].vy, 0, epsilon());
    }
    if (in_double()) {
        const double expected = at_contact() ? std::sqrt(0x1p-53) : 0x1p-27;
        EXPECT_NEAR(discs[0].vy, -expected, at_contact() ? 0x1p-45 : 0x1p-50);
        EXPECT_NEAR(discs[1].vy, expected, at_contact() ? 0x1p-45 : 0x1p-50);
        for (std::size_t i = 2; i < 8; ++i) {
            EXPECT_TRUE(same_bits(discs[i].vx, scene.discs[i].vx)) << i;
            EXPECT_TRUE(same_bits(discs[i].vy, 0)) << i;
        }
    }
}

/// A disc's way out is narrower than itself: after 50 steps, in which it would fly up to 3.5 r alone, it is
/// still in its cage.
TEST_P(HardCases, JammedDiscsStayInTheirCages) {
    const Scene scene = scene_of("jammed");
    EXPECT_LT(tests::largest_distance(run(scene).discs, scene.discs), 1);
}

/// Sum of |x - centre|^2 and of 2 (x - centre) v about the centre of mass, and twice the energy about it.
struct Expansion {
    double inertia = 0;
    double rate = 0;
    double twice_energy = 0;

    explicit Expansion(const std::vector<Disc>& discs) {
        Disc mean;
        const auto count = static_cast<double>(discs.size());
        for (const Disc& disc : discs) {
            mean = {mean.x + disc.x / count, mean.y + disc.y / count, mean.vx + disc.vx / count,
                    mean.vy + disc.vy / count};
        }
        for (const Disc& disc : discs) {
            const double x = disc.x - mean.x;
            const double y = disc.y - mean.y;
            const double vx = disc.vx - mean.vx;
            const double vy = disc.vy - mean.vy;
            inertia += x * x + y * y;
            rate += 2 * (x * vx + y * vy);
            twice_energy += vx * vx + vy * vy;
        }
    }
};

/// Lagrange's identity: free flight makes the moment of inertia I0 + I0' t + 2E t^2, and a collision adds
/// -2 (v2 - v1).d > 0 to its rate I'. So discs that collide spread at least as fast as discs that do not.
TEST_P(HardCases, HexagonalPackingSpreadsAtLeastAsFastAsFreeDiscs) {
    const Scene scene = scene_of("hexagonal");
    const Expansion start(tests::start_of(GetParam(), scene));
    const carom::Run done = run(scene);
    ASSERT_EQ(done.work.wall_resolves, 0);
    EXPECT_GT(done.work.pair_resolves, 50);
    const double time = scene.steps;
    const double free = start.inertia + start.rate * time + start.twice_energy * time * time;
    EXPECT_GT(Expansion(done.discs).inertia, free * (1 - 100 * epsilon()));
}

TEST_P(HardCases, AtRestNothingChanges) {
    const Scene scene = scene_of("at_rest");
    const carom::Run done = run(scene);
    EXPECT_TRUE(same_bits(done.discs, tests::start_of(GetParam(), scene)));
    EXPECT_GT(done.work.overlaps, 0);
    EXPECT_EQ(done.work.pair_resolves + done.work.wall_resolves, 0);
}

/// Speeds and positions are multiples of 1/16, so that a sum of them is exact.
TEST_P(HardCases, OneDiscGoesToAndFro) {
    const Scene scene = scene_of("one_disc");
    Disc expected = scene.discs[0];
    const auto follow = [&scene](double& position, double& velocity) {
        position += velocity;
        const double wall = velocity < 0 ? scene.radius : scene.side - scene.radius;
        if ((velocity < 0 && position <= wall) || (velocity > 0 && position >= wall)) {
            velocity = -velocity;
            position = at_contact() ? 2 * wall - position : position;
        }
    };
    const carom::Run done = run(scene, {}, [&](int time, const Simulation& simulation) {
        const std::vector<Disc> discs = simulation.discs();
        follow(expected.x, expected.vx);
        follow(expected.y, expected.vy);
        EXPECT_TRUE(same_bits(discs[0], expected)) << time;
    });
    EXPECT_EQ(done.work.pair_resolves, 0);
    EXPECT_GT(done.work.wall_resolves, 8);
}

TEST_P(HardCases, NoDiscsDoNothing) {
    const carom::Run done = run(scene_of("no_discs"));
    EXPECT_TRUE(done.discs.empty());
    EXPECT_EQ(done.work.overlaps + done.work.pair_resolves + done.work.wall_resolves, 0);
}

INSTANTIATE_TEST_SUITE_P(Registry, HardCases, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

} // namespace
} // namespace carom
