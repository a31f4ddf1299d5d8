#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/policies.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// Checks a run, step by step, by every collision that it is told: by these a step is proven, and not by its
/// state at the end alone.
class CollisionChecker : public CollisionLog<double> {
  public:
    /// The first violation of what has been told of a step that did not end, or nothing.
    virtual std::optional<std::string> violation_so_far() const { return std::nullopt; }

    /// The first violation of the next step, named with its discs and numbers, or nothing. `before` and
    /// `after` are the states at its ends.
    virtual std::optional<std::string> step(const std::vector<Disc>& before,
                                            const std::vector<Disc>& after) = 0;
};

/// The one for a variant's run from a scene's start, or null if its collisions happen at the steps' ends:
/// then states tell all (checker.hpp). For Engine::event_driven it is a PathChecker, whose steps are those of
/// `tuning` in time; for Impact::at_contact one that goes through the collisions of each step.
std::unique_ptr<CollisionChecker> collision_checker(const Scene& scene, const Variant& variant,
                                                    const Tuning& tuning);

} // namespace carom
