#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/verify/checker.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What became of a scene in a trajectory.
struct CheckedTrajectory {
    std::vector<Disc> discs;              ///< at the end, or after the step that is wrong
    std::optional<std::string> violation; ///< the first, with its step
};

/// Checks every step of a trajectory, whoever wrote it: that it begins with the scene, and that `checker`
/// finds each step right, from the state that the file holds before it to that after it. `rounding` is that
/// of the precision that the discs are kept in.
///
/// Throws InputError for a file that is no trajectory of the scene from its first state to its last.
CheckedTrajectory check_trajectory(const Scene& scene, const std::string& path, const Checker& checker,
                                   const Rounding& rounding);

} // namespace carom
