#include <vector>

#include <gtest/gtest.h>

#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::Outcome;
using tests::same_bits;
using tests::simulate;

constexpr Policies with(Order order, Schedule schedule) {
    return {.order = order, .find_schedule = schedule, .resolve_schedule = schedule};
}

void expect_same(const Outcome& expected, const Outcome& found, int threads, int chunk) {
    EXPECT_TRUE(same_bits(found.discs, expected.discs)) << threads << " threads, chunk " << chunk;
    EXPECT_EQ(found.work, expected.work) << threads << " threads, chunk " << chunk;
}

/// Dense, so that a disc is shared by many boxes, and with many more boxes than threads.
Scene busy_scene() { return tests::random_scene_of_density(700, 0.9, 4, 81); }

/// One schedule against the sequential run of another.
template <Order order, Schedule schedule> void depends_on_no_thread(const Scene& scene) {
    SCOPED_TRACE(static_cast<int>(schedule));
    const Outcome expected = simulate<with(order, Schedule::static_)>(scene, {.threads = 1});
    ASSERT_GT(expected.work.pair_resolves, 1000);
    for (const int threads : {1, 2, 3, 8}) {
        const std::vector<int> chunks = has_chunk(schedule) ? std::vector{1, 5, 1000} : std::vector{1};
        for (const int chunk : chunks) {
            const Tuning tuning{.threads = threads, .find_chunk = chunk, .resolve_chunk = chunk};
            expect_same(expected, simulate<with(order, schedule)>(scene, tuning), threads, chunk);
        }
    }
}

template <Order order> void depends_on_no_thread_and_no_schedule() {
    const Scene scene = busy_scene();
    depends_on_no_thread<order, Schedule::static_>(scene);
    depends_on_no_thread<order, Schedule::static_chunk>(scene);
    depends_on_no_thread<order, Schedule::dynamic>(scene);
    depends_on_no_thread<order, Schedule::dynamic_chunk>(scene);
    depends_on_no_thread<order, Schedule::guided>(scene);
    depends_on_no_thread<order, Schedule::guided_chunk>(scene);
}

TEST(ThreadIndependence, OfTheCheckeredOrder) { depends_on_no_thread_and_no_schedule<Order::checkered>(); }

TEST(ThreadIndependence, OfTheRowOrder) { depends_on_no_thread_and_no_schedule<Order::row>(); }

TEST(ThreadIndependence, OfTheWavefrontOrder) { depends_on_no_thread_and_no_schedule<Order::wavefront>(); }

/// The other policies, under the schedule that mixes iterations most.
template <Policies policies> void depends_on_no_thread_in_any_scene() {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        const Outcome expected = simulate<policies>(scene, {.threads = 1});
        for (const int threads : {2, 3, 8}) {
            expect_same(expected, simulate<policies>(scene, {.threads = threads, .resolve_chunk = 1}),
                        threads, 1);
        }
    }
}

TEST(ThreadIndependence, OfEveryPolicyInEveryScene) {
    constexpr auto dynamic = Schedule::dynamic;
    depends_on_no_thread_in_any_scene<with(Order::checkered, dynamic)>();
    depends_on_no_thread_in_any_scene<with(Order::row, dynamic)>();
    depends_on_no_thread_in_any_scene<Policies{.neighbourhood = Neighbourhood::nine,
                                               .self_contained = SelfContained::off,
                                               .direction = Direction::forward,
                                               .find_schedule = dynamic,
                                               .resolve_schedule = dynamic}>();
}

constexpr Policies at_contact(Policies policies) {
    policies.impact = Impact::at_contact;
    return policies;
}

TEST(ThreadIndependence, OfCollisionsAtContactInEveryScene) {
    depends_on_no_thread_in_any_scene<at_contact(with(Order::checkered, Schedule::dynamic))>();
    depends_on_no_thread_in_any_scene<at_contact(with(Order::row, Schedule::guided))>();
    depends_on_no_thread_in_any_scene<at_contact({.order = Order::strips, .storage = Storage::sorted})>();
}

/// So many discs that later sweeps, too, change enough to run on all threads.
TEST(ThreadIndependence, OfCollisionsAtContactInManySweeps) {
    constexpr Policies policies = at_contact(with(Order::checkered, Schedule::dynamic_chunk));
    const Scene scene = tests::random_scene_of_density(8000, 0.8, 2, 83);
    const Outcome expected = simulate<policies>(scene, {.threads = 1});
    ASSERT_GT(expected.work.pair_resolves, 16 * few_changes);
    for (const int threads : {2, 3, 8}) {
        for (const int chunk : {1, 5}) {
            const Tuning tuning{.threads = threads, .find_chunk = chunk, .resolve_chunk = chunk};
            expect_same(expected, simulate<policies>(scene, tuning), threads, chunk);
        }
    }
}

TEST(ThreadIndependence, OfTheSequentialOrders) {
    const Scene scene = busy_scene();
    const auto depends_on_no_thread = [&scene]<Order order>() {
        constexpr Policies policies{.order = order, .find_schedule = Schedule::dynamic};
        const Outcome expected = simulate<policies>(scene, {.threads = 1});
        for (const int threads : {2, 8}) {
            expect_same(expected, simulate<policies>(scene, {.threads = threads}), threads, 1);
        }
    };
    depends_on_no_thread.template operator()<Order::track>();
    depends_on_no_thread.template operator()<Order::repeat>();
    depends_on_no_thread.template operator()<Order::once>();
}

TEST(ThreadIndependence, OfAGridWithFewerBoxesThanThreads) {
    const Scene scene = tests::random_scene(60, 15, 0.9, 5, 1, 82);
    const Outcome expected = simulate<Policies{}>(scene, {.threads = 1});
    for (const int threads : {2, 8, 32}) {
        expect_same(expected, simulate<Policies{}>(scene, {.threads = threads}), threads, 5);
    }
}

} // namespace
} // namespace carom
