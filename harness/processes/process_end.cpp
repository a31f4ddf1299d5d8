#include "harness/processes/process_end.hpp"

#include <numeric>

namespace carom {

double ProcessEnd::wall_seconds() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

} // namespace carom
