#include <string>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/costs.hpp"

namespace carom {
namespace {

/// As measured on one machine, in nanoseconds: small scenes in a cache, and large ones.
std::vector<UnitCosts> typical_of(const Variant& variant) {
    const auto at = [](double discs, const Work& nanoseconds) {
        return UnitCosts{.discs = discs, .seconds = 1e-9 * nanoseconds};
    };
    if (variant.engine == Engine::event_driven) {
        return {at(2'000, {100, 120, 0, 300}), at(40'000, {150, 150, 0, 380}),
                at(400'000, {400, 240, 50, 600})};
    }
    const double collision = variant.policies.impact == Impact::at_contact ? 75 : 20;
    return {at(40'000, {3, 0, 3.5, collision}), at(400'000, {13, 10, 4, 2 * collision})};
}

} // namespace

Costs typical_costs() {
    Costs costs{.machine = "typical", .costs = {}};
    for (const Method& method :
         methods_for({.side = 1000, .radius = 1, .steps = 1, .discs = {{5, 5, 1, 1}}})) {
        costs.costs.try_emplace(std::string(method.variant->name), typical_of(*method.variant));
    }
    return costs;
}

} // namespace carom
