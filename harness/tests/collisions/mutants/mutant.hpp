#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

// What a mutant and its test say to each other. A mutant is the kernel with one bug, compiled with its
// namespace `carom` renamed to one of its own, so that nothing of it is taken for the real one; therefore no
// type of the kernel stands here.

namespace mutants {

using Disc = std::array<double, 4>; ///< x, y, vx, vy

struct Scene {
    double side;
    double radius;
    std::vector<Disc> discs;
};

struct Tuning {
    int threads;
    int substeps;
    int sweep_limit;
};

struct Collision {
    double time;
    int sweep;
    int first;
    int second;
    Disc first_after;
    Disc second_after;
};

using Tell = std::function<void(const Collision&)>;

class Simulation {
  public:
    virtual ~Simulation() = default;

    /// One step; returns whether its resolve came to an end.
    virtual bool step() = 0;

    virtual std::vector<Disc> discs() const = 0;
};

using Simulate = std::unique_ptr<Simulation> (*)(const Scene&, const Tuning&, Tell);

/// Every mutant that is linked in, by its name.
inline std::map<std::string, Simulate>& all() {
    static std::map<std::string, Simulate> mutants;
    return mutants;
}

} // namespace mutants
