#include "variants/event_driven_variant.hpp"

#include <algorithm>
#include <cstddef>

#include "variants/event_driven_simulation.hpp"
#include "variants/name.hpp"

namespace carom {

template class EventDriven<double>;
template class EventDriven<long double>;
template class EventWindows<double>;
template class EventWindows<long double>;
template class ExactSimulation<double>;
template class ExactSimulation<long double>;

namespace {

std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    return std::make_unique<EventDrivenSimulation<ExactSimulation<double>>>(scene, tuning.substeps,
                                                                            tuning.threads);
}

} // namespace

int event_driven_threads(std::size_t discs, int threads) {
    return std::min(threads, tiles_for(discs, threads).all());
}

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
