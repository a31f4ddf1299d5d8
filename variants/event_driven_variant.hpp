#pragma once

#include <cstddef>

#include "kernels/exact/exact_simulation.hpp"
#include "variants/registry.hpp"

namespace carom {

/// Compiled here once, as what is measured is: of two copies the linker keeps any, and the verbs, which are
/// compiled in haste, would bring slow ones.
extern template class EventDriven<double>;
extern template class EventDriven<long double>;
extern template class EventDriven<double, CollisionLog<double>&>;
extern template class ExactSimulation<double>;
extern template class ExactSimulation<long double>;
extern template class EventWindows<double>;
extern template class EventWindows<long double>;

/// The event-driven simulation (kernels/exact/event_driven.hpp) as one more variant, beside the table: every
/// collision at its time, in order, exact to rounding. It ends in the same bits on any number of threads; it
/// uses more than one where that pays. A step of dt only says
/// when to look at it. Of scenes whose discs overlap at the start it makes something of
/// its own.
const Variant& event_driven();

/// How many of `threads` threads it uses for so many discs.
int event_driven_threads(std::size_t discs, int threads);

} // namespace carom
