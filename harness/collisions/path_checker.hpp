#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/collisions/collision_checker.hpp"
#include "harness/verify/path.hpp"
#include "harness/verify/path_search.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Follows an event-driven simulation from collision to collision, as it tells them, and finds whatever is
/// wrong: what passes is proven right, to rounding, and not sampled. Nothing of it is shared with the
/// simulation.
///  - Times rise, or stay. Discs fly straight on from one of their collisions to the next: to rounding the
///    place of each is on the path that the one before has set out.
///  - Two discs collide where their paths are 2r apart, approaching, and exchange the components of their
///    velocities along the line of centres: these alone, which keeps their momentum and energy.
///  - A wall turns the component with which a disc flies into it, where the disc touches it, to the last bit.
///  - Nowhere in between do two discs come nearer than 2r (path_search.hpp), or a disc beyond a wall.
///  - A state has every disc where its path is, and its velocity to the last bit.
///
/// Discs may overlap each other or walls at the start: those that approach collide at once, those that part
/// are let go. Centres nearer than rounding can tell have no normal, and may do either.
///
/// What rounding allows stands in path.hpp.
class PathChecker final : public CollisionChecker {
  public:
    explicit PathChecker(const Scene& scene, int substeps = 1);

    void collided(const Collision<double>& collision) override;

    /// The first that was wrong up to that time, or of the state that the simulation then is in; or nothing.
    std::optional<std::string> violation_at(double time, const std::vector<Disc>& discs);

    std::optional<std::string> violation_so_far() const override { return violation_; }

    /// What is wrong at the end of the next step, one of `substeps` in a unit of time.
    std::optional<std::string> step(const std::vector<Disc>& /*before*/,
                                    const std::vector<Disc>& after) override {
        return violation_at(static_cast<double>(++steps_) / substeps_, after);
    }

    /// Of discs and of walls, so far.
    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }

  private:
    using Found = std::optional<std::string>;

    Path& path(int disc) { return paths_[static_cast<std::size_t>(disc)]; }
    Found violation_of(const Collision<double>& collision);
    Found off_path(int disc, const Disc& place, double time);
    Found wrong_pair(const Collision<double>& collision);
    Found wrong_wall(const Collision<double>& collision);
    Found beyond_wall(int disc, double time);
    double beyond(double position, double velocity) const;
    void end_path(int disc, double time, const Disc& after);
    Found search(double time);

    double side_;
    double radius_;
    double substeps_;
    std::int64_t steps_ = 0;
    PathSearch search_;
    PathRounding rounding_;
    std::vector<Path> paths_;
    std::vector<PathPiece> pieces_; ///< since the last search
    double searched_ = 0;           ///< up to when
    double now_ = 0;
    Found violation_;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
};

} // namespace carom
