#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/event_driven.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

/// The event-driven simulation without cells, queue or memory: before every event all pairs and walls are
/// asked for the next one, and all discs are moved to it. In long double, with the textbook's root.
class PlainSimulation {
  public:
    explicit PlainSimulation(const Scene& scene) : side_(scene.side), radius_(scene.radius) {
        for (const Disc& disc : scene.discs) {
            discs_.push_back(disc_cast<long double>(disc));
        }
    }

    void advance(long double time) {
        while (true) {
            find_next();
            if (now_ + until_ > time) {
                move(time - now_);
                return;
            }
            move(until_);
            happen();
        }
    }

    const std::vector<BasicDisc<long double>>& discs() const { return discs_; }
    int pair_collisions() const { return pair_collisions_; }
    int wall_collisions() const { return wall_collisions_; }

  private:
    enum class With { disc, wall_x, wall_y };

    void move(long double by) {
        for (auto& disc : discs_) {
            disc.x += disc.vx * by;
            disc.y += disc.vy * by;
        }
        now_ += by;
    }

    void propose(long double until, With with, std::size_t one, std::size_t other) {
        if (until < until_) {
            until_ = until;
            with_ = with;
            one_ = one;
            other_ = other;
        }
    }

    void find_next() {
        until_ = std::numeric_limits<long double>::infinity();
        for (std::size_t i = 0; i < discs_.size(); ++i) {
            const auto& one = discs_[i];
            propose(until_wall(one.x, one.vx), With::wall_x, i, i);
            propose(until_wall(one.y, one.vy), With::wall_y, i, i);
            for (std::size_t j = i + 1; j < discs_.size(); ++j) {
                propose(until_pair(one, discs_[j]), With::disc, i, j);
            }
        }
    }

    long double until_wall(long double position, long double velocity) const {
        const long double wall = velocity < 0 ? radius_ : side_ - radius_;
        return velocity == 0 ? std::numeric_limits<long double>::infinity() : (wall - position) / velocity;
    }

    long double until_pair(const BasicDisc<long double>& one, const BasicDisc<long double>& other) const {
        const long double dx = other.x - one.x;
        const long double dy = other.y - one.y;
        const long double vx = other.vx - one.vx;
        const long double vy = other.vy - one.vy;
        const long double a = vx * vx + vy * vy;
        const long double b = dx * vx + dy * vy;
        const long double c = dx * dx + dy * dy - 4 * radius_ * radius_;
        return b < 0 && b * b >= a * c ? (-b - std::sqrt(b * b - a * c)) / a
                                       : std::numeric_limits<long double>::infinity();
    }

    void happen() {
        auto& one = discs_[one_];
        if (with_ == With::disc) {
            auto& other = discs_[other_];
            const long double distance = std::hypot(other.x - one.x, other.y - one.y);
            const long double normal_x = (other.x - one.x) / distance;
            const long double normal_y = (other.y - one.y) / distance;
            const long double exchanged = (other.vx - one.vx) * normal_x + (other.vy - one.vy) * normal_y;
            one.vx += exchanged * normal_x;
            one.vy += exchanged * normal_y;
            other.vx -= exchanged * normal_x;
            other.vy -= exchanged * normal_y;
            ++pair_collisions_;
        } else {
            long double& velocity = with_ == With::wall_x ? one.vx : one.vy;
            velocity = -velocity;
            ++wall_collisions_;
        }
    }

    long double side_;
    long double radius_;
    long double now_ = 0;
    std::vector<BasicDisc<long double>> discs_;
    long double until_ = 0;
    With with_ = With::disc;
    std::size_t one_ = 0;
    std::size_t other_ = 0;
    int pair_collisions_ = 0;
    int wall_collisions_ = 0;
};

/// A part of the rounding becomes larger by every collision: how long the two agree is set by that.
template <class Real> void expect_the_same(const Scene& scene, double time, double tolerance) {
    EventDriven<Real> fast(scene);
    PlainSimulation plain(scene);
    ASSERT_TRUE(fast.advance(static_cast<Real>(time)));
    plain.advance(time);
    EXPECT_EQ(fast.pair_collisions(), plain.pair_collisions());
    EXPECT_EQ(fast.wall_collisions(), plain.wall_collisions());
    EXPECT_GT(plain.pair_collisions(), static_cast<int>(scene.discs.size()));
    const auto discs = fast.discs();
    long double off = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        off = std::max(
            {off, std::abs(discs[i].x - plain.discs()[i].x), std::abs(discs[i].y - plain.discs()[i].y)});
    }
    EXPECT_LT(static_cast<double>(off), tolerance);
}

TEST(EventDriven, DoesWhatAllPairsAskedBeforeEveryEventDo) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        expect_the_same<double>(lattice_scene(6, 0.05, seed), 40, 1e-7);
        expect_the_same<double>(lattice_scene(7, 0.3, seed), 8, 1e-9);
        expect_the_same<double>(lattice_scene(8, 0.7, seed), 1, 1e-10);
        expect_the_same<long double>(lattice_scene(7, 0.3, seed), 8, 1e-12);
    }
}

/// Fast ones among slow ones: most cells are crossed by what was not near at the start.
TEST(EventDriven, DoesSoWhereAFewDiscsAreFast) {
    Scene scene = lattice_scene(8, 0.2, 4);
    for (std::size_t i = 0; i < scene.discs.size(); i += 16) {
        scene.discs[i].vx *= 100;
        scene.discs[i].vy *= 100;
    }
    expect_the_same<double>(scene, 0.7, 1e-7);
}

} // namespace
} // namespace carom::tests
