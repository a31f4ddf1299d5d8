#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/first_collision.hpp"
#include "kernels/tests/exact/cells_of.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

constexpr double no_meeting = std::numeric_limits<double>::infinity();

/// The discs of a scene in their cells. Each has flown straight on from somewhere else since another time.
struct Flights {
    EventCells<double> cells;
    std::vector<Flight<double>> all;

    explicit Flights(const Scene& scene) : cells(cells_of(scene)) {
        Random random(scene.discs.size());
        for (std::size_t i = 0; i < scene.discs.size(); ++i) {
            const Disc& disc = scene.discs[i];
            const double ago = 0.25 * random.below(8);
            const int cell = cells.cell_at(disc.x, disc.y);
            all.push_back({.x = disc.x - disc.vx * ago,
                           .y = disc.y - disc.vy * ago,
                           .vx = disc.vx,
                           .vy = disc.vy,
                           .time = 5 - ago,
                           .age = static_cast<std::uint32_t>(random.below(100)),
                           .cell = cell});
            cells.insert(static_cast<int>(i), cell);
        }
    }
};

/// When two discs meet, asked one thing after another; `no_meeting` if they do not.
double meeting(Flight<double> one, Flight<double> other, double radius) {
    const double start = std::max(one.time, other.time);
    one.move_to(start);
    other.move_to(start);
    const double dx = other.x - one.x;
    const double dy = other.y - one.y;
    const double vx = other.vx - one.vx;
    const double vy = other.vy - one.vy;
    const double b = dx * vx + dy * vy;
    if (!(b < 0) || dx * dx + dy * dy < coincident_squared<double>) {
        return no_meeting;
    }
    const double c = dx * dx + dy * dy - 4 * radius * radius;
    const double across = dx * vy - dy * vx;
    const double discriminant = (vx * vx + vy * vy) * (4 * radius * radius) - across * across;
    if (discriminant < 0) {
        return no_meeting;
    }
    return c <= 0 ? start : start + c / (std::sqrt(discriminant) - b);
}

/// Compares what every disc foresees with what asking one disc after another gives, to the last bit, for
/// discs that have foreseen something for time `foreseen`; returns how many foresee a collision before.
int compare(const Scene& scene, double foreseen = no_meeting) {
    Flights flights(scene);
    int found = 0;
    for (std::size_t i = 0; i < flights.all.size(); ++i) {
        Flight<double>& one = flights.all[i];
        double earliest = foreseen;
        for (std::size_t j = 0; j < flights.all.size(); ++j) {
            const int rows =
                std::abs(flights.all[j].cell / flights.cells.stride() - one.cell / flights.cells.stride());
            const int columns =
                std::abs(flights.all[j].cell % flights.cells.stride() - one.cell % flights.cells.stride());
            if (j != i && rows <= 1 && columns <= 1) {
                earliest = std::min(earliest, meeting(one, flights.all[j], scene.radius));
            }
        }
        one.collision_time = foreseen;
        one.partner = -7;
        const std::vector<int> in_order;
        FirstCollision<double> first(flights.all, flights.cells, in_order, static_cast<int>(i),
                                     4 * scene.radius * scene.radius);
        for (const int offset : flights.cells.nine()) {
            first.look_into(one.cell + offset);
        }
        first.foresee();
        EXPECT_EQ(one.collision_time, earliest) << i;
        if (earliest == foreseen) {
            EXPECT_EQ(one.partner, -7) << i;
            continue;
        }
        ++found;
        const Flight<double>& partner = flights.all[static_cast<std::size_t>(one.partner)];
        EXPECT_EQ(meeting(one, partner, scene.radius), earliest) << i;
        EXPECT_EQ(one.partner_age, partner.age) << i;
    }
    return found;
}

