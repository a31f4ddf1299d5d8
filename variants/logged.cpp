#include <array>
#include <cstddef>
#include <utility>

#include "variants/event_driven_simulation.hpp"
#include "variants/registry_part.hpp"

namespace carom {

template class EventDriven<double, CollisionLog<double>&>;

std::unique_ptr<Simulation> simulate_event_driven_logged(const Scene& scene, const Tuning& tuning,
                                                         CollisionLog<double>& log) {
    return std::make_unique<EventDrivenSimulation<ToldSimulation>>(scene, tuning.substeps, tuning.threads,
                                                                   log);
}

namespace part_detail {

template <Policies policies>
std::unique_ptr<Simulation> simulate_logged(const Scene& scene, const Tuning& tuning,
                                            CollisionLog<double>& log) {
    return std::make_unique<SimulationOf<policies, LoggingProbe>>(scene, tuning, LoggingProbe(log));
}

/// Taking their addresses instantiates all that the rows of the table refer to.
template <std::size_t... row> constexpr auto all_logged(std::index_sequence<row...>) {
    return std::array{logged<table[row]>()...};
}
extern const std::array<decltype(Variant::simulate_logged), table.size()> every_logged;
const std::array<decltype(Variant::simulate_logged), table.size()> every_logged =
    all_logged(std::make_index_sequence<table.size()>{});

} // namespace part_detail
} // namespace carom
