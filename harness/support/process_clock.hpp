#pragma once

namespace carom {

/// Seconds of wall time since the program's static objects were made, just before main.
double process_seconds();

} // namespace carom
