#include "variants/event_driven.hpp"

#include "variants/name.hpp"

namespace carom {

template class EventDriven<double>;
template class EventDriven<long double>;
template class EventDriven<double, CollisionLog<double>&>;
template class EventDriven<long double, CollisionLog<long double>&>;

namespace {

constexpr Policies policies{.impact = Impact::event_driven};
constexpr Name name = name_of(policies);

template <class Log> class EventDrivenSimulation final : public Simulation {
  public:
    EventDrivenSimulation(const Scene& scene, int substeps, Log log = Log())
        : exact_(scene, log), substeps_(substeps) {}

    Tally step() override {
        const std::int64_t pairs = exact_.pair_collisions();
        const std::int64_t walls = exact_.wall_collisions();
        ++steps_;
        const bool settled = exact_.advance(static_cast<double>(steps_) / substeps_);
        return {.pair_resolves = exact_.pair_collisions() - pairs,
                .wall_resolves = exact_.wall_collisions() - walls,
                .settled = settled};
    }

    std::vector<Disc> discs() const override { return exact_.discs(); }

  private:
    EventDriven<double, Log> exact_;
    double substeps_;
    std::int64_t steps_ = 0;
};

std::unique_ptr<Simulation> simulate(const Scene& scene, const Tuning& tuning) {
    return std::make_unique<EventDrivenSimulation<NoCollisionLog>>(scene, tuning.substeps);
}

std::unique_ptr<Simulation> simulate_logged(const Scene& scene, const Tuning& tuning,
                                            CollisionLog<double>& log) {
    return std::make_unique<EventDrivenSimulation<CollisionLog<double>&>>(scene, tuning.substeps, log);
}

} // namespace

const Variant& event_driven() {
    static constexpr Variant variant{.name = name.view(),
                                     .policies = policies,
                                     .simulate = simulate,
                                     .simulate_observed = nullptr,
                                     .simulate_logged = simulate_logged};
    return variant;
}

} // namespace carom
