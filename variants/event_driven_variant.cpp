#include "variants/event_driven_variant.hpp"

#include "variants/event_driven_simulation.hpp"
#include "variants/name.hpp"

namespace carom {

template class EventDriven<double>;
template class EventDriven<long double>;

namespace {

std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    return std::make_unique<EventDrivenSimulation<NoCollisionLog>>(scene, tuning.substeps);
}

} // namespace

const Variant& event_driven() {
    static constexpr Variant variant{.name = word(Engine::event_driven),
                                     .engine = Engine::event_driven,
                                     .policies = {},
                                     .simulate = simulate,
                                     .simulate_observed = nullptr,
                                     .simulate_logged = simulate_event_driven_logged};
    return variant;
}

} // namespace carom
