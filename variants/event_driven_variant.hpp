#pragma once

#include "kernels/exact/event_driven.hpp"
#include "variants/registry.hpp"

namespace carom {

/// Compiled here once, as what is measured is: of two copies the linker keeps any, and the verbs, which are
/// compiled in haste, would bring slow ones.
extern template class EventDriven<double>;
extern template class EventDriven<long double>;
extern template class EventDriven<double, CollisionLog<double>&>;
extern template class EventDriven<long double, CollisionLog<long double>&>;

/// The event-driven simulation (kernels/exact/event_driven.hpp) as one more variant, beside the table: every
/// collision at its time, in order, exact to rounding. It runs on one thread, whatever the tuning says; a
/// step of dt only says when to look at it. Of scenes whose discs overlap at the start it makes something of
/// its own.
const Variant& event_driven();

} // namespace carom
