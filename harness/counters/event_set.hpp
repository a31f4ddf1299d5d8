#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// Why something cannot be counted, half a line for a record's `reason`, and what to do about it.
struct CounterError : std::runtime_error {
    explicit CounterError(const std::string& reason, std::string what_to_do = "")
        : std::runtime_error(reason), remedy(std::move(what_to_do)) {}

    std::string remedy;
};

/// Events counted together on one thread. Every call, the destructor too, comes from the thread that made it
/// and throws CounterError if it is refused.
class EventSet {
  public:
    virtual ~EventSet() = default;

    /// Events are added before `start`.
    virtual void add(const std::string& event) = 0;

    virtual void start() = 0;

    /// What was counted since `start`, in the order in which the events were added.
    virtual std::vector<double> stop() = 0;
};

/// Makes an empty set for the calling thread.
using MakeEventSet = std::function<std::unique_ptr<EventSet>()>;

} // namespace carom
