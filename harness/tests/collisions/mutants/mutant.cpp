// One mutant: CMake compiles this file for each of them, with the changed copy of the headers first in the
// search path, `carom` defined as a namespace of its own, and the names of the mutant and of its variant.

#include "harness/tests/collisions/mutants/mutant.hpp"

#include <cstddef>
#include <string_view>
#include <utility>

#include "kernels/exact/event_driven.hpp"
#include "kernels/step.hpp"
#include "variants/name.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

constexpr std::string_view variant = CAROM_MUTANT_VARIANT;

constexpr Engine engine = variant == word(Engine::event_driven) ? Engine::event_driven : Engine::steps;

constexpr std::size_t row_of_variant() {
    std::size_t row = 0;
    while (row < table.size() && name_of(table[row]).view() != variant) {
        ++row;
    }
    return row;
}
static_assert((row_of_variant() == table.size()) == (engine == Engine::event_driven), "no such variant");
constexpr Policies policies = engine == Engine::event_driven ? Policies{} : table[row_of_variant()];

mutants::Disc plain(const Disc& disc) { return {disc.x, disc.y, disc.vx, disc.vy}; }

Scene scene_of(const mutants::Scene& plain) {
    Scene scene{.side = plain.side, .radius = plain.radius, .steps = 0, .discs = {}};
    for (const auto& [x, y, vx, vy] : plain.discs) {
        scene.discs.push_back({x, y, vx, vy});
    }
    return scene;
}

std::vector<mutants::Disc> plain(const std::vector<Disc>& discs) {
    std::vector<mutants::Disc> all;
    for (const Disc& disc : discs) {
        all.push_back(plain(disc));
    }
    return all;
}

class Told : public CollisionLog<double> {
  public:
    explicit Told(mutants::Tell tell) : tell_(std::move(tell)) {}

    void collided(const Collision<double>& collision) override {
        tell_({collision.time, collision.sweep, collision.first, collision.second,
               plain(collision.first_after), plain(collision.second_after)});
    }

  private:
    mutants::Tell tell_;
};

template <Policies policies> class Stepped final : public mutants::Simulation {
  public:
    Stepped(const Scene& scene, const mutants::Tuning& tuning, mutants::Tell tell)
        : told_(std::move(tell)), probe_(told_), state_(scene, tuning.threads),
          tuning_{.threads = tuning.threads, .substeps = tuning.substeps, .sweep_limit = tuning.sweep_limit} {
    }

    bool step() override { return carom::step(state_, tuning_, probe_).settled; }
    std::vector<mutants::Disc> discs() const override { return plain(discs_by_number(state_)); }

  private:
    Told told_;
    LoggingProbe probe_;
    State<policies> state_;
    Tuning tuning_;
};

class Exact final : public mutants::Simulation {
  public:
    Exact(const Scene& scene, const mutants::Tuning& tuning, mutants::Tell tell)
        : told_(std::move(tell)), simulation_(scene, told_), substeps_(tuning.substeps) {}

    bool step() override {
        ++steps_;
        return simulation_.advance(steps_ / substeps_, {.at_once = 100'000, .in_all = 10'000'000});
    }
    std::vector<mutants::Disc> discs() const override { return plain(simulation_.discs()); }

  private:
    Told told_;
    EventDriven<double, CollisionLog<double>&> simulation_;
    double substeps_;
    int steps_ = 0;
};

template <Policies policies>
std::unique_ptr<mutants::Simulation> simulate(const mutants::Scene& scene, const mutants::Tuning& tuning,
                                              mutants::Tell tell) {
    if constexpr (engine == Engine::event_driven) {
        return std::make_unique<Exact>(scene_of(scene), tuning, std::move(tell));
    } else {
        return std::make_unique<Stepped<policies>>(scene_of(scene), tuning, std::move(tell));
    }
}

[[maybe_unused]] const bool is_known = mutants::all().emplace(CAROM_MUTANT_NAME, simulate<policies>).second;

} // namespace
} // namespace carom
