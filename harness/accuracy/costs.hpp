#pragma once

#include <array>
#include <cstdint>

#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// Seconds that the work of a method takes on one thread in a scene of so many discs. The work is counted;
/// what each kind of it takes was measured once, on one machine: by these the same is chosen every time,
/// everywhere. Between the sizes that were measured costs lie along the logarithm of the size, beyond them as
/// at the last.
class Costs {
  public:
    Costs(const Variant& variant, std::size_t discs);

    /// Of the start of a scene.
    double setting_up(const Scene& scene) const;

    /// Of a step from the scene as it is, or of a unit of time of the event-driven simulation, without the
    /// collisions.
    double step(const Scene& scene) const;

    double collisions(std::int64_t count) const;

  private:
    double near_in_steps(const Scene& scene) const;

    const Variant& variant_;
    /// Of a disc put in place; of a disc and a step, or one that crosses into another cell; of two discs near
    /// enough to be looked at, or a disc that is brought to the end of a unit of time; of a collision.
    std::array<double, 4> nanoseconds_;
};

} // namespace carom
