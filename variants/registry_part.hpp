#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "kernels/step.hpp"
#include "variants/name.hpp"
#include "variants/parts.hpp"
#include "variants/registry.hpp"
#include "variants/table.hpp"

// Included by the files of the parts, and by logged.cpp.

namespace carom {

namespace part_detail {

/// `SomeProbe` is a probe, or a reference to one.
template <Policies policies, class SomeProbe> class SimulationOf final : public Simulation {
  public:
    SimulationOf(const Scene& scene, const Tuning& tuning, SomeProbe probe)
        : state_(scene, tuning.threads), tuning_(tuning), probe_(probe) {}

    Tally step() override { return carom::step(state_, tuning_, probe_); }

    void restart(const Scene& scene) override { state_.restart(scene, tuning_.threads); }

    std::vector<Disc> discs() const override { return discs_by_number(state_); }

  private:
    State<policies> state_;
    Tuning tuning_;
    SomeProbe probe_;
};

template <Policies policies> std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    return std::make_unique<SimulationOf<policies, NoProbe>>(scene, tuning, NoProbe());
}

template <Policies policies>
std::unique_ptr<Simulation> simulate_observed(const Scene& scene, const Tuning& tuning, Probe& probe) {
    return std::make_unique<SimulationOf<policies, Probe&>>(scene, tuning, probe);
}

/// In logged.cpp: see event_driven_simulation.hpp.
template <Policies policies>
std::unique_ptr<Simulation> simulate_logged(const Scene& scene, const Tuning& tuning,
                                            CollisionLog<double>& log);

/// How the variants are simulated whose collisions are told, and null of the others.
template <Policies policies> constexpr auto logged() -> decltype(Variant::simulate_logged) {
    if constexpr (policies.impact == Impact::at_contact) {
        return simulate_logged<policies>;
    } else {
        return nullptr;
    }
}

template <std::size_t row> constexpr Name name_of_row = name_of(table[row]);

template <std::size_t row>
constexpr Variant variant_of_row{.name = name_of_row<row>.view(),
                                 .policies = table[row],
                                 .simulate = simulate<table[row]>,
                                 .simulate_observed = simulate_observed<table[row]>,
                                 .simulate_logged = logged<table[row]>()};

template <std::size_t part, std::size_t... k> constexpr auto rows_of_part(std::index_sequence<k...>) {
    return std::array{variant_of_row<part + k * parts>...};
}

} // namespace part_detail

template <std::size_t part> std::span<const Variant> variants_of_part() {
    constexpr std::size_t count = (table.size() - part + parts - 1) / parts;
    static constexpr auto rows = part_detail::rows_of_part<part>(std::make_index_sequence<count>{});
    return rows;
}

} // namespace carom
