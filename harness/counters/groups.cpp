#include "harness/counters/groups.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace carom {
namespace {

/// Work enough for every event that must count.
void spin() {
    volatile int turns = 100'000;
    while (turns > 0) {
        turns = turns - 1;
    }
}

/// Why these events cannot be counted together, or nothing.
std::optional<std::string> try_counting(const std::vector<std::string>& events, const MakeEventSet& make) {
    try {
        const auto set = make();
        for (const std::string& event : events) {
            set->add(event);
        }
        set->start();
        spin();
        const std::vector<double> counts = set->stop();
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (must_count(events[i]) && !(counts.at(i) > 0)) {
                return events[i] + " starts but counts nothing";
            }
        }
    } catch (const CounterError& error) {
        return error.what();
    }
    return std::nullopt;
}

} // namespace

EventGroups group_events(const std::vector<Alternatives>& wanted, const MakeEventSet& make) {
    EventGroups found;
    for (const Alternatives& alternatives : wanted) {
        std::vector<std::string> errors;
        for (const std::string& event : alternatives) {
            if (const auto error = try_counting({event}, make)) {
                errors.push_back(*error);
                continue;
            }
            const auto fits = [&](std::vector<std::string> group) {
                group.push_back(event);
                return !try_counting(group, make);
            };
            const auto group = std::ranges::find_if(found.groups, fits);
            (group != found.groups.end() ? *group : found.groups.emplace_back()).push_back(event);
            break;
        }
        if (errors.size() == alternatives.size()) {
            found.missing.push_back({alternatives.front(), errors.front()});
        }
    }
    return found;
}

bool must_count(const std::string& event) {
    constexpr std::array<std::string_view, 6> always{"PAPI_TOT_CYC",     "PAPI_TOT_INS",
                                                     "perf::CYCLES",     "perf::INSTRUCTIONS",
                                                     "perf::TASK-CLOCK", "perf::CPU-CLOCK"};
    return std::ranges::find(always, event) != always.end();
}

} // namespace carom
