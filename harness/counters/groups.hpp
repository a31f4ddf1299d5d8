#pragma once

#include <string>
#include <vector>

#include "harness/counters/event_set.hpp"

namespace carom {

/// A quantity to count: the first of these events that can be counted stands for it.
using Alternatives = std::vector<std::string>;

/// A quantity of which no event can be counted.
struct Uncountable {
    std::string event; ///< the first alternative
    std::string error; ///< of the first alternative
};

/// What can be counted, in groups that the hardware counts at once, each event in one of them.
struct EventGroups {
    std::vector<std::vector<std::string>> groups;
    std::vector<Uncountable> missing;
};

/// Finds out by adding, starting and reading, on the calling thread. An event that does not fit into a group
/// that is there starts a new one: nothing is ever multiplexed.
EventGroups group_events(const std::vector<Alternatives>& wanted, const MakeEventSet& make);

/// Whether any thread that runs counts some of this event, so that zero means that nothing was counted.
bool must_count(const std::string& event);

} // namespace carom
