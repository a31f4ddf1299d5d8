#pragma once

#include <string>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// A run of all S steps of a scene by Chipmunk 7 (https://chipmunk-physics.net), a general engine for rigid
/// bodies in the plane: discs of mass 1 that cannot rotate, elastic, without friction, between four walls.
/// All else is as it comes. It parts overlapping bodies little by little, and conserves energy only so far.
struct ChipmunkRun {
    double steps_seconds = 0; ///< wall time of the steps alone
    double cpu_seconds = 0;   ///< process CPU time of the same
    std::vector<Disc> discs;  ///< the final state
    std::string version;      ///< of the library
};

/// Runs S * substeps steps of 1 / substeps, on one thread, with so many iterations of its solver a step.
/// Throws NotBuiltIn if the program was built without Chipmunk.
ChipmunkRun run_chipmunk(const Scene& scene, int substeps, int iterations);

} // namespace carom
