#include "variants/registry.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "kernels/step.hpp"
#include "variants/name.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

template <Policies policies, class SomeProbe> class SimulationOf final : public Simulation {
  public:
    SimulationOf(const Scene& scene, const Tuning& tuning, SomeProbe& probe)
        : state_(scene), tuning_(tuning), probe_(probe) {}

    Tally step() override { return carom::step(state_, tuning_, probe_); }

    const std::vector<Disc>& discs() const override {
        if constexpr (policies.storage == Storage::numbered && policies.precision == Precision::double_) {
            return state_.discs;
        } else {
            by_number_ = discs_by_number(state_);
            return by_number_;
        }
    }

  private:
    State<policies> state_;
    mutable std::vector<Disc> by_number_; ///< a copy, made when asked for
    Tuning tuning_;
    SomeProbe& probe_;
};

template <Policies policies> std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    static NoProbe probe;
    return std::make_unique<SimulationOf<policies, NoProbe>>(scene, tuning, probe);
}

template <Policies policies>
std::unique_ptr<Simulation> simulate_observed(const Scene& scene, const Tuning& tuning, Probe& probe) {
    return std::make_unique<SimulationOf<policies, Probe>>(scene, tuning, probe);
}

template <std::size_t row> constexpr Name name_of_row = name_of(table[row]);

template <std::size_t... row> constexpr auto all_rows(std::index_sequence<row...>) {
    return std::array{Variant{.name = name_of_row<row>.view(),
                              .policies = table[row],
                              .simulate = simulate<table[row]>,
                              .simulate_observed = simulate_observed<table[row]>}...};
}

constexpr auto all_variants = all_rows(std::make_index_sequence<table.size()>{});

} // namespace

std::span<const Variant> variants() { return all_variants; }

const Variant* find_variant(std::string_view name) {
    const auto found = std::ranges::find(all_variants, name, &Variant::name);
    return found == all_variants.end() ? nullptr : &*found;
}

} // namespace carom
