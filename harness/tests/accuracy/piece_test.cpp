#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/error_measures.hpp"
#include "harness/scenes/piece.hpp"
#include "harness/tests/scenes/gas.hpp"
#include "harness/verify/event_driven_violation.hpp"

namespace carom {
namespace {

/// Of a dilute scene of more discs than a trial has, in which a step at contact is exact for all but a few.
TEST(TryMethods, PromisesNoErrorThatAPieceCannotTell) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const Scene scene = tests::gas(40'000, 1121, 1, 0.125, 0.3125, seed);
        const Trial trial = try_methods(scene, {}, Measure::path, 1e-9);
        ASSERT_FALSE(trial.whole_scene);
        const TrialResult& at_contact = trial.results.at(1);
        ASSERT_EQ(at_contact.method.variant->policies.impact, Impact::at_contact);
        const double error =
            error_by(measure_errors(scene, *at_contact.method.variant, {.substeps = 1}), Measure::path);
        EXPECT_LE(error, at_contact.largest_error()) << "seed " << seed << ", expected " << at_contact.error;
    }
}

TEST(BusiestPiece, IsTheSceneItselfIfThatIsSmallEnough) {
    const Scene scene = tests::gas(200, 60, 1, 0.1, 1, 1);
    EXPECT_EQ(busiest_piece(scene, scene.discs.size()).scene.discs, scene.discs);
}

TEST(BusiestPiece, HasWallsDiscsApartAndNearlyTheDensityOfTheWhole) {
    const Scene scene = tests::gas(30'000, 434, 3, 0.1, 1, 77);
    const Scene piece = busiest_piece(scene, 4000).scene;
    EXPECT_LE(piece.discs.size(), 4000);
    EXPECT_GE(piece.discs.size(), 3000);
    EXPECT_EQ(overlap_at_start(piece), std::nullopt);
    EXPECT_NEAR(area_fraction(piece), area_fraction(scene), 0.05 * area_fraction(scene));
}

TEST(BusiestPiece, IsWhereTheDiscsAre) {
    Scene scene{.side = 4000, .radius = 1, .steps = 1, .discs = {{10, 10, 0, 0}}};
    for (int i = 0; i < 900; ++i) {
        scene.discs.push_back({3000.0 + 4 * (i % 30), 3000.0 + 4 * (i / 30), 1, 0});
    }
    const Scene piece = busiest_piece(scene, 400).scene;
    EXPECT_LE(piece.discs.size(), 400);
    EXPECT_GE(piece.discs.size(), 50);
    EXPECT_TRUE(std::ranges::all_of(piece.discs, [](const Disc& disc) { return disc.vx == 1; }));
}

/// Discs in rows, slow and dense in the left half, fast and farther apart in the right one.
Scene slow_and_fast() {
    Scene scene{.side = 600, .radius = 1, .steps = 1, .discs = {}};
    const auto fill = [&](double left, double right, double apart, double speed) {
        std::mt19937_64 numbers(5);
        std::uniform_real_distribution<double> number(-1, 1);
        for (double x = left; x < right; x += apart) {
            for (double y = 2; y < scene.side - 2; y += apart) {
                const double shift = (apart - 2) / 2.1;
                const double angle = std::numbers::pi * number(numbers);
                scene.discs.push_back({x + shift * number(numbers), y + shift * number(numbers),
                                       speed * std::cos(angle), speed * std::sin(angle)});
            }
        }
    };
    fill(2, 298, 2.4, 0.005);
    fill(302, 598, 2.7, 0.5);
    return scene;
}

TEST(BusiestPiece, IsWhereDiscsAreFast) {
    const Scene scene = slow_and_fast();
    const Piece piece = busiest_piece(scene, 20'000);
    EXPECT_LT(piece.scene.discs.size(), scene.discs.size());
    const auto fast = std::ranges::count_if(
        piece.scene.discs, [](const Disc& disc) { return std::hypot(disc.vx, disc.vy) > 0.1; });
    EXPECT_EQ(fast, piece.scene.discs.size());
    EXPECT_LT(piece.whole_over_piece, 1) << "the slow ones are hardly off";
}

TEST(BusiestPiece, TellsWhereOthersAddMoreADisc) {
    Scene scene{.side = 400, .radius = 1, .steps = 1, .discs = {}};
    for (int i = 0; i < 1600; ++i) {
        const bool low = i % 40 < 20 && i / 40 < 20;
        scene.discs.push_back({5.0 + 10 * (i % 40), 5.0 + 10 * (i / 40), low ? 1 : 1.15, 0});
    }
    for (int i = 0; i < 300; ++i) {
        scene.discs.push_back({10.0 + 10 * (i % 18), 10.0 + 10 * (i / 18), 0, 0});
    }
    const Piece piece = busiest_piece(scene, 700);
    EXPECT_EQ(piece.scene.discs.size(), 700) << "where discs at rest are as well";
    const double of_piece = 400;
    const double of_all = (700 * 400 + 3 * 400 * 400 * std::pow(1.15, 3)) / 1900;
    EXPECT_NEAR(piece.whole_over_piece, of_all / of_piece, 1e-9);
}

TEST(TryMethods, PromisesWhatHoldsWhereDiscsAreFast) {
    const Scene scene = slow_and_fast();
    const Trial trial = try_methods(scene, {}, Measure::path, 0.05);
    ASSERT_FALSE(trial.whole_scene);
    const auto choice = cheapest_below(trial.results, 0.05);
    ASSERT_TRUE(choice);
    const Tuning tuning{.substeps = choice->method.substeps};
    EXPECT_LE(error_by(measure_errors(scene, *choice->method.variant, tuning), Measure::path), 0.05);
}

} // namespace
} // namespace carom
