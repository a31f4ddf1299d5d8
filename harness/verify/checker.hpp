#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/rounding.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/engine.hpp"

namespace carom {

/// Verifies single time steps from the state before and after, with its own search for overlaps and its own
/// physics: nothing of it is shared with the kernel but the disc and the definition of a step.
class Checker {
  public:
    /// `dt` is the step's length in time; `rounding` is that of the precision that the discs are kept in.
    Checker(double side, double radius, double dt, Tolerance tolerance, const Rounding& rounding = Rounding(),
            Impact impact = Impact::step_end, Engine engine = Engine::steps);

    /// The first violation, named with its discs and numbers, or nothing:
    ///  - every disc was moved by exactly v dt (v before the step), and its state is finite;
    ///  - no overlapping pair and no wall is left colliding (with twice the kernel's tolerance for approach);
    ///  - energy is conserved, to 1e-10 relative (1e-4 in float), in each connected group of overlapping
    ///  discs, and so overall;
    ///  - momentum and angular momentum are, likewise, in each group that no wall touches;
    ///  - a disc that overlaps no other keeps its velocity to the last bit, but for the sign of what a wall
    ///  turned.
    ///
    /// With Impact::at_contact discs that collided are not where they flew freely: what then holds of every
    /// step stands in at_contact.hpp. Discs that were moved into others, or into a wall, that they did not
    /// overlap before may be left colliding: the next step follows them back.
    ///
    /// Of Engine::event_driven only the states at the ends are seen: what holds of them stands in
    /// event_driven_violation.hpp.
    std::optional<std::string> step(const std::vector<Disc>& before, const std::vector<Disc>& after) const;

    /// The first pair or wall left colliding, or nothing.
    std::optional<std::string> colliding(const std::vector<Disc>& discs) const;

    /// How many pairs and walls are left colliding.
    long count_colliding(const std::vector<Disc>& discs) const;

    /// Is an overlapping pair, or a disc in a wall, left colliding?
    std::optional<std::string> pair_colliding(const std::vector<Disc>& discs,
                                              const OverlappingPair& pair) const;
    std::optional<std::string> wall_colliding(const std::vector<Disc>& discs, int i) const;

  private:
    std::optional<std::string> moved(const std::vector<Disc>& before, const std::vector<Disc>& free,
                                     const std::vector<Disc>& after) const;
    template <class Body> void for_each_colliding(const std::vector<Disc>& discs, const Body& body) const;
    std::optional<std::string> left_colliding(const std::vector<Disc>& free, const std::vector<Disc>& after,
                                              const std::vector<OverlappingPair>& pairs) const;

    Walls walls_;
    double dt_;
    Tolerance tolerance_;
    Rounding rounding_;
    Impact impact_;
    Engine engine_;
};

/// Says so if the state of disc i is not finite.
std::optional<std::string> not_finite(const Disc& disc, std::size_t i);

/// Total kinetic energy, for unit mass: the sum of (vx^2 + vy^2) / 2.
inline double kinetic_energy(const std::vector<Disc>& discs) {
    double sum = 0;
    for (const Disc& disc : discs) {
        sum += 0.5 * (disc.vx * disc.vx + disc.vy * disc.vy);
    }
    return sum;
}

} // namespace carom
