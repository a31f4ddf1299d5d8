#include "variants/event_driven_variant.hpp"

#include "variants/event_driven_simulation.hpp"
#include "variants/name.hpp"

namespace carom {

template class EventDriven<double>;
template class EventDriven<long double>;
template class EventWindows<double>;

namespace {

std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    const int tiles = tiles_per_side(scene.discs.size(), tuning.threads);
    if (tiles == 1) {
        return std::make_unique<EventDrivenSimulation<EventDriven<double>>>(scene, tuning.substeps);
    }
    const WindowSettings settings{.tiles_per_side = tiles};
    return std::make_unique<EventDrivenSimulation<EventWindows<double>>>(scene, tuning.substeps,
                                                                         tuning.threads, settings);
}

} // namespace

int event_driven_threads(std::size_t discs, int threads) {
    return tiles_per_side(discs, threads) == 1 ? 1 : threads;
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
