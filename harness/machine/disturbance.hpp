#pragma once

#include <optional>
#include <string>

#include "harness/machine/noise.hpp"

namespace carom {

/// What others did to this process over a time.
struct Disturbance {
    double seconds = 0;           ///< of wall time
    std::optional<double> waited; ///< seconds that its threads, all together, were ready and had no processor
    std::optional<double> stolen; ///< share of all processors' time that the host gave to others
    std::optional<double> load;   ///< how many threads ran or were ready to, on average over the last minute
    int processors = 1;           ///< that this process may use
};

/// "the machine was busy: ...", in one line with what is known, if others cost more than a twentieth of the
/// time; else nothing. A process of more threads than processors waits for itself, which is not told.
std::optional<std::string> busy_text(const Disturbance& disturbance, int threads);

/// Looks at this process from its construction on.
class DisturbanceWatch {
  public:
    DisturbanceWatch();

    Disturbance until_now() const;

  private:
    double start_;
    std::optional<double> waited_;
    std::optional<CpuTime> time_;
};

/// Says on standard error, in one line, if the machine was busy; `threads` are those that worked.
void note_if_busy(const DisturbanceWatch& watch, int threads);

} // namespace carom
