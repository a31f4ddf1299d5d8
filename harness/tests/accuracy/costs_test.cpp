#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/costs.hpp"
#include "harness/accuracy/trial.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

const Variant& plain = *find_variant("published");

TEST(Costs, OfWorkAreSummedAndLieBetweenTheSizesMeasured) {
    Costs costs;
    costs.costs["published"] = {{.discs = 100, .seconds = {1, 2, 3, 4}},
                                {.discs = 10'000, .seconds = {2, 4, 6, 8}}};
    const Work work{.placed = 1000, .moved = 100, .near = 10, .collisions = 1};
    EXPECT_DOUBLE_EQ(costs.seconds(plain, 100, work), 1234);
    EXPECT_DOUBLE_EQ(costs.seconds(plain, 1, work), 1234) << "smaller than the smallest measured";
    EXPECT_DOUBLE_EQ(costs.seconds(plain, 1e9, work), 2468);
    EXPECT_DOUBLE_EQ(costs.seconds(plain, 1000, work), 1.5 * 1234) << "half way, on a logarithmic axis";
    EXPECT_DOUBLE_EQ(costs.seconds(event_driven(), 100, work), 1234) << "not measured: as the dearest";
}

TEST(Costs, CountTheWorkOfAScene) {
    const Scene scene{
        .side = 100, .radius = 1, .steps = 1, .discs = {{10, 10, 1, -2}, {11, 10, 3, 0}, {90, 90, 0, 0}}};
    EXPECT_EQ(work_of_step(plain, scene).moved, 3);
    EXPECT_EQ(work_of_step(plain, scene).near, 4.5 * (2 * 2 + 1));
    EXPECT_DOUBLE_EQ(work_of_events(scene).moved, 6 / 50.0) << "cells of half the side";
    EXPECT_EQ(work_of_events(scene).near, 3);
}

/// A cache of its own, and the usual one again at the end.
class KeptCosts : public testing::Test {
  protected:
    KeptCosts()
        : folder_(std::filesystem::temp_directory_path() / ("carom_costs_test_" + std::to_string(getpid()))) {
        const char* usual = std::getenv("XDG_CACHE_HOME");
        usual_ = usual != nullptr ? usual : "";
        std::filesystem::remove_all(folder_);
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    ~KeptCosts() override {
        std::filesystem::remove_all(folder_);
        usual_.empty() ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", usual_.c_str(), 1);
    }

    std::filesystem::path folder_;
    std::string usual_;
};

TEST_F(KeptCosts, AreMeasuredOnceAndStayTheSame) {
    EXPECT_FALSE(kept_costs());
    const Costs first = costs_of_machine();
    ASSERT_TRUE(kept_costs());
    EXPECT_EQ(costs_json(*kept_costs()), costs_json(first));
    EXPECT_EQ(costs_json(costs_of_machine()), costs_json(first));
    EXPECT_TRUE(first.costs.contains(std::string(event_driven().name)));
    for (const auto& [name, sizes] : first.costs) {
        for (const UnitCosts& one : sizes) {
            EXPECT_GT(one.seconds.collisions + one.seconds.near + one.seconds.moved, 0) << name;
        }
    }
}

TEST_F(KeptCosts, OfAnotherMachineOrDamagedAreNone) {
    std::filesystem::create_directories(costs_file().parent_path());
    for (const std::string text :
         {R"({"format": 1, "machine": "another", "seconds": {"published": []}})", "{", "[]"}) {
        std::ofstream(costs_file()) << text;
        EXPECT_FALSE(kept_costs()) << text;
    }
}

TEST_F(KeptCosts, AreTypicalOnesWhereTheyCannotBeKept) {
    std::ofstream(folder_) << "a file where a folder should be";
    testing::internal::CaptureStderr();
    EXPECT_EQ(costs_json(costs_of_machine()), costs_json(typical_costs()));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "cannot be kept", testing::internal::GetCapturedStderr());
}

/// Twelve times, on different numbers of threads: a choice by the clock came out differently.
TEST(TryMethods, ChoosesTheSameEveryTimeOnAnyNumberOfThreads) {
    const Scene scene = generate({.count = 3000,
                                  .side = std::sqrt(3000 * std::numbers::pi / 0.3),
                                  .radius = 1,
                                  .steps = 8,
                                  .least_velocity = 0.1,
                                  .largest_velocity = 0.6,
                                  .seed = 5,
                                  .placement = Placement::random,
                                  .isotropic = true});
    const Costs costs = typical_costs();
    for (const Measure measure : {Measure::path, Measure::collision_rate, Measure::pressure}) {
        const Trial first = try_methods(scene, {}, measure, 0.1, costs);
        for (int turn = 0; turn < 12; ++turn) {
            const Trial again = try_methods(scene, {.threads = 1 + turn % 4}, measure, 0.1, costs);
            ASSERT_EQ(again.tried.size(), first.tried.size());
            for (std::size_t k = 0; k < first.tried.size(); ++k) {
                EXPECT_EQ(again.tried[k].method, first.tried[k].method);
                EXPECT_EQ(again.tried[k].error, first.tried[k].error);
                EXPECT_EQ(again.tried[k].unit_seconds, first.tried[k].unit_seconds);
            }
        }
    }
}

} // namespace
} // namespace carom
