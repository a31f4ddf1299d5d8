#pragma once

#include "kernels/policies.hpp"

namespace carom::tests {

/// The same with one policy changed.
template <class Value> constexpr Policies with(Policies policies, Value Policies::* axis, Value value) {
    policies.*axis = value;
    return policies;
}

constexpr Policies at_contact(const Policies& policies) {
    return with(policies, &Policies::impact, Impact::at_contact);
}

/// Contacts, and what makes them faster, one after the other.
constexpr Policies wide{.order = Order::strips,
                        .self_contained = SelfContained::off,
                        .storage = Storage::sorted,
                        .overlaps = Overlaps::contacts};
constexpr Policies snug =
    with(with(wide, &Policies::neighbourhood, Neighbourhood::nine), &Policies::box_side, BoxSide::snug);
constexpr Policies filtered = with(snug, &Policies::search, Search::filtered);
constexpr Policies active = with(filtered, &Policies::worklist, Worklist::active);
constexpr Policies fastest =
    with(with(active, &Policies::order, Order::wavefront), &Policies::resolve_schedule, Schedule::dynamic);

} // namespace carom::tests
