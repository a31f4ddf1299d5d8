#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/first_collision.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

constexpr double no_meeting = std::numeric_limits<double>::infinity();

/// The discs of a scene in their cells. Each has flown straight on from somewhere else since another time.
struct Flights {
    EventCells<double> cells;
    std::vector<Flight<double>> all;

    explicit Flights(const Scene& scene) : cells(scene) {
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
double meeting(const Flight<double>& one, const Flight<double>& elsewhere, double radius) {
    Flight<double> other = elsewhere;
    other.move_to(one.time);
    const double dx = other.x - one.x;
    const double dy = other.y - one.y;
    const double vx = other.vx - one.vx;
    const double vy = other.vy - one.vy;
    const double b = dx * vx + dy * vy;
    if (!(b < 0) || dx * dx + dy * dy < coincident_squared<double>) {
        return no_meeting;
    }
    const double c = dx * dx + dy * dy - 4 * radius * radius;
    if (c <= 0) {
        return one.time;
    }
    const double discriminant = b * b - (vx * vx + vy * vy) * c;
    return discriminant < 0 ? no_meeting : one.time + c / (std::sqrt(discriminant) - b);
}

/// Compares what every disc foresees with what asking one disc after another gives, to the last bit, for
/// discs that have foreseen something for time `foreseen`; returns how many foresee a collision before.
int compare(const Scene& scene, double foreseen = no_meeting) {
    Flights flights(scene);
    int found = 0;
    for (std::size_t i = 0; i < flights.all.size(); ++i) {
        Flight<double>& one = flights.all[i];
        one.move_to(5);
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
        FirstCollision<double> first(flights.all, flights.cells, static_cast<int>(i),
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
    EXPECT_EQ(compare(scene, 5), 0);
}

} // namespace
} // namespace carom::tests