TEST(FirstCollision, IsTheEarliestFromDiluteToCrowded) {
    EXPECT_GT(compare(random_scene_of_density(400, 0.05, 0, 1)), 100);
    EXPECT_GT(compare(random_scene_of_density(400, 0.6, 0, 2)), 300);
    EXPECT_GT(compare(random_scene(600, 12, 0.02, 0, 1, 3)), 100);
    EXPECT_GT(compare(random_scene(600, 10, 1.7, 0, 1, 4)), 590) << "more than sixty in a cell";
    EXPECT_GT(compare(lattice_scene(20, 0.7, 5)), 350);
}

TEST(FirstCollision, LeavesWhatComesBeforeIt) {
    const Scene scene = lattice_scene(20, 0.5, 6);
    const int all = compare(scene);
    const int soon = compare(scene, 5.5);
    EXPECT_GT(soon, 20);
    EXPECT_LT(soon, all - 20);
    EXPECT_EQ(compare(scene, 3), 0) << "before the flights of any two";
}

TEST(FirstCollision, IsAtTheSameTimeForEitherDisc) {
    Flights flights(random_scene_of_density(400, 0.05, 0, 7));
    int met = 0;
    for (const Flight<double>& one : flights.all) {
        for (const Flight<double>& other : flights.all) {
            const auto seen = approach(one, other, 4.0);
            const auto from_there = approach(other, one, 4.0);
            EXPECT_EQ(seen.b, from_there.b);
            EXPECT_EQ(seen.collide(), from_there.collide());
            if (one.time >= other.time) {
                EXPECT_EQ(approach<true>(one, other, 4.0).b, seen.b);
                EXPECT_EQ(approach<true>(one, other, 4.0).discriminant, seen.discriminant);
            }
            if (seen.collide()) {
                ++met;
                EXPECT_EQ(time_to_collision(seen, 4.0), time_to_collision(from_there, 4.0));
            }
        }
    }
    EXPECT_GT(met, 1000);
}

/// Four discs of the same distance on all sides of a slower one, which comes last in one order of the cells
/// and first in another.
TEST(FirstCollision, OfSeveralAtOneInstantIsThatOfTheLowestNumber) {
    const std::vector<Disc> around = {{5, 9, 0, -1}, {9, 5, -1, 0}, {5, 1, 0, 1}, {1, 5, 1, 0}};
    for (std::size_t turn = 0; turn < around.size(); ++turn) {
        Scene scene{.side = 10, .radius = 1, .steps = 0, .discs = around};
        std::rotate(scene.discs.begin(), scene.discs.begin() + static_cast<std::ptrdiff_t>(turn),
                    scene.discs.end());
        for (const std::size_t middle : {std::size_t{0}, std::size_t{2}, around.size()}) {
            Scene all = scene;
            all.discs.insert(all.discs.begin() + static_cast<std::ptrdiff_t>(middle), Disc{5, 5, 0, 0});
            EventCells<double> cells = cells_of(all);
            std::vector<Flight<double>> flights;
            for (const Disc& disc : all.discs) {
                const int cell = cells.cell_at(disc.x, disc.y);
                flights.push_back({.x = disc.x, .y = disc.y, .vx = disc.vx, .vy = disc.vy, .cell = cell});
                cells.insert(static_cast<int>(flights.size()) - 1, cell);
            }
            const int lowest = middle == 0 ? 1 : 0;
            const int highest = middle == around.size() ? 3 : 4;
            const std::vector<int> falling = {50, 40, 30, 20, 10};
            for (const auto& [numbers, partner] :
                 {std::pair{std::vector<int>(), lowest}, std::pair{falling, highest}}) {
                std::vector<Flight<double>> anew = flights;
                FirstCollision<double> first(anew, cells, numbers, static_cast<int>(middle), 4);
                for (int cell = cells.stride() + 1; cell < cells.stride() * (cells.stride() - 1); ++cell) {
                    first.look_into(cell);
                }
                first.foresee();
                EXPECT_EQ(anew[middle].collision_time, 2);
                EXPECT_EQ(anew[middle].partner, partner);
            }
        }
    }
}

} // namespace
} // namespace carom::tests
